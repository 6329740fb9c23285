#include "src/colmap/options_record.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <fstream>

#include "src/base/failure.h"
#include "src/colmap/engine_options.h"
#include "tests/colmap/test_folder.h"

namespace tapa {
namespace {

using colmap::mvs::PatchMatchOptions;

std::string DifferenceOf(const PatchMatchOptions& was,
                         const PatchMatchOptions& is) {
  return DescribeDifferences(OptionsOfMaps(was), OptionsOfMaps(is));
}

TEST(OptionsOfMaps, LeavesOutWhatDoesNotChangeMaps) {
  PatchMatchOptions options;
  options.use_gpu = !options.use_gpu;
  options.gpu_index = "3";
  options.num_threads = 7;
  options.cache_size = 1;
  options.allow_missing_files = true;
  options.write_consistency_graph = true;
  EXPECT_EQ(DifferenceOf(PatchMatchOptions(), options), "");
}

TEST(OptionsOfMaps, HasWhatChangesMaps) {
  const OptionValues values = OptionsOfMaps(PatchMatchOptions());
  for (const char* name : {"max_image_size",
                           "depth_min",
                           "depth_max",
                           "window_radius",
                           "window_step",
                           "sigma_spatial",
                           "sigma_color",
                           "num_samples",
                           "ncc_sigma",
                           "min_triangulation_angle",
                           "incident_angle_sigma",
                           "num_iterations",
                           "geom_consistency_regularizer",
                           "geom_consistency_max_cost",
                           "filter",
                           "filter_min_ncc",
                           "filter_min_triangulation_angle",
                           "filter_min_num_consistent",
                           "filter_geom_consistency_max_cost",
                           "seed",
                           "num_levels",
                           "first_perturbation",
                           "try_all",
                           "random_share",
                           "measure_all",
                           "hysteresis",
                           "sigma_textured",
                           "tapa",
                           "rays"}) {
    EXPECT_EQ(values.count(name), 1) << name;
  }
  EXPECT_EQ(values.size(), 29) << "Is an option missing in the list above?";
}

TEST(OptionsOfMaps, LeavesOutWhatNothingReads) {
  PatchMatchOptions options;
  options.geom_consistency = false;
  OptionValues values = OptionsOfMaps(options);
  EXPECT_EQ(values.count("geom_consistency_regularizer"), 0);
  EXPECT_EQ(values.count("filter_geom_consistency_max_cost"), 0);
  EXPECT_EQ(values.count("filter_min_ncc"), 1);
  options.filter = false;
  values = OptionsOfMaps(options);
  EXPECT_EQ(values.count("filter"), 1);
  EXPECT_EQ(values.count("filter_min_ncc"), 0);

  options.tapa.enabled = true;
  values = OptionsOfMaps(options);
  EXPECT_EQ(values.count("filter"), 0) << "refinement stands in for it";
  for (const char* name :
       {"tapa_weight_range", "tapa_fine_divisor", "tapa_coarse_divisor",
        "tapa_plane_distance", "tapa_fill_radius", "tapa_speckle_size"}) {
    EXPECT_EQ(values.count(name), 1) << name;
  }
  options.tapa.fine_superpixels = false;
  options.tapa.coarse_superpixels = false;
  values = OptionsOfMaps(options);
  EXPECT_EQ(values.count("tapa_plane_distance"), 0);
  EXPECT_EQ(values.count("tapa_relative_plane_distance"), 1);
  options.tapa.coarse_superpixels = true;
  options.tapa.texture_weighting = false;
  options.tapa.refinement = false;
  values = OptionsOfMaps(options);
  EXPECT_EQ(values.at("tapa_fine_superpixels"), "0");
  EXPECT_EQ(values.count("tapa_weight_range"), 0);
  EXPECT_EQ(values.count("tapa_fine_divisor"), 0);
  EXPECT_EQ(values.count("tapa_plane_distance"), 1);
  EXPECT_EQ(values.count("tapa_fill_radius"), 0);
  options.tapa.coarse_superpixels = false;
  EXPECT_EQ(OptionsOfMaps(options).count("tapa_plane_distance"), 0);
}

TEST(OptionsOfMaps, NumbersReadBackExactly) {
  for (const double value : {0.1234567890123456, 1.0 / 3, 1e-300, 123456.75,
                             0.00005, 5e-324, 1.7976931348623157e308}) {
    PatchMatchOptions options;
    options.depth_max = value;
    const std::string text = OptionsOfMaps(options).at("depth_max");
    EXPECT_EQ(std::strtod(text.c_str(), nullptr), value);
  }
}

TEST(OptionsOfMaps, ADefaultInSinglePrecisionIsWhatItStandsFor) {
  PatchMatchOptions options;
  ASSERT_NE(options.ncc_sigma, 0.6) << "COLMAP's default is 0.6f";
  EXPECT_EQ(OptionsOfMaps(options).at("ncc_sigma"), "0.6");
  options.ncc_sigma = 0.6;
  EXPECT_EQ(DifferenceOf(PatchMatchOptions(), options), "");
  options.ncc_sigma = 0.6000001;
  EXPECT_EQ(DifferenceOf(PatchMatchOptions(), options),
            "ncc_sigma was 0.6, is 0.6000001");
}

TEST(DescribeDifferences, APassBeforeTheGeometricOneIsNotAFinalOne) {
  PatchMatchOptions alone;
  alone.geom_consistency = false;
  PatchMatchOptions options;
  const auto difference = [&] {
    return DifferenceOf(PassOptions(alone, Pass::kPhotometric),
                        PassOptions(options, Pass::kPhotometric));
  };
  EXPECT_EQ(difference(), "filter was 1, is 0");
  alone.filter = false;
  EXPECT_EQ(difference(), "");
  options.tapa.enabled = alone.tapa.enabled = true;
  EXPECT_EQ(difference(), "tapa_refinement was 1, is 0");
}

TEST(DescribeDifferences, NamesTheSwitchRatherThanWhatFollows) {
  PatchMatchOptions options;
  options.tapa.enabled = true;
  EXPECT_EQ(DifferenceOf(PatchMatchOptions(), options), "tapa was 0, is 1");
}

TEST(DescribeDifferences, NamesOptionsThatOnlyOneSideHas) {
  EXPECT_EQ(DescribeDifferences({{"a", "1"}}, {{"a", "1"}, {"b", "2"}}),
            "b was not set, is 2");
  EXPECT_EQ(DescribeDifferences({{"a", "1"}, {"b", "2"}}, {{"a", "1"}}),
            "b was 2, is not set");
}

TEST(DescribeDifferences, CutsOffLongLists) {
  OptionValues was;
  OptionValues is;
  for (char name = 'a'; name < 'k'; ++name) {
    was[std::string(1, name)] = "1";
    is[std::string(1, name)] = "2";
  }
  EXPECT_EQ(DescribeDifferences(was, is),
            "a was 1, is 2; b was 1, is 2; c was 1, is 2; d was 1, is 2; "
            "e was 1, is 2; f was 1, is 2; and 4 more");
}

TEST(OptionsRecord, ReadsWhatItWrites) {
  const TestFolder folder;
  const std::string path = folder.Path("options.txt");
  EXPECT_FALSE(ReadOptionsRecord(path));
  PatchMatchOptions options;
  options.tapa.enabled = true;
  const OptionValues values = OptionsOfMaps(options);
  WriteOptionsRecord(path, OptionsOfMaps(PatchMatchOptions()));
  WriteOptionsRecord(path, values);
  const auto read = ReadOptionsRecord(path);
  ASSERT_TRUE(read);
  EXPECT_EQ(*read, values);
  EXPECT_EQ(folder.NumFiles(), 1);
  EXPECT_THROW(WriteOptionsRecord(folder.Path("missing/options.txt"), values),
               Failure);
}

TEST(OptionsRecord, RefusesDamagedFiles) {
  const TestFolder folder;
  const std::string path = folder.Path("options.txt");
  for (const char* text :
       {"", "# only a comment\n", "no value\n", "= 1\n", "a = 1\na = 2\n",
        "a = 1\nb = 2", "a = 1\nseed", " = 1\n"}) {
    std::ofstream(path, std::ios::trunc) << text;
    EXPECT_THROW(ReadOptionsRecord(path), Failure) << text;
  }
  EXPECT_THROW(ReadOptionsRecord(folder.Path("")), Failure) << "a folder";
}

TEST(OptionsRecord, RemovesWhatADeadProcessHasLeft) {
  const TestFolder folder;
  char host[256] = "";
  gethostname(host, sizeof(host) - 1);
  std::ofstream(
      folder.Path(std::string("options.txt.part-") + host + "-99999999-0"))
      << "x";
  WriteOptionsRecord(folder.Path("options.txt"), {{"a", "1"}});
  EXPECT_EQ(folder.NumFiles(), 1);
}

}  // namespace
}  // namespace tapa
