// Compares a point cloud with laser scans, with the options, the output and the
// exit codes of ETH3D's own evaluation program.

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <iostream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <stdexcept>
#include <string>
#include <vector>

#include "src/base/atomic_file.h"
#include "src/base/parallel.h"
#include "src/eval/cloud_checks.h"
#include "src/eval/command_line.h"
#include "src/eval/meshlab_project.h"
#include "src/eval/point_cloud.h"
#include "src/eval/point_cloud_score.h"
#include "src/eval/tolerance.h"

namespace tapa {
namespace {

namespace fs = std::filesystem;

// Where the reconstruction cannot be read.
constexpr int kReconstructionFailure = 2;

struct Arguments {
  std::string reconstruction_path;
  std::string project_path;
  std::string tolerance_list;
  // From the list, in rising order.
  std::vector<double> tolerances;
  double voxel_size = 0.01;
  BeamShape beam;
  std::string completeness_cloud_path;
  std::string accuracy_cloud_path;
  std::string json_path;
  int num_threads = -1;
};

CommandLine Describe(Arguments* arguments) {
  CommandLine line("Compares a point cloud with laser scans as ETH3D does.");
  line.Add("reconstruction_ply_path", &arguments->reconstruction_path,
           "Point cloud to be scored, a PLY file.");
  line.Add("ground_truth_mlp_path", &arguments->project_path,
           "MeshLab project with the scans and their poses.");
  line.Add(
      "tolerances", &arguments->tolerance_list,
      "Distances that are tolerated, in metres: 0.01,0.02,0.05,0.1,0.2,0.5 in "
      "most publications.");
  line.AddWithDefault(
      "voxel_size", &arguments->voxel_size,
      "Edge of the cubes that points are averaged over, in metres.");
  line.AddWithDefault("beam_start_radius_meters", &arguments->beam.start_radius,
                      "Radius of a scanner's beam at the scanner.");
  line.AddWithDefault("beam_divergence_halfangle_deg",
                      &arguments->beam.divergence_halfangle,
                      "Half the opening angle of the beam, in degrees.");
  line.Add(
      "completeness_cloud_output_path", &arguments->completeness_cloud_path,
      "If given, the scans are written to <path>.tolerance_<tolerance>.ply: "
      "green where they are complete, else red.");
  line.Add(
      "accuracy_cloud_output_path", &arguments->accuracy_cloud_path,
      "If given, the reconstruction is written to "
      "<path>.tolerance_<tolerance>.ply: green where it is accurate, red where "
      "it is not, blue where it cannot be judged.");
  line.Add("json", &arguments->json_path, "File for the scores.");
  line.AddWithDefault("num_threads", &arguments->num_threads,
                      "Number of threads; -1: one per core.");
  return line;
}

std::vector<double> ParseSortedTolerances(const std::string& list) {
  std::vector<double> tolerances;
  for (const Tolerance& tolerance :
       ParseTolerances(list, Tolerance::Unit::kMetres)) {
    tolerances.push_back(tolerance.value);
  }
  if (tolerances.size() > kMaxNumTolerances) {
    throw std::invalid_argument("--tolerances may have at most " +
                                std::to_string(kMaxNumTolerances) + " values");
  }
  std::sort(tolerances.begin(), tolerances.end());
  return tolerances;
}

void CheckArguments(const Arguments& arguments) {
  const BeamShape& beam = arguments.beam;
  if (!(arguments.voxel_size > 0) || !std::isfinite(arguments.voxel_size)) {
    throw std::invalid_argument("--voxel_size must be positive");
  }
  if (!(beam.start_radius >= 0) || !std::isfinite(beam.start_radius)) {
    throw std::invalid_argument(
        "--beam_start_radius_meters must not be negative");
  }
  if (!(beam.divergence_halfangle >= 0 && beam.divergence_halfangle < 90)) {
    throw std::invalid_argument(
        "--beam_divergence_halfangle_deg must be at least 0 and below 90");
  }
  for (const std::string& path :
       {arguments.reconstruction_path, arguments.project_path}) {
    std::error_code error;
    if (!arguments.json_path.empty() &&
        fs::equivalent(arguments.json_path, path, error)) {
      throw std::invalid_argument("--json would overwrite " + path);
    }
  }
}

void Warn(const std::string& text) {
  if (!text.empty()) std::cerr << "WARNING: " << text << "." << std::endl;
}

std::vector<Vec3> ReadPoints(const std::string& path, double least_tolerance) {
  PointCloud cloud = ReadPointCloud(path);
  if (cloud.num_not_finite > 0) {
    Warn(path + " has " + std::to_string(cloud.num_not_finite) +
         " points with a coordinate that is infinite or not a number; they are "
         "left out");
  }
  Warn(CheckPrecision(cloud.points, least_tolerance, path));
  return std::move(cloud.points);
}

std::vector<Vec3> ReadReconstruction(const Arguments& arguments) {
  const std::string& path = arguments.reconstruction_path;
  std::cout << "Loading reconstruction: " << path << std::endl;
  try {
    std::vector<Vec3> points = ReadPoints(path, arguments.tolerances.front());
    if (points.empty()) {
      Warn(path + " has no points; all scores are 0");
    }
    return points;
  } catch (const std::runtime_error& error) {
    throw ExitError(kReconstructionFailure, error.what());
  }
}

std::vector<LaserScan> ReadScans(const std::vector<ScanFile>& files,
                                 const std::vector<Vec3>& reconstruction,
                                 double least_tolerance) {
  std::vector<LaserScan> scans;
  for (const ScanFile& file : files) {
    std::cout << "Loading scan: " << file.path << std::endl;
    scans.push_back({ReadPoints(file.path, least_tolerance), file.pose});
    const std::vector<Vec3>& points = scans.back().points;
    if (points.empty()) {
      throw std::runtime_error(
          file.path + " has no points; leave it out of the MeshLab project");
    }
    if (points.size() > UINT32_MAX - 1) {
      throw std::runtime_error(file.path + " has more than 2^32 points");
    }
    Warn(CheckUnit(reconstruction, points, file.path));
  }
  return scans;
}

// Tolerances and scores have the same length.
struct Scores {
  std::vector<double> tolerances;
  std::vector<double> completeness;
  std::vector<double> accuracy;
  std::vector<double> f1;
};

// Writes points once per tolerance, as PATH.tolerance_0.01.ply.
void WriteClouds(const std::string& path, const std::vector<Vec3>& points,
                 const std::vector<Verdict>& verdicts,
                 const std::vector<double>& tolerances) {
  const fs::path folder = fs::path(path).parent_path();
  std::error_code error;  // Reported when a file in it cannot be written.
  if (!folder.empty()) fs::create_directories(folder, error);
  for (size_t t = 0; t < tolerances.size(); ++t) {
    std::ostringstream name;
    name << path << ".tolerance_" << tolerances[t] << ".ply";
    WriteColoredPoints(name.str(), points, [&](size_t i) {
      if (verdicts[i].GoodAt(t)) return Rgb{0, 255, 0};
      return verdicts[i].judged ? Rgb{255, 0, 0} : Rgb{0, 0, 255};
    });
  }
}

// Writes the coloured clouds, if they are wanted, and takes the mean.
std::vector<double> Summarize(const Arguments& arguments,
                              const std::string& cloud_path,
                              const std::vector<Vec3>& points,
                              const std::vector<Verdict>& verdicts,
                              ThreadTeam* team) {
  if (!cloud_path.empty()) {
    WriteClouds(cloud_path, points, verdicts, arguments.tolerances);
  }
  return AverageOverVoxels(points, verdicts, arguments.tolerances.size(),
                           arguments.voxel_size, team);
}

std::vector<double> ScoreCompleteness(const Arguments& arguments,
                                      const std::vector<Vec3>& reconstruction,
                                      const std::vector<LaserScan>& scans,
                                      ThreadTeam* team) {
  std::cout << "Computing completeness" << std::endl;
  const std::vector<double>& tolerances = arguments.tolerances;
  const std::vector<Vec3> points = MergeScans(scans, team);
  const std::vector<Verdict> verdicts =
      JudgeCompleteness(points, reconstruction, tolerances, team);
  if (!reconstruction.empty()) {
    Warn(CheckOverlap(verdicts, tolerances.back(), tolerances.size()));
  }
  return Summarize(arguments, arguments.completeness_cloud_path, points,
                   verdicts, team);
}

std::vector<double> ScoreAccuracy(const Arguments& arguments,
                                  const std::vector<Vec3>& reconstruction,
                                  const std::vector<LaserScan>& scans,
                                  ThreadTeam* team) {
  std::cout << "Computing accuracy" << std::endl;
  const std::vector<Verdict> verdicts = JudgeAccuracy(
      reconstruction, scans, arguments.tolerances, arguments.beam, team);
  if (!reconstruction.empty()) {
    Warn(CheckJudged(verdicts, arguments.tolerances.size()));
  }
  return Summarize(arguments, arguments.accuracy_cloud_path, reconstruction,
                   verdicts, team);
}

void PrintLine(const std::string& name, const std::vector<double>& values) {
  std::cout << name << ":";
  for (const double value : values) std::cout << " " << value;
  std::cout << std::endl;
}

void WriteJson(const std::string& path, const Scores& scores) {
  const nlohmann::json json = {{"tolerances", scores.tolerances},
                               {"completeness", scores.completeness},
                               {"accuracy", scores.accuracy},
                               {"f1", scores.f1}};
  const std::string text = json.dump(2) + "\n";
  AtomicFile file(path);
  file.Write(text.data(), text.size());
  file.Commit();
}

void Run(const Arguments& arguments) {
  const std::vector<ScanFile> files =
      ReadMeshLabProject(arguments.project_path);
  const std::vector<Vec3> reconstruction = ReadReconstruction(arguments);
  const std::vector<LaserScan> scans =
      ReadScans(files, reconstruction, arguments.tolerances.front());

  ThreadTeam team(EffectiveNumThreads(arguments.num_threads));
  Scores scores;
  scores.tolerances = arguments.tolerances;
  scores.completeness =
      ScoreCompleteness(arguments, reconstruction, scans, &team);
  scores.accuracy = ScoreAccuracy(arguments, reconstruction, scans, &team);
  for (size_t t = 0; t < scores.tolerances.size(); ++t) {
    scores.f1.push_back(F1Score(scores.completeness[t], scores.accuracy[t]));
  }
  PrintLine("Tolerances", scores.tolerances);
  PrintLine("Completenesses", scores.completeness);
  PrintLine("Accuracies", scores.accuracy);
  PrintLine("F1-scores", scores.f1);
  if (!arguments.json_path.empty()) WriteJson(arguments.json_path, scores);
}

void ParseAndRun(int argc, char** argv) {
  Arguments arguments;
  CommandLine line = Describe(&arguments);
  if (!line.Parse(argc, argv)) return;
  for (const char* name :
       {"reconstruction_ply_path", "ground_truth_mlp_path", "tolerances"}) {
    line.Require(name);
  }
  arguments.tolerances = ParseSortedTolerances(arguments.tolerance_list);
  CheckArguments(arguments);
  Run(arguments);
}

}  // namespace
}  // namespace tapa

int main(int argc, char** argv) {
  return tapa::RunMain([&] { tapa::ParseAndRun(argc, argv); });
}
