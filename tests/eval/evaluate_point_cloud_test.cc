// Drives the program itself: what it prints, writes and refuses.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "src/eval/point_cloud.h"
#include "tests/eval/cloud_files.h"
#include "tests/eval/run_program.h"

namespace tapa {
namespace {

// A scan of two points 4 m away in cubes of their own, one of which is
// reconstructed exactly, with another point in the empty space before it.
class EvaluatePointCloudTest : public ::testing::Test {
 protected:
  void SetUp() override {
    WritePoints(folder_.File("r.ply"), {{4, 0, 0.25f}, {3, 0, 0.1875f}});
    WritePoints(folder_.File("gt/s.ply"), {{4, 0, 0.25f}, {4, 2, 0.25f}});
    WriteProject(folder_.File("gt/p.mlp"), {{"s.ply"}});
  }

  Result Run(const std::string& arguments) {
    return RunProgram(EVALUATE_POINT_CLOUD, arguments, folder_);
  }

  void ExpectError(const std::string& arguments, const std::string& part,
                   int exit_code = 1) {
    SCOPED_TRACE(arguments);
    const Result result = Run(arguments);
    ExpectErrorLine(result, exit_code, part);
    EXPECT_EQ(result.out.find("F1"), std::string::npos);
  }

  // The scores are given, with a single line of warning.
  void ExpectWarning(const std::string& part) {
    const Result result = Run(kAll);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    EXPECT_EQ(result.err.find("WARNING: "), 0u) << result.err;
    ExpectContains(result.err, part);
    EXPECT_EQ(result.err.find('\n'), result.err.size() - 1) << result.err;
    ExpectContains(result.out, "F1-scores: ");
  }

  std::vector<std::string> FilesIn(const std::string& name) const {
    std::vector<std::string> names;
    for (const auto& entry :
         std::filesystem::directory_iterator(folder_.path() + "/" + name)) {
      names.push_back(entry.path().filename().string());
    }
    std::sort(names.begin(), names.end());
    return names;
  }

  // Colours of the points of a file, behind a header and 12 bytes each.
  std::vector<std::string> Colors(const std::string& name) const {
    const std::string text = ReadText(folder_.path() + "/" + name);
    const std::string end = "end_header\n";
    std::vector<std::string> colors;
    for (size_t i = text.find(end) + end.size(); i < text.size(); i += 15) {
      colors.push_back(text.substr(i + 12, 3));
    }
    return colors;
  }

  const std::string kInputs =
      "--reconstruction_ply_path r.ply --ground_truth_mlp_path gt/p.mlp ";
  const std::string kAll = kInputs + "--tolerances 0.125,1.5 ";
  TemporaryFolder folder_;
};

const char kGreen[] = "\x00\xff\x00";
const char kRed[] = "\xff\x00\x00";
const char kBlue[] = "\x00\x00\xff";

std::string Color(const char* bytes) { return std::string(bytes, 3); }

TEST_F(EvaluatePointCloudTest, Output) {
  const Result result = Run(kAll);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  EXPECT_EQ(result.out,
            "Loading reconstruction: r.ply\n"
            "Loading scan: gt/s.ply\n"
            "Computing completeness\n"
            "Computing accuracy\n"
            "Tolerances: 0.125 1.5\n"
            "Completenesses: 0.5 0.5\n"
            "Accuracies: 0.5 1\n"
            "F1-scores: 0.5 0.666667\n");
}

TEST_F(EvaluatePointCloudTest, TolerancesAreSorted) {
  const Result result = Run(kInputs + "--tolerances 1.5,0.125");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, Run(kAll).out);
}

TEST_F(EvaluatePointCloudTest, Json) {
  const Result result = Run(kInputs + "--tolerances 0.1,0.2,1.5 --json s.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(ReadText(folder_.File("s.json")));
  EXPECT_EQ(json.size(), 4u);
  EXPECT_EQ(json["tolerances"], (std::vector<double>{0.1, 0.2, 1.5}));
  EXPECT_EQ(json["completeness"], (std::vector<double>{0.5, 0.5, 0.5}));
  EXPECT_EQ(json["accuracy"], (std::vector<double>{0.5, 0.5, 1}));
  EXPECT_DOUBLE_EQ(json["f1"][2], 2.0 / 3);
}

TEST_F(EvaluatePointCloudTest, OptionsOfTheBeamAndTheVoxels) {
  // The point in empty space is a decimetre beside the beam.
  WritePoints(folder_.File("r.ply"), {{4, 0, 0.25f}, {3, 0.1f, 0.1875f}});
  const auto accuracies = [&](const std::string& options) {
    const std::string out = Run(kAll + options).out;
    const size_t begin = out.find("Accuracies: ");
    return out.substr(begin, out.find('\n', begin) - begin);
  };
  EXPECT_EQ(accuracies(""), "Accuracies: 1 1");
  EXPECT_EQ(accuracies("--beam_start_radius_meters 0.09"), "Accuracies: 1 1");
  EXPECT_EQ(accuracies("--beam_start_radius_meters 0.11"), "Accuracies: 0.5 1");
  EXPECT_EQ(accuracies("--beam_start_radius_meters 0 "
                       "--beam_divergence_halfangle_deg 1.8"),
            "Accuracies: 1 1");
  EXPECT_EQ(accuracies("--beam_start_radius_meters=0 "
                       "--beam_divergence_halfangle_deg=2"),
            "Accuracies: 0.5 1");

  // All in one cube of either grid.
  const Result result = Run(kAll + "--voxel_size 100 --num_threads 3");
  ExpectContains(result.out, "Completenesses: 0.5 0.5\n");
  WritePoints(folder_.File("gt/s.ply"),
              {{4, 0, 0.25f}, {4, 2, 0.25f}, {4, 2, 0.25f}, {4, 2, 0.25f}});
  ExpectContains(Run(kAll + "--voxel_size 100").out,
                 "Completenesses: 0.25 0.25\n");
  ExpectContains(Run(kAll).out, "Completenesses: 0.5 0.5\n");
}

TEST_F(EvaluatePointCloudTest, ColoredClouds) {
  WritePoints(folder_.File("r.ply"),
              {{4, 0, 0.25f}, {3, 0, 0.1875f}, {-3, 0, 0}});
  WriteProject(folder_.File("gt/p.mlp"),
               {{"s.ply", "1 0 0 0 0 1 0 0 0 0 1 0.5 0 0 0 1"}, {"s.ply"}});
  const Result result = Run(kAll +
                            "--completeness_cloud_output_path out/deep/c "
                            "--accuracy_cloud_output_path out/a");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(FilesIn("out"),
            (std::vector<std::string>{"a.tolerance_0.125.ply",
                                      "a.tolerance_1.5.ply", "deep"}));
  EXPECT_EQ(FilesIn("out/deep"),
            (std::vector<std::string>{"c.tolerance_0.125.ply",
                                      "c.tolerance_1.5.ply"}));

  // The scans in the world, one after the other.
  const std::vector<Vec3> points =
      ReadPointCloud(folder_.File("out/deep/c.tolerance_0.125.ply")).points;
  ASSERT_EQ(points.size(), 4u);
  EXPECT_EQ(points[1].z, 0.75f);
  EXPECT_EQ(points[3].z, 0.25f);
  EXPECT_EQ(points[3].y, 2);
  EXPECT_EQ(Colors("out/deep/c.tolerance_0.125.ply"),
            (std::vector<std::string>{Color(kRed), Color(kRed), Color(kGreen),
                                      Color(kRed)}));
  EXPECT_EQ(Colors("out/deep/c.tolerance_1.5.ply"),
            (std::vector<std::string>{Color(kGreen), Color(kRed), Color(kGreen),
                                      Color(kRed)}));
  EXPECT_EQ(
      Colors("out/a.tolerance_0.125.ply"),
      (std::vector<std::string>{Color(kGreen), Color(kRed), Color(kBlue)}));
  EXPECT_EQ(
      Colors("out/a.tolerance_1.5.ply"),
      (std::vector<std::string>{Color(kGreen), Color(kGreen), Color(kBlue)}));
}

TEST_F(EvaluatePointCloudTest, Help) {
  const Result result = Run("--help");
  EXPECT_EQ(result.exit_code, 0);
  ExpectContains(result.out, "--reconstruction_ply_path");
}

TEST_F(EvaluatePointCloudTest, BadArguments) {
  ExpectError("", "--reconstruction_ply_path is required");
  ExpectError("--reconstruction_ply_path r.ply --tolerances 1",
              "--ground_truth_mlp_path is required");
  ExpectError(kInputs, "--tolerances is required");
  for (const char* list : {"''", "0.1,", "0.1,x", "-1", "nan"}) {
    ExpectError(kInputs + "--tolerances " + list, "list of positive numbers");
  }
  std::string many = "1";
  for (int i = 0; i < 250; ++i) many += ",1";
  ExpectError(kInputs + "--tolerances " + many, "at most 250");
  ExpectError(kAll + "--voxel_size 0", "--voxel_size must be positive");
  ExpectError(kAll + "--voxel_size nan", "--voxel_size must be positive");
  ExpectError(kAll + "--beam_start_radius_meters -1",
              "--beam_start_radius_meters must not be negative");
  for (const char* angle : {"-1", "90", "nan"}) {
    ExpectError(kAll + "--beam_divergence_halfangle_deg " + angle,
                "--beam_divergence_halfangle_deg must be");
  }
  ExpectError(kAll + "--frobnicate 1", "frobnicate");
  ExpectError(kAll + "--num_threads x", "num_threads");
  ExpectError(kAll + "stray", "positional");
}

TEST_F(EvaluatePointCloudTest, BadReconstruction) {
  std::filesystem::remove(folder_.File("r.ply"));
  ExpectError(kAll, "cannot open r.ply", 2);
  WriteText(folder_.File("r.ply"), "nonsense");
  ExpectError(kAll, "r.ply is not a PLY file", 2);
  WriteText(folder_.File("r.ply"),
            "ply\nformat binary_big_endian 1.0\nelement vertex 2\n"
            "property float x\nproperty float y\nproperty float z\n"
            "end_header\n0123456789");
  ExpectError(kAll, "r.ply is truncated", 2);
}

TEST_F(EvaluatePointCloudTest, BadScans) {
  WriteProject(folder_.File("gt/p.mlp"), {{"s.ply"}, {"none.ply"}});
  ExpectError(kAll, "cannot open gt/none.ply");
  WriteProject(folder_.File("gt/p.mlp"),
               {{"s.ply", "2 0 0 0 0 2 0 0 0 0 2 0 0 0 0 1"}});
  ExpectError(kAll, "gt/p.mlp: scan s.ply has a pose that is not a rotation");
  WriteText(folder_.File("gt/p.mlp"), "nonsense");
  ExpectError(kAll, "gt/p.mlp is not a MeshLab project");
  std::filesystem::remove(folder_.File("gt/p.mlp"));
  ExpectError(kAll, "cannot open gt/p.mlp");
}

TEST_F(EvaluatePointCloudTest, EmptyClouds) {
  WritePoints(folder_.File("r.ply"), {});
  ExpectWarning("r.ply has no points; all scores are 0");
  ExpectContains(Run(kAll).out,
                 "Completenesses: 0 0\nAccuracies: 0 0\n"
                 "F1-scores: 0 0\n");
  WritePoints(folder_.File("gt/s.ply"), {});
  EXPECT_EQ(Run(kAll).exit_code, 1);
  WritePoints(folder_.File("r.ply"), {{4, 0, 0.25f}});
  ExpectError(kAll, "gt/s.ply has no points");
}

TEST_F(EvaluatePointCloudTest, NotFinitePoints) {
  WritePoints(folder_.File("r.ply"),
              {{4, 0, 0.25f}, {NAN, 0, 0}, {3, 0, 0.1875f}});
  ExpectWarning("r.ply has 1 points with a coordinate that is infinite or not");
  ExpectContains(Run(kAll).out, "Accuracies: 0.5 1\n");
  SetUp();
  WritePoints(folder_.File("gt/s.ply"),
              {{4, 0, 0.25f}, {INFINITY, 0, 0}, {4, 2, 0.25f}});
  ExpectWarning("gt/s.ply has 1 points");
  ExpectContains(Run(kAll).out, "Completenesses: 0.5 0.5\n");
}

TEST_F(EvaluatePointCloudTest, AnotherUnit) {
  // A corner of a wall that the scan has in millimetres.
  std::vector<Vec3> metres, millimetres;
  for (int i = 0; i < 100; ++i) {
    const float y = 0.01f * static_cast<float>(i);
    metres.push_back({0.3f, y, 0});
    millimetres.push_back({300, 1000 * y, 0});
  }
  WritePoints(folder_.File("r.ply"), metres);
  WritePoints(folder_.File("gt/s.ply"), millimetres);
  const Result result = Run(kAll);
  EXPECT_EQ(result.exit_code, 0);
  ExpectContains(result.err,
                 "WARNING: gt/s.ply is 1e+03 times larger than the "
                 "reconstruction");
  ExpectContains(result.err, "both are in metres");
}

TEST_F(EvaluatePointCloudTest, AnotherFrame) {
  WritePoints(folder_.File("r.ply"), {{4, 50, 0.25f}, {4, 52, 0.1875f}});
  const Result result = Run(kAll);
  EXPECT_EQ(result.exit_code, 0);
  ExpectContains(result.err, "WARNING: no point of the scans is within 1.5 m");
  ExpectContains(result.err,
                 "WARNING: no point of the reconstruction can be "
                 "judged");
  ExpectContains(result.out, "F1-scores: 0 0\n");
}

TEST_F(EvaluatePointCloudTest, OutputThatCannotBeWritten) {
  WriteText(folder_.File("file"), "");
  const Result json = Run(kAll + "--json none/s.json");
  ExpectErrorLine(json, 1, "Cannot write none/s.json");
  ExpectContains(json.out, "F1-scores: ");
  ExpectError(kAll + "--completeness_cloud_output_path file/c",
              "Cannot write file/c.tolerance_0.125.ply");
  ExpectError(kAll + "--accuracy_cloud_output_path file/a",
              "Cannot write file/a.tolerance_0.125.ply");
  const std::string before = ReadText(folder_.File("r.ply"));
  ExpectError(kAll + "--json ./r.ply", "--json would overwrite r.ply");
  ExpectError(kAll + "--json gt/p.mlp", "--json would overwrite gt/p.mlp");
  EXPECT_EQ(ReadText(folder_.File("r.ply")), before);
}

TEST_F(EvaluatePointCloudTest, NothingIsLeftBesideTheOutput) {
  WriteText(folder_.File("out/s.json"), "old");
  EXPECT_EQ(Run(kAll + "--json out/s.json").exit_code, 0);
  EXPECT_EQ(FilesIn("out"), std::vector<std::string>{"s.json"});
  EXPECT_EQ(ReadText(folder_.File("out/s.json"))[0], '{');
  std::filesystem::remove(folder_.File("r.ply"));
  EXPECT_EQ(Run(kAll + "--json out/s.json").exit_code, 2);
  EXPECT_EQ(ReadText(folder_.File("out/s.json"))[0], '{');
}

}  // namespace
}  // namespace tapa
