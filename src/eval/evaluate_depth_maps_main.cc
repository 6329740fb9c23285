// Compares the depth maps of a COLMAP workspace with measured depth, and draws
// pictures of them.

#include <cmath>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <opencv2/core.hpp>
#include <opencv2/core/utils/logger.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "src/base/map_files.h"
#include "src/eval/command_line.h"
#include "src/eval/depth_map_io.h"
#include "src/eval/depth_map_score.h"
#include "src/eval/score_table.h"
#include "src/eval/tolerance.h"
#include "src/eval/view_picture.h"
#include "src/eval/workspace.h"
#include "src/mvs/tapa/textureness.h"
#include "src/pictures/image_io.h"

namespace tapa {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string workspace_path;
  std::string ground_truth_path;
  std::string input_type = "geometric";
  std::string tolerances = "0.01,0.02,0.05,0.1,0.2";
  std::string relative_tolerances = "0.5,1,2";
  double depth_scale = 4000;
  std::string bounds;
  // From the list of bounds.
  std::vector<double> max_textureness;
  std::string json_path;
  std::string pictures_path;
};

CommandLine Describe(Arguments* arguments) {
  CommandLine line(
      "Compares the depth maps of a COLMAP workspace with measured depth.");
  line.Add("workspace_path", &arguments->workspace_path,
           "Dense workspace of COLMAP.");
  line.Add("ground_truth_path", &arguments->ground_truth_path,
           "Folder with one depth map per photograph, named like it: a 16-bit "
           "PNG, 0 where nothing was measured, or a COLMAP map (.bin). May be "
           "missing if only pictures are wanted.");
  line.AddWithDefault("input_type", &arguments->input_type,
                      "Which maps: geometric or photometric.");
  line.AddWithDefault("tolerances", &arguments->tolerances,
                      "Absolute errors that are tolerated, in metres.");
  line.AddWithDefault("relative_tolerances", &arguments->relative_tolerances,
                      "Relative errors that are tolerated, in per cent of the "
                      "true depth.");
  line.AddWithDefault("depth_scale", &arguments->depth_scale,
                      "Value of one metre in a ground-truth PNG.");
  line.Add("max_textureness", &arguments->bounds,
           "Also score the pixels whose textureness is below each of these "
           "bounds, which are separated by commas. Textureness is 0.5 where a "
           "photograph is flat and tends to 1 where it has much texture.");
  line.Add("json", &arguments->json_path,
           "File for all scores, of each view and overall.");
  line.Add("pictures", &arguments->pictures_path,
           "Folder for one PNG per view.");
  return line;
}

void CheckArguments(const Arguments& arguments) {
  if (arguments.workspace_path.empty()) {
    throw std::invalid_argument("--workspace_path is required");
  }
  if (arguments.input_type != "geometric" &&
      arguments.input_type != "photometric") {
    throw std::invalid_argument(
        "--input_type must be geometric or photometric");
  }
  if (!(arguments.depth_scale > 0) || !std::isfinite(arguments.depth_scale)) {
    throw std::invalid_argument("--depth_scale must be positive");
  }
  const double least = TexturenessOptions().min_textureness;
  for (const double bound : arguments.max_textureness) {
    if (!(bound > least && bound <= 1)) {
      throw std::invalid_argument(
          "--max_textureness must be above 0.5 and at most 1");
    }
  }
  if (arguments.ground_truth_path.empty()) {
    if (arguments.pictures_path.empty()) {
      throw std::invalid_argument(
          "--ground_truth_path is required, unless --pictures is given");
    }
    if (!arguments.json_path.empty() || !arguments.max_textureness.empty()) {
      throw std::invalid_argument(
          "--json and --max_textureness need --ground_truth_path");
    }
  }
  // Pictures are named like the files in these folders.
  for (const fs::path& source : {fs::path(arguments.workspace_path) / "images",
                                 fs::path(arguments.ground_truth_path)}) {
    std::error_code error;
    if (!arguments.pictures_path.empty() && !source.empty() &&
        fs::equivalent(arguments.pictures_path, source, error)) {
      throw std::invalid_argument("--pictures would overwrite the files in " +
                                  source.string());
    }
  }
}

std::vector<Tolerance> AllTolerances(const Arguments& arguments) {
  std::vector<Tolerance> tolerances =
      ParseTolerances(arguments.tolerances, Tolerance::Unit::kMetres);
  for (const Tolerance& tolerance : ParseTolerances(
           arguments.relative_tolerances, Tolerance::Unit::kPercent)) {
    tolerances.push_back(tolerance);
  }
  return tolerances;
}

// 1 at the pixels of lower textureness.
Map<uint8_t> LowTexture(const Map<float>& textureness, double bound) {
  Map<uint8_t> mask(textureness.width(), textureness.height());
  for (size_t i = 0; i < mask.size(); ++i) {
    mask.data()[i] = textureness.data()[i] < bound;
  }
  return mask;
}

// Scores all views once, whatever their number of bounds of textureness.
class WorkspaceScorer {
 public:
  WorkspaceScorer(const std::vector<Tolerance>& tolerances,
                  const std::vector<double>& bounds)
      : bounds_(bounds),
        scorer_(tolerances),
        bounded_(bounds.size(), DepthMapScorer(tolerances)) {}

  // Returns the score of the view alone, all of its pixels.
  DepthMapScore Add(const WorkspaceView& view, const Map<float>& depth,
                    const Map<float>& truth) {
    DepthMapScore score;
    try {
      score = scorer_.Add(depth, truth);
    } catch (const std::invalid_argument& error) {
      throw std::runtime_error(view.name + ": " + error.what());
    }
    if (bounds_.empty()) return score;
    // At the size of the ground truth, so that maps of all sizes are judged at
    // the same places.
    const Map<float> textureness = ComputeTextureness(
        ReadGrey(view.image_path, truth.width(), truth.height()));
    for (size_t i = 0; i < bounds_.size(); ++i) {
      const Map<uint8_t> mask = LowTexture(textureness, bounds_[i]);
      bounded_[i].Add(depth, truth, &mask);
    }
    return score;
  }

  // Adds the scores of all views together to a report.
  void Finish(ScoreReport* report) const {
    report->overall = scorer_.Overall();
    for (size_t i = 0; i < bounds_.size(); ++i) {
      report->by_textureness.push_back({bounds_[i], bounded_[i].Overall()});
    }
  }

 private:
  std::vector<double> bounds_;
  DepthMapScorer scorer_;
  std::vector<DepthMapScorer> bounded_;
};

void WriteView(const WorkspaceView& view, const Map<float>& depth,
               const Map<float>* truth, const std::vector<std::string>& notes,
               const std::string& folder) {
  ViewPicture picture;
  picture.title = view.name;
  picture.photograph = ReadColor(view.image_path);
  picture.depth = &depth;
  Map<Vec3> normal;
  if (fs::exists(view.normal_path)) {
    normal = ReadNormalMap(view.normal_path);
    picture.normal = &normal;
  }
  picture.ground_truth = truth;
  picture.notes = notes;
  const fs::path path = fs::path(folder) / view.name;
  WritePng(fs::path(path).replace_extension(".png").string(),
           DrawView(picture));
}

void PrintRemarks(const ScoreReport& report, int num_maps,
                  int num_ground_truth) {
  const auto number = [](int64_t count, const std::string& what) {
    return std::to_string(count) + " " + what + (count == 1 ? "" : "s");
  };
  const int num_scored = static_cast<int>(report.overall.num_maps);
  if (num_scored < num_maps) {
    std::cout << number(num_maps - num_scored, "depth map")
              << " without ground truth: not scored.\n";
  }
  if (num_scored < num_ground_truth) {
    std::cout << number(num_ground_truth - num_scored, "ground truth map")
              << " without depth map: not scored.\n";
  }
  if (report.overall.num_invalid > 0) {
    std::cout << number(report.overall.num_invalid, "pixel")
              << " with a negative or not finite depth: counted as without "
                 "estimate.\n";
  }
}

void Run(const Arguments& arguments) {
  const bool scoring = !arguments.ground_truth_path.empty();
  const std::vector<WorkspaceView> views =
      ListWorkspace(arguments.workspace_path, arguments.input_type);
  const int num_ground_truth =
      scoring ? CountGroundTruth(arguments.ground_truth_path) : 0;
  ScoreReport report;
  report.tolerances = AllTolerances(arguments);
  WorkspaceScorer scorer(report.tolerances, arguments.max_textureness);

  for (const WorkspaceView& view : views) {
    const std::string truth_path =
        scoring ? FindGroundTruth(arguments.ground_truth_path, view.name) : "";
    if (truth_path.empty() && arguments.pictures_path.empty()) continue;
    const Map<float> depth = ReadDepthMap(view.depth_path);
    Map<float> truth;
    std::vector<std::string> notes;
    if (!truth_path.empty()) {
      truth = ReadGroundTruth(truth_path, arguments.depth_scale);
      const DepthMapScore score = scorer.Add(view, depth, truth);
      notes = {
          "coverage " + PercentText(score.Coverage(), 1) + " %",
          "median error " + PercentText(score.median_relative_error, 2) + " %"};
      report.names.push_back(view.name);
      report.scores.push_back(score);
    }
    if (!arguments.pictures_path.empty()) {
      WriteView(view, depth, truth.empty() ? nullptr : &truth, notes,
                arguments.pictures_path);
    }
  }

  if (!scoring) return;
  if (report.names.empty()) {
    throw std::runtime_error("no ground truth in " +
                             arguments.ground_truth_path +
                             " has the name of a depth map");
  }
  scorer.Finish(&report);
  PrintScores(report, std::cout);
  PrintRemarks(report, static_cast<int>(views.size()), num_ground_truth);
  if (!arguments.json_path.empty()) {
    nlohmann::json json = ScoresToJson(report);
    json["workspace_path"] = arguments.workspace_path;
    json["ground_truth_path"] = arguments.ground_truth_path;
    json["input_type"] = arguments.input_type;
    WriteJson(arguments.json_path, json);
  }
}

void ParseAndRun(int argc, char** argv) {
  // What OpenCV has to say about bad files is said here, in one line.
  cv::utils::logging::setLogLevel(cv::utils::logging::LOG_LEVEL_SILENT);
  Arguments arguments;
  CommandLine line = Describe(&arguments);
  if (!line.Parse(argc, argv)) return;
  if (line.IsGiven("max_textureness")) {
    for (const Tolerance& bound :
         ParseTolerances(arguments.bounds, Tolerance::Unit::kMetres)) {
      arguments.max_textureness.push_back(bound.value);
    }
  }
  CheckArguments(arguments);
  Run(arguments);
}

}  // namespace
}  // namespace tapa

int main(int argc, char** argv) {
  return tapa::RunMain([&] { tapa::ParseAndRun(argc, argv); });
}
