// Drives the program itself: what it prints, writes and refuses.

#include <gtest/gtest.h>

#include <filesystem>
#include <limits>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <vector>

#include "tests/eval/run_program.h"
#include "tests/eval/test_files.h"

namespace tapa {
namespace {

// A workspace of two views of 6x4 pixels, of which a.jpg is exact but for one
// pixel and b.jpg is empty.
class EvaluateDepthMapsTest : public ::testing::Test {
 protected:
  void SetUp() override {
    WritePhotograph(folder_.File("w/images/a.jpg"), 6, 4);
    WritePhotograph(folder_.File("w/images/b.jpg"), 6, 4);
    std::vector<float> depth(24, 2);
    depth[0] = 2.25f;
    WriteColmapMap(folder_.File(kMaps + "a.jpg.geometric.bin"), 6, 4, 1, depth);
    WriteColmapMap(folder_.File(kMaps + "b.jpg.geometric.bin"), 6, 4, 1,
                   std::vector<float>(24, 0));
    for (const char* name : {"gt/a.png", "gt/b.png"}) {
      WriteDepthPng(folder_.File(name), 6, 4, std::vector<uint16_t>(24, 8000));
    }
  }

  Result Run(const std::string& arguments) {
    return RunProgram(EVALUATE_DEPTH_MAPS, arguments, folder_);
  }

  void ExpectError(const std::string& arguments, const std::string& part) {
    SCOPED_TRACE(arguments);
    ExpectErrorLine(Run(arguments), 1, part);
  }

  const std::string kMaps = "w/stereo/depth_maps/";
  const std::string kNormals = "w/stereo/normal_maps/";
  const std::string kBoth = "--workspace_path w --ground_truth_path gt ";
  TemporaryFolder folder_;
};

TEST_F(EvaluateDepthMapsTest, TableAndJson) {
  const Result result = Run(
      kBoth + "--tolerances 0.1,0.25 --relative_tolerances=1 --json s.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  ExpectContains(result.out, "a.jpg");
  ExpectContains(result.out, "F1 25 cm");

  const auto json = nlohmann::json::parse(ReadText(folder_.File("s.json")));
  EXPECT_EQ(json["input_type"], "geometric");
  EXPECT_TRUE(json["by_textureness"].empty());
  ASSERT_EQ(json["images"].size(), 2u);
  EXPECT_EQ(json["images"][0]["name"], "a.jpg");
  const auto& a = json["images"][0]["tolerances"];
  ASSERT_EQ(a.size(), 3u);
  EXPECT_DOUBLE_EQ(a[0]["f1"], 23.0 / 24);
  EXPECT_DOUBLE_EQ(a[1]["f1"], 1);
  EXPECT_EQ(a[2]["unit"], "%");
  EXPECT_DOUBLE_EQ(a[2]["f1"], 23.0 / 24);
  const auto& overall = json["overall"];
  EXPECT_EQ(overall["num_maps"], 2);
  EXPECT_DOUBLE_EQ(overall["coverage"], 0.5);
  EXPECT_DOUBLE_EQ(overall["median_absolute_error"], 0);
  EXPECT_DOUBLE_EQ(overall["tolerances"][1]["completeness"], 0.5);
  EXPECT_DOUBLE_EQ(overall["tolerances"][1]["accuracy"], 1);
}

TEST_F(EvaluateDepthMapsTest, PhotometricMapsAndOtherScale) {
  WriteColmapMap(folder_.File(kMaps + "a.jpg.photometric.bin"), 3, 2, 1,
                 std::vector<float>(6, 8));
  const Result result = Run(kBoth +
                            "--input_type photometric --depth_scale 1000 "
                            "--json s.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  const auto json = nlohmann::json::parse(ReadText(folder_.File("s.json")));
  EXPECT_EQ(json["images"].size(), 1u);
  EXPECT_EQ(json["overall"]["num_pixels"], 6);
  EXPECT_EQ(json["overall"]["num_measurements"], 24);
  EXPECT_EQ(json["overall"]["tolerances"][0]["f1"], 1);
  ExpectContains(result.out, "1 ground truth map without depth map");
}

TEST_F(EvaluateDepthMapsTest, InvalidDepthsAreReported) {
  std::vector<float> depth(24, 2);
  depth[3] = -2;
  depth[4] = std::numeric_limits<float>::quiet_NaN();
  WriteColmapMap(folder_.File(kMaps + "a.jpg.geometric.bin"), 6, 4, 1, depth);
  const Result result = Run(kBoth + "--pictures p --json s.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  ExpectContains(result.out, "2 pixels with a negative or not finite depth");
  const auto json = nlohmann::json::parse(ReadText(folder_.File("s.json")));
  EXPECT_EQ(json["overall"]["num_invalid"], 2);
  EXPECT_EQ(json["images"][0]["num_estimates"], 22);
}

TEST_F(EvaluateDepthMapsTest, BoundsOfTextureness) {
  // The left half of the photograph is flat; the patch reaches two pixels.
  cv::Mat image(4, 40, CV_8UC1, cv::Scalar(100));
  for (int row = 0; row < 4; ++row) {
    for (int col = 20; col < 40; ++col) {
      image.at<uint8_t>(row, col) = (row + col) % 2 * 255;
    }
  }
  const TemporaryFolder other;
  ASSERT_TRUE(cv::imwrite(other.File("w/images/a.png"), image));
  WriteColmapMap(other.File(kMaps + "a.png.geometric.bin"), 40, 4, 1,
                 std::vector<float>(160, 2));
  WriteDepthPng(other.File("gt/a.png"), 40, 4,
                std::vector<uint16_t>(160, 8000));
  const std::string both = "--workspace_path " + other.path() +
                           "/w --ground_truth_path " + other.path() + "/gt ";
  const Result result = Run(both + "--max_textureness 0.75,1 --json s.json");
  EXPECT_EQ(result.exit_code, 0) << result.err;
  ExpectContains(result.out, "Textureness below 0.75: coverage 100.0 % of 72");
  const auto json = nlohmann::json::parse(ReadText(folder_.File("s.json")));
  EXPECT_EQ(json["overall"]["num_pixels"], 4 * 40);
  const auto& bounds = json["by_textureness"];
  ASSERT_EQ(bounds.size(), 2u);
  EXPECT_EQ(bounds[0]["max_textureness"], 0.75);
  EXPECT_EQ(bounds[0]["score"]["num_maps"], 1);
  EXPECT_EQ(bounds[0]["score"]["num_measurements"], 4 * 18);
  EXPECT_EQ(bounds[0]["score"]["num_pixels"], 4 * 18);
  // Textureness does not reach 1.
  EXPECT_EQ(bounds[1]["max_textureness"], 1);
  EXPECT_EQ(bounds[1]["score"], json["overall"]);
}

TEST_F(EvaluateDepthMapsTest, Pictures) {
  WriteColmapMap(folder_.File(kNormals + "a.jpg.geometric.bin"), 6, 4, 3,
                 std::vector<float>(72, -1));
  const Result scored = Run(kBoth + "--pictures p/q");
  EXPECT_EQ(scored.exit_code, 0) << scored.err;
  const cv::Mat a = cv::imread(folder_.File("p/q/a.png"));
  const cv::Mat b = cv::imread(folder_.File("p/q/b.png"));
  ASSERT_FALSE(a.empty());
  ASSERT_FALSE(b.empty());
  EXPECT_GT(a.cols, b.cols);  // b.jpg has no normals

  const Result unscored = Run("--workspace_path w --pictures r");
  EXPECT_EQ(unscored.exit_code, 0) << unscored.err;
  EXPECT_EQ(unscored.out, "");
  EXPECT_FALSE(cv::imread(folder_.File("r/a.png")).empty());
}

TEST_F(EvaluateDepthMapsTest, Help) {
  const Result result = Run("--help");
  EXPECT_EQ(result.exit_code, 0);
  ExpectContains(result.out, "--workspace_path");
}

TEST_F(EvaluateDepthMapsTest, BadArguments) {
  ExpectError("", "--workspace_path is required");
  ExpectError("--workspace_path w", "--ground_truth_path is required");
  ExpectError("--workspace_path w --pictures p --json s.json",
              "need --ground_truth_path");
  ExpectError(kBoth + "--frobnicate 1", "frobnicate");
  ExpectError(kBoth + "--tol 1", "tol");
  ExpectError(kBoth + "stray", "positional");
  ExpectError("--workspace_path", "workspace_path");
  ExpectError(kBoth + "--input_type fused", "--input_type");
  ExpectError(kBoth + "--depth_scale 0", "--depth_scale");
  ExpectError(kBoth + "--depth_scale x", "depth_scale");
  ExpectError(kBoth + "--max_textureness 0.5", "--max_textureness");
  ExpectError(kBoth + "--max_textureness 0.75,1.1", "--max_textureness");
  for (const char* list : {"''", "0.1,", "0.1,x", "-1", "0", "nan"}) {
    ExpectError(kBoth + "--max_textureness " + list,
                "list of positive numbers");
    ExpectError(kBoth + "--tolerances " + list, "list of positive numbers");
    ExpectError(kBoth + "--relative_tolerances " + list,
                "list of positive numbers");
  }
}

TEST_F(EvaluateDepthMapsTest, MissingFolders) {
  ExpectError("--workspace_path none --ground_truth_path gt", "no workspace");
  ExpectError("--workspace_path gt --ground_truth_path gt",
              "no folder of depth maps");
  ExpectError("--workspace_path w --ground_truth_path none",
              "no folder of ground truth");
  ExpectError(kBoth + "--input_type photometric", "no photometric depth map");
  std::filesystem::rename(folder_.File("gt/a.png"), folder_.File("gt/x.png"));
  std::filesystem::rename(folder_.File("gt/b.png"), folder_.File("gt/y.png"));
  ExpectError(kBoth, "has the name of a depth map");
}

TEST_F(EvaluateDepthMapsTest, BrokenDepthMap) {
  const std::string path = folder_.File(kMaps + "a.jpg.geometric.bin");
  std::filesystem::resize_file(path, 50);
  ExpectError(kBoth, "is truncated");
  WriteText(path, "nonsense");
  ExpectError(kBoth, "is not a COLMAP depth or normal map");
  WriteColmapMap(path, 4, 6, 1, std::vector<float>(24, 2));
  ExpectError(kBoth, "a.jpg: a depth map of 4x6 pixels has another shape");
}

TEST_F(EvaluateDepthMapsTest, BrokenGroundTruth) {
  const std::string path = folder_.File("gt/a.png");
  std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
  ExpectError(kBoth, "gt/a.png is not a readable image");
  WriteText(path, "nonsense");
  ExpectError(kBoth, "gt/a.png is not a readable image");
  WritePhotograph(path, 6, 4);
  ExpectError(kBoth, "gt/a.png is not a 16-bit grey image");
}

TEST_F(EvaluateDepthMapsTest, MissingPhotographs) {
  std::filesystem::remove(folder_.File("w/images/a.jpg"));
  EXPECT_EQ(Run(kBoth).exit_code, 0);
  ExpectError(kBoth + "--pictures p", "cannot open w/images/a.jpg");
  ExpectError(kBoth + "--max_textureness 0.75", "cannot open w/images/a.jpg");
}

TEST_F(EvaluateDepthMapsTest, BrokenNormalMap) {
  WriteText(folder_.File(kNormals + "a.jpg.geometric.bin"), "6&4&3&abc");
  EXPECT_EQ(Run(kBoth).exit_code, 0);
  ExpectError(kBoth + "--pictures p", "is truncated");
}

TEST_F(EvaluateDepthMapsTest, OutputThatCannotBeWritten) {
  WriteText(folder_.File("file"), "");
  ExpectError(kBoth + "--json none/s.json", "cannot write none/s.json");
  ExpectError(kBoth + "--pictures file", "cannot write file/a.png");
}

TEST_F(EvaluateDepthMapsTest, PicturesNeverReplaceTheirSources) {
  const std::string before = ReadText(folder_.File("gt/a.png"));
  ExpectError(kBoth + "--pictures ./gt/", "would overwrite");
  ExpectError(kBoth + "--pictures w/images", "would overwrite");
  EXPECT_EQ(ReadText(folder_.File("gt/a.png")), before);
}

}  // namespace
}  // namespace tapa
