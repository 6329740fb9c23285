#include "src/colmap/engine_options.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <sstream>
#include <string>

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

// What the engine gets, as text.
std::string Text(const Options& options) {
  std::ostringstream text;
  const auto add = [&text](const OptionEntry& entry, const auto* value) {
    text << entry.name << " " << *value << "\n";
  };
  VisitSharedOptions(add, &options);
  VisitTapaOptions(&options.tapa, add);
  VisitSearchOptions(&options.search, add);
  text << options.first_perturbation << " " << options.num_threads;
  return text.str();
}

void Change(bool* value) { *value = !*value; }
void Change(int* value) { *value += 3; }
void Change(double* value) { *value += 0.25; }

TEST(EngineOptions, EveryOptionIsPassedOn) {
  std::set<std::string> results = {Text(EngineOptions(PatchMatchOptions()))};
  const auto expect_difference = [&](const std::string& name,
                                     const PatchMatchOptions& changed) {
    EXPECT_TRUE(results.insert(Text(EngineOptions(changed))).second) << name;
  };
  PatchMatchOptions options;
  const auto change = [&](const OptionEntry& entry, auto* value) {
    Change(value);
    expect_difference(entry.name, options);
  };
  VisitSharedOptions(change, &options);
  VisitTapaOptions(&options.tapa, change);
  VisitSearchOptions(&options.search, change);
  change(OptionEntry{"first_perturbation", ""}, &options.first_perturbation);
  change(OptionEntry{"num_threads", ""}, &options.num_threads);
}

TEST(EngineOptions, FirstPassNeitherFiltersNorRefinesNorChecksGeometry) {
  PatchMatchOptions given;
  given.tapa.enabled = true;
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
  // One number for both, as in COLMAP, is an upper bound.
  options.num_iterations = 1;
  EXPECT_EQ(iterations(options, Pass::kGeometric), 1);
  options.num_geom_iterations = 0;
  EXPECT_NE(ErrorOf(options).find("num_geom_iterations is 0"),
            std::string::npos);
}

TEST(PassOptions, LaterLevelsDoLessAndChangeLess) {
  PatchMatchOptions options;
  options.num_iterations = 7;
  options.num_fine_iterations = 3;
  options.num_geom_iterations = 2;
  options.fine_perturbation = 0.1;
  options.geom_perturbation = 0.2;
  const auto expect = [&](Pass pass, int level, int iterations,
                          double perturbation, bool filters) {
    const PatchMatchOptions result = PassOptions(options, pass, level, 3);
    EXPECT_EQ(result.num_iterations, iterations) << level;
    EXPECT_EQ(result.first_perturbation, perturbation) << level;
    EXPECT_EQ(result.filter, filters) << level;
    EXPECT_EQ(result.num_levels, 3);
    EXPECT_EQ(result.geom_consistency, pass != Pass::kPhotometric);
  };
  expect(Pass::kPhotometric, 2, 7, 1, false);
  expect(Pass::kGeometric, 2, 2, 0.2, false);
  for (const int level : {1, 0}) {
    expect(Pass::kPhotometric, level, 3, 0.1, false);
    expect(Pass::kGeometric, level, 2, 0.1, level == 0);
  }
  // What the geometric pass would make of full size without a consensus.
  expect(Pass::kDraft, 0, 2, 0.1, true);
  // Upper bounds.
  options.num_iterations = 1;
  options.first_perturbation = 0.05;
  expect(Pass::kPhotometric, 2, 1, 0.05, false);
  expect(Pass::kPhotometric, 1, 1, 0.05, false);
  expect(Pass::kGeometric, 2, 1, 0.05, false);
}

TEST(NumLevels, FollowsTheImagesUnlessItIsGiven) {
  PatchMatchOptions options;
  EXPECT_EQ(NumLevels(options, 540), 2);
  EXPECT_EQ(NumLevels(options, 6000), 5);
  options.num_levels = 3;
  EXPECT_EQ(NumLevels(options, 540), 3);
  options.colmap_defaults = true;
  EXPECT_EQ(NumLevels(options, 6000), 1);
}

TEST(PassOptions, ColmapDefaultsTakeTheirPlace) {
  PatchMatchOptions options;
  options.colmap_defaults = true;
  options.window_step = 2;
  for (const Pass pass : {Pass::kPhotometric, Pass::kGeometric}) {
    const Options result = EngineOptions(PassOptions(options, pass));
    EXPECT_EQ(result.num_iterations, 5);
    EXPECT_EQ(result.num_samples, 15);
    EXPECT_EQ(result.window_step, 1);
    EXPECT_EQ(result.sigma_color, 0.2);
    EXPECT_EQ(result.first_perturbation, 1);
    EXPECT_TRUE(result.search.try_all);
    EXPECT_TRUE(result.search.measure_all);
    EXPECT_EQ(result.search.hysteresis, 0);
    EXPECT_EQ(result.search.sigma_textured, -1);
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
  EXPECT_EQ(error_of(0, 1), "") << "no lower end";
  EXPECT_NE(error_of(0, 0), "");
  EXPECT_NE(error_of(0, HUGE_VAL), "");
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
      for (const Pass pass : {Pass::kPhotometric, Pass::kGeometric}) {
        for (const int level : {0, 1, 2}) {
          seeds.insert(ViewSeed(seed, name, pass, level));
        }
      }
    }
  }
  EXPECT_EQ(seeds.size(), 36);
  EXPECT_EQ(ViewSeed(1, "a.jpg", Pass::kGeometric),
            ViewSeed(1, "a.jpg", Pass::kGeometric));
  EXPECT_EQ(ViewSeed(1, "a.jpg", Pass::kDraft),
            ViewSeed(1, "a.jpg", Pass::kGeometric));
}

TEST(HasDrafts, IfAllOfItsPartsAreOn) {
  PatchMatchOptions options;
  EXPECT_FALSE(HasDrafts(options));
  options.tapa.enabled = true;
  options.geom_consistency = true;
  EXPECT_TRUE(HasDrafts(options));
  for (bool* part :
       {&options.tapa.refinement, &options.tapa.completion,
        &options.tapa.completion_consensus, &options.geom_consistency}) {
    *part = false;
    EXPECT_FALSE(HasDrafts(options));
    *part = true;
  }
}

TEST(HostOptions, TableListsEveryOptionOnce) {
  std::set<std::string> names;
  int num = 0;
  const HostOptions options;
  VisitHostOptions(&options, [&](const OptionEntry& entry, const auto* value) {
    names.insert(entry.name);
    ++num;
    EXPECT_NE(entry.help, "") << entry.name;
    // Every default is valid.
    CheckOption(entry, *value);
  });
  EXPECT_EQ(static_cast<int>(names.size()), num);
}

TEST(OptionEntry, RangesSayWhatTheyContain) {
  using Range = OptionRange;
  EXPECT_EQ(Range().Text(), "a number");
  EXPECT_EQ(Range::Positive().Text(), "positive");
  EXPECT_EQ(Range::AtLeast(-2).Text(), "at least -2");
  EXPECT_EQ(Range::AtLeast(2).WithoutMin().Text(), "above 2");
  EXPECT_EQ(Range::From(1, 32).Text(), "from 1 to 32");
  EXPECT_EQ(Range::From(0, 1).WithoutMin().Text(), "above 0 and at most 1");
  EXPECT_EQ(Range::From(0, 180).WithoutMax().Text(),
            "at least 0 and below 180");
  EXPECT_EQ(Range::From(1, 9).OrMinusOne("all").Text(),
            "-1 (all) or from 1 to 9");

  EXPECT_TRUE(Range::From(1, 32).Contains(1));
  EXPECT_TRUE(Range::From(1, 32).Contains(32));
  EXPECT_FALSE(Range::From(1, 32).Contains(0.5));
  EXPECT_FALSE(Range::From(1, 32).Contains(33));
  EXPECT_FALSE(Range::From(1, 32).Contains(-1));
  EXPECT_TRUE(Range::From(1, 32).OrMinusOne("all").Contains(-1));
  EXPECT_FALSE(Range::From(1, 32).OrMinusOne("all").Contains(-2));
  EXPECT_FALSE(Range::Positive().Contains(0));
  EXPECT_FALSE(Range::From(0, 180).WithoutMax().Contains(180));
  for (const double value : {NAN, INFINITY, -INFINITY}) {
    EXPECT_FALSE(Range().Contains(value));
  }

  const OptionEntry entry{"seed", "Key", Range::AtLeast(0)};
  EXPECT_EQ(entry.HelpWithRange(), "Key (at least 0)");
  EXPECT_EQ(OptionEntry({"a", "Help"}).HelpWithRange(), "Help");
}

}  // namespace
}  // namespace tapa
