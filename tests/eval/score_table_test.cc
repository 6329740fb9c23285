#include "src/eval/score_table.h"

#include <gtest/gtest.h>

#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "src/eval/workspace.h"
#include "tests/eval/test_files.h"

namespace tapa {
namespace {

constexpr Tolerance::Unit kMetres = Tolerance::Unit::kMetres;
constexpr Tolerance::Unit kPercent = Tolerance::Unit::kPercent;

TEST(ToleranceTest, Lists) {
  const std::vector<Tolerance> list = ParseTolerances("0.01,2, 1e-1", kMetres);
  ASSERT_EQ(list.size(), 3u);
  EXPECT_EQ(list[0].value, 0.01);
  EXPECT_EQ(list[1].value, 2);
  EXPECT_EQ(list[2].value, 0.1);
  EXPECT_EQ(ParseTolerances("5", kPercent)[0].unit, kPercent);
  for (const char* bad : {"", ",", "1,", ",1", "1,,2", "x", "1x", "0", "-1",
                          "nan", "inf", "1 2", "1;2", "1e999"}) {
    EXPECT_THROW(ParseTolerances(bad, kMetres), std::invalid_argument) << bad;
  }
}

TEST(ToleranceTest, Text) {
  EXPECT_EQ(ToString({0.01, kMetres}), "1 cm");
  EXPECT_EQ(ToString({0.005, kMetres}), "0.5 cm");
  EXPECT_EQ(ToString({1.5, kMetres}), "1.5 m");
  EXPECT_EQ(ToString({0.5, kPercent}), "0.5 %");
}

// One view with a score that is easy to know and one without any measurement.
ScoreReport MakeReport() {
  ScoreReport report;
  report.tolerances = {{0.25, kMetres}, {1, kPercent}};
  report.names = {"one.jpg", "a_longer_name.jpg"};
  DepthMapScorer scorer(report.tolerances);
  Map<float> depth(2, 2, 1.25f);
  depth.At(1, 1) = 0;
  const Map<float> truth(2, 2, 1.0f);
  report.scores.push_back(scorer.Add(depth, truth));
  report.scores.push_back(scorer.Add(depth, Map<float>(2, 2, 0.0f)));
  report.overall = scorer.Overall();
  report.by_textureness = {{0.75, report.scores[0]}};
  return report;
}

TEST(ScoreTableTest, TableIsAligned) {
  std::ostringstream stream;
  PrintScores(MakeReport(), stream);
  std::istringstream lines(stream.str());
  std::string line;
  std::vector<std::string> table;
  while (std::getline(lines, line) && !line.empty()) table.push_back(line);
  ASSERT_EQ(table.size(), 5u);
  for (const std::string& row : table) {
    EXPECT_EQ(row.size(), table[0].size()) << row;
  }
  ExpectContains(table[2], "75.0");
  ExpectContains(table[2], "250.00");
  ExpectContains(table[2], "85.7");
  EXPECT_EQ(table[3].back(), '-') << table[3];
  ExpectContains(stream.str(), "25 cm               75.00      100.00  85.71");
  ExpectContains(stream.str(),
                 "Textureness below 0.75: coverage 75.0 % of 4 "
                 "pixels, 75.0 % of those with a measurement\n"
                 "Tolerance  Completeness %");
}

TEST(ScoreTableTest, Json) {
  // Through text, as a reader sees it.
  const nlohmann::json json =
      nlohmann::json::parse(ScoresToJson(MakeReport()).dump());
  ASSERT_EQ(json["images"].size(), 2u);
  const nlohmann::json& one = json["images"][0];
  EXPECT_EQ(one["name"], "one.jpg");
  EXPECT_EQ(one["coverage"], 0.75);
  EXPECT_EQ(one["median_absolute_error"], 0.25);
  EXPECT_EQ(one["tolerances"][0]["tolerance"], 0.25);
  EXPECT_EQ(one["tolerances"][0]["unit"], "m");
  EXPECT_EQ(one["tolerances"][0]["completeness"], 0.75);
  EXPECT_EQ(one["tolerances"][0]["accuracy"], 1.0);
  EXPECT_NEAR(one["tolerances"][0]["f1"].get<double>(), 1.5 / 1.75, 1e-12);
  EXPECT_EQ(one["tolerances"][1]["unit"], "%");
  EXPECT_EQ(one["tolerances"][1]["f1"], 0);
  EXPECT_TRUE(json["images"][1]["tolerances"][0]["f1"].is_null());
  EXPECT_EQ(json["overall"]["num_maps"], 2);
  EXPECT_EQ(json["overall"]["num_pixels"], 8);
  EXPECT_EQ(json["overall"]["num_measurements"], 4);
  ASSERT_EQ(json["by_textureness"].size(), 1u);
  const nlohmann::json& low = json["by_textureness"][0];
  EXPECT_EQ(low["max_textureness"], 0.75);
  EXPECT_EQ(low["score"]["num_maps"], 1);
  EXPECT_EQ(low["score"]["tolerances"][0]["completeness"], 0.75);
}

TEST(WorkspaceTest, ListsMapsOfOneTypeByName) {
  const TemporaryFolder folder;
  const std::string maps = "w/stereo/depth_maps/";
  WriteText(folder.File(maps + "b.jpg.geometric.bin"), "");
  WriteText(folder.File(maps + "a.png.geometric.bin"), "");
  WriteText(folder.File(maps + "rig/c.jpg.geometric.bin"), "");
  WriteText(folder.File(maps + "a.png.photometric.bin"), "");
  WriteText(folder.File(maps + ".geometric.bin"), "");
  const auto views = ListWorkspace(folder.path() + "/w", "geometric");
  ASSERT_EQ(views.size(), 3u);
  EXPECT_EQ(views[0].name, "a.png");
  EXPECT_EQ(views[1].name, "b.jpg");
  EXPECT_EQ(views[2].name, "rig/c.jpg");
  EXPECT_EQ(views[2].image_path, folder.path() + "/w/images/rig/c.jpg");
  EXPECT_EQ(views[2].normal_path,
            folder.path() + "/w/stereo/normal_maps/rig/c.jpg.geometric.bin");
  EXPECT_EQ(ListWorkspace(folder.path() + "/w", "photometric").size(), 1u);
}

TEST(WorkspaceTest, FindsGroundTruthByBaseName) {
  const TemporaryFolder folder;
  const std::string gt = folder.path() + "/gt";
  WriteText(folder.File("gt/a.png"), "");
  WriteText(folder.File("gt/rig/b.bin"), "");
  WriteText(folder.File("gt/b.png"), "");
  EXPECT_EQ(FindGroundTruth(gt, "a.jpg"), gt + "/a.png");
  EXPECT_EQ(FindGroundTruth(gt, "rig/a.jpg"), gt + "/a.png");
  EXPECT_EQ(FindGroundTruth(gt, "rig/b.jpg"), gt + "/rig/b.bin");
  EXPECT_EQ(FindGroundTruth(gt, "b.jpg"), gt + "/b.png");
  EXPECT_EQ(FindGroundTruth(gt, "c.jpg"), "");
  EXPECT_EQ(CountGroundTruth(gt), 3);
  EXPECT_THROW(CountGroundTruth(gt + "/none"), std::runtime_error);
}

}  // namespace
}  // namespace tapa
