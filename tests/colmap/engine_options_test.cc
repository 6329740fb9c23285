#include "src/colmap/engine_options.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <limits>
#include <new>
#include <set>
#include <string>
#include <vector>

#include "src/base/failure.h"

namespace tapa {
namespace {

using colmap::mvs::PatchMatchOptions;

std::string ErrorOf(const PatchMatchOptions& options) {
  try {
    CheckOptions(options);
  } catch (const Failure& error) {
    return error.what();
  }
  return "";
}

// Bytes of options of TAPA, to tell apart any two of them. Those between the
// members are zeros.
std::string TapaBytes(const TapaOptions& options) {
  std::string bytes(reinterpret_cast<const char*>(&options), sizeof(options));
  // What the constructor leaves alone lies between the members.
  alignas(TapaOptions) char zeros[sizeof(TapaOptions)];
  alignas(TapaOptions) char ones[sizeof(TapaOptions)];
  std::fill(std::begin(zeros), std::end(zeros), '\0');
  std::fill(std::begin(ones), std::end(ones), '\1');
  new (zeros) TapaOptions;
  new (ones) TapaOptions;
  for (size_t i = 0; i < bytes.size(); ++i) {
    if (zeros[i] != ones[i]) {
      bytes[i] = 0;
    }
  }
  return bytes;
}

std::string TapaBytes(const PatchMatchOptions& options) {
  return TapaBytes(EngineOptions(options).tapa);
}

TEST(EngineOptions, DefaultsAgree) {
  const Options defaults;
  const Options options = EngineOptions(PatchMatchOptions());
  EXPECT_EQ(ErrorOf(PatchMatchOptions()), "");
  EXPECT_EQ(options.window_radius, defaults.window_radius);
  EXPECT_EQ(options.window_step, defaults.window_step);
  EXPECT_EQ(options.sigma_spatial, defaults.sigma_spatial);
  EXPECT_FLOAT_EQ(options.sigma_color, defaults.sigma_color);
  EXPECT_EQ(options.num_samples, defaults.num_samples);
  EXPECT_FLOAT_EQ(options.ncc_sigma, defaults.ncc_sigma);
  EXPECT_EQ(options.num_iterations, defaults.num_iterations);
  EXPECT_EQ(options.geom_consistency, defaults.geom_consistency);
  EXPECT_EQ(options.filter, defaults.filter);
  EXPECT_FLOAT_EQ(options.filter_min_ncc, defaults.filter_min_ncc);
  EXPECT_EQ(options.num_threads, defaults.num_threads);
}

TEST(EngineOptions, TapaDefaultsAgree) {
  EXPECT_EQ(TapaBytes(PatchMatchOptions()), TapaBytes(TapaOptions()));
}

void Change(bool* value) { *value = !*value; }
void Change(int* value) { *value += 3; }
void Change(double* value) { *value += 0.25; }
[[maybe_unused]] void Change(std::string* value) { *value += "x"; }

TEST(EngineOptions, EveryTapaOptionIsPassedOn) {
  std::vector<std::string> names;
  PatchMatchOptions().Visit(
      [&](const std::string& name, auto*, const std::string&) {
        if (name.compare(0, 4, "tapa") == 0 && name != "tapa_debug") {
          names.push_back(name);
        }
      });
  EXPECT_GE(names.size(), 5);
  std::set<std::string> results = {TapaBytes(PatchMatchOptions())};
  for (const std::string& changed : names) {
    PatchMatchOptions options;
    options.Visit(
        [&](const std::string& name, auto* value, const std::string&) {
          if (name == changed) {
            Change(value);
          }
        });
    EXPECT_TRUE(results.insert(TapaBytes(options)).second)
        << changed << " changes nothing, or what another option changes";
  }
}

TEST(EngineOptions, FirstPassNeitherFiltersNorRefinesNorChecksGeometry) {
  PatchMatchOptions given;
  given.tapa = true;
  const Options options = EngineOptions(PassOptions(given, Pass::kPhotometric));
  EXPECT_FALSE(options.geom_consistency);
  EXPECT_FALSE(options.filter);
  EXPECT_TRUE(options.tapa.enabled);
  EXPECT_TRUE(options.tapa.fine_superpixels);
  EXPECT_FALSE(options.tapa.refinement);
}

TEST(PassOptions, EachPassHasItsIterations) {
  const auto iterations = [](const PatchMatchOptions& options, Pass pass) {
    return EngineOptions(PassOptions(options, pass)).num_iterations;
  };
  PatchMatchOptions options;
  options.num_iterations = 7;
  options.num_geom_iterations = 4;
  EXPECT_EQ(iterations(options, Pass::kPhotometric), 7);
  EXPECT_EQ(iterations(options, Pass::kGeometric), 4);
  options.num_geom_iterations = -1;
  EXPECT_EQ(iterations(options, Pass::kGeometric), 7);
  options.num_geom_iterations = 0;
  EXPECT_NE(ErrorOf(options).find("num_geom_iterations is 0"),
            std::string::npos);
}

TEST(PassOptions, ColmapDefaultsTakeTheirPlace) {
  PatchMatchOptions options;
  options.colmap_defaults = true;
  for (const Pass pass : {Pass::kPhotometric, Pass::kGeometric}) {
    const Options result = EngineOptions(PassOptions(options, pass));
    EXPECT_EQ(result.num_iterations, 5);
    EXPECT_EQ(result.num_samples, 15);
    EXPECT_EQ(result.window_step, 1);
  }
}

TEST(CheckOptions, NamesTheOption) {
  PatchMatchOptions options;
  options.window_radius = 33;
  EXPECT_NE(ErrorOf(options).find("PatchMatchStereo.window_radius is 33"),
            std::string::npos);
}

TEST(CheckOptions, ChecksWhatTheEngineDoesNotKnow) {
  PatchMatchOptions options;
  options.seed = -1;
  EXPECT_NE(ErrorOf(options), "");

  options = PatchMatchOptions();
  options.max_image_size = 0;
  EXPECT_NE(ErrorOf(options), "");

  for (const double size : {0.0, -1.0, std::numeric_limits<double>::infinity(),
                            std::numeric_limits<double>::quiet_NaN()}) {
    options = PatchMatchOptions();
    options.cache_size = size;
    EXPECT_NE(ErrorOf(options), "") << size;
  }
}

TEST(CheckOptions, DepthRange) {
  const auto error_of = [](double depth_min, double depth_max) {
    PatchMatchOptions options;
    options.depth_min = depth_min;
    options.depth_max = depth_max;
    return ErrorOf(options);
  };
  EXPECT_EQ(error_of(-1, -1), "");
  EXPECT_EQ(error_of(1, 1), "");
  EXPECT_EQ(error_of(0.5, 8), "");
  EXPECT_NE(error_of(2, 1), "");
  EXPECT_NE(error_of(0, 1), "");
  EXPECT_NE(error_of(-1, 1), "");
  EXPECT_NE(error_of(1, -1), "");
}

TEST(CheckOptions, GpuIndex) {
  const auto error_of = [](const std::string& list) {
    PatchMatchOptions options;
    options.gpu_index = list;
    return ErrorOf(options);
  };
  for (const char* list : {"-1", "0", "0,1", "3, 12"}) {
    EXPECT_EQ(error_of(list), "") << list;
  }
  for (const char* list :
       {"", "x", "0,", ",0", "-1,0", "-2", "0,,1", "1.5", "12345678901"}) {
    EXPECT_NE(error_of(list), "") << list;
  }
}

TEST(ViewSeed, DependsOnAllItIsGiven) {
  std::set<uint64_t> seeds;
  for (const uint64_t seed : {0, 1}) {
    for (const char* name : {"a.jpg", "b.jpg", "ab.jpg"}) {
      for (const bool geometric : {false, true}) {
        seeds.insert(ViewSeed(seed, name, geometric));
      }
    }
  }
  EXPECT_EQ(seeds.size(), 12);
  EXPECT_EQ(ViewSeed(1, "a.jpg", true), ViewSeed(1, "a.jpg", true));
}

TEST(HostOptions, VisitListsEveryOptionOnce) {
  PatchMatchOptions options;
  std::set<std::string> names;
  int num = 0;
  options.Visit(
      [&](const std::string& name, auto* option, const std::string& help) {
        names.insert(name);
        ++num;
        EXPECT_NE(option, nullptr);
        EXPECT_NE(help, "") << name;
      });
  EXPECT_EQ(static_cast<int>(names.size()), num);
  EXPECT_EQ(names.count("use_gpu"), 1);
  EXPECT_EQ(names.count("num_threads"), 1);
  EXPECT_EQ(names.count("seed"), 1);
}

}  // namespace
}  // namespace tapa
