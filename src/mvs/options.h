#ifndef TAPA_SRC_MVS_OPTIONS_H_
#define TAPA_SRC_MVS_OPTIONS_H_

#include <cstdint>
#include <tuple>

#include "src/mvs/option_entry.h"

// COLMAP's own sources include this header, through src/colmap/host_options.h.

namespace tapa {

// Parameters of TAPA: Romanoni and Matteucci, "TAPA-MVS: Textureless-Aware
// PAtchMatch Multi-View Stereo", ICCV 2019. The defaults are the paper's where
// it gives a value. What each is for, and its unit, stands in VisitTapaOptions.
struct TapaOptions {
  bool enabled = false;

  // Parts of the method: sections 4.2, 4.1, 4.1 and 5 of the paper.
  bool texture_weighting = true;
  bool fine_superpixels = true;
  bool coarse_superpixels = true;
  bool refinement = true;

  // Of the weights.
  double textureness_variance = 0.00005;
  double min_textureness = 0.1;
  double weight_range = 0.2;

  // Of planes fitted to superpixels.
  double fine_divisor = 20;
  double coarse_divisor = 30;
  double plane_distance = -1;
  double relative_plane_distance = 0.01;

  // Of refinement.
  double speckle_size = 0.0002;
  double speckle_continuity = 0.1;
  int fill_radius = 5;
  int fill_rounds = 1;

  // Part of refinement, beyond the paper (docs/tapa.md). Only estimates stay
  // that source views support, one view fewer than
  // Options::filter_min_num_consistent but at least one. Planes of superpixels,
  // fitted to those that reach that number, replace the others; then triangles
  // between estimates, silhouettes, and planes through what is around regions.
  // Last of all, views judge each other (tapa/consensus.h), which is a pass of
  // its own.
  bool completion = true;
  bool completion_sightings = true;
  bool completion_triangles = true;
  bool completion_silhouettes = true;
  bool completion_regions = true;
  bool completion_consensus = true;
  double completion_agreement = 0.5;
  double completion_radius = 0.1;
  double completion_textureness = 0.5;
  double completion_fill_share = 0.5;
};

// The table of these options: calls visit(entry, pointer to the member) for
// every one. Options: TapaOptions, or the same as const.
template <typename Options, typename Visitor>
void VisitTapaOptions(Options* options, const Visitor& visit) {
  using Range = OptionRange;
  auto& o = *options;
  const bool on = o.enabled;
  const bool planes = on && (o.fine_superpixels || o.coarse_superpixels);
  const bool refines = on && o.refinement;
  const bool completes = refines && o.completion;
  const auto option = [&visit](const char* name, auto* member, bool is_used,
                               const char* help, const Range& range = {}) {
    visit(OptionEntry{name, help, range, is_used}, member);
  };

  option("tapa", &o.enabled, true,
         "Complete surfaces without texture (TAPA-MVS); the options tapa_* do "
         "nothing without it");
  option("tapa_texture_weighting", &o.texture_weighting, on,
         "Weigh costs by textureness");
  option("tapa_fine_superpixels", &o.fine_superpixels, on,
         "Propose planes fitted to fine superpixels");
  option("tapa_coarse_superpixels", &o.coarse_superpixels, on,
         "Propose planes fitted to coarse superpixels");
  option("tapa_refinement", &o.refinement, on,
         "Remove speckles and fill gaps, in place of the filter");

  option("tapa_textureness_variance", &o.textureness_variance, on,
         "Variance of intensities (0 to 1) that counts as little texture",
         Range::Positive());
  option("tapa_min_textureness", &o.min_textureness, on,
         "Textureness t of a flat patch; where it is below 0.5 the weights "
         "favour planes, while with the paper's 0.5 they never do",
         Range::From(0, 1).WithoutMin());
  option("tapa_weight_range", &o.weight_range, on && o.texture_weighting,
         "By how much textureness t changes the weights: they are 1 - range "
         "(1 - t) and 1 - range t",
         Range::From(0, 1));

  option("tapa_fine_divisor", &o.fine_divisor, on && o.fine_superpixels,
         "Number of fine superpixels: image width / this", Range::Positive());
  option("tapa_coarse_divisor", &o.coarse_divisor, on && o.coarse_superpixels,
         "Number of coarse superpixels: image width / this", Range::Positive());
  option("tapa_plane_distance", &o.plane_distance, planes,
         "Largest distance of a point from its superpixel's plane, in scene "
         "units; if <= 0, tapa_relative_plane_distance decides");
  option("tapa_relative_plane_distance", &o.relative_plane_distance,
         planes || completes,
         "The same as a share of the superpixel's median depth; completion "
         "takes it for what lies on a triangle or an estimate, too",
         Range::Positive());

  option("tapa_speckle_size", &o.speckle_size, on,
         "Connected regions of at most this share of the image are speckles",
         Range::From(0, 1));
  option("tapa_speckle_continuity", &o.speckle_continuity, on,
         "Neighbouring pixels are connected if their depths differ by at most "
         "this share of the scene's range of depths",
         Range::AtLeast(0));
  option("tapa_fill_radius", &o.fill_radius, refines,
         "Half size of the window that a missing pixel is filled from, in "
         "pixels",
         Range::From(0, 100));
  option("tapa_fill_rounds", &o.fill_rounds, refines,
         "How often the fill is repeated; it reaches tapa_fill_radius pixels "
         "each time",
         Range::From(0, 1000));

  option("tapa_completion", &o.completion, refines,
         "Believe only estimates that source views support, and complete the "
         "others with planes (beyond the paper)");
  option("tapa_completion_sightings", &o.completion_sightings, completes,
         "What other views see counts for and against planes where the view "
         "itself has no estimate to believe");
  option("tapa_completion_triangles", &o.completion_triangles, completes,
         "Triangles between textured estimates complete and replace what lies "
         "between where more views speak for them");
  option("tapa_completion_silhouettes", &o.completion_silhouettes, completes,
         "Estimates beside texture give way to what pixels of their colour "
         "around agree on, so that surfaces do not grow over those behind "
         "them");
  option("tapa_completion_regions", &o.completion_regions, completes,
         "Regions of one colour take the plane through the textured estimates "
         "around them");
  option("tapa_completion_consensus", &o.completion_consensus, completes,
         "When all views are complete, what more of them speak against than "
         "for goes, or gives way to what they see instead");
  option("tapa_completion_agreement", &o.completion_agreement, completes,
         "Share of the estimates nearby that have to lie on a plane",
         Range::From(0, 1));
  option("tapa_completion_radius", &o.completion_radius, completes,
         "What is nearby: half size of a square, as a share of the image's "
         "width",
         Range::From(0, 1));
  option("tapa_completion_textureness", &o.completion_textureness, completes,
         "Below this textureness planes replace estimates of little support, "
         "too, and triangles any",
         Range::From(0, 2));
  option("tapa_completion_fill_share", &o.completion_fill_share, completes,
         "Share of a window's pixels that have to speak for the fill of a "
         "missing one; without completion any will do",
         Range::From(0, 1));
}

// How much is tried before an estimate is kept, and how it is measured, where
// COLMAP has no choice. What each is for stands in VisitSearchOptions. COLMAP's
// own: true, any, true, 0 and -1.
struct SearchOptions {
  bool try_all = false;
  double random_share = 0.5;
  bool measure_all = false;
  double hysteresis = 0.12;
  double sigma_textured = 2;
};

// The table of these options, as VisitTapaOptions.
template <typename Options, typename Visitor>
void VisitSearchOptions(Options* options, const Visitor& visit) {
  visit(OptionEntry{"try_all",
                    "Try in every sweep all three random changes (of depth and "
                    "normal, of the normal, of the depth), not one that is "
                    "drawn, and the plane of the pixel before even where it is "
                    "the pixel's own"},
        &options->try_all);
  visit(OptionEntry{"random_share",
                    "Share of the sweeps in which a pixel tries a random "
                    "change, where it starts from a coarser level or another "
                    "pass; with try_all it tries all three in all sweeps",
                    OptionRange::From(0, 1)},
        &options->random_share);
  visit(OptionEntry{"measure_all",
                    "Measure what a sweep chooses in all source views; "
                    "otherwise those that were not drawn keep what they saw "
                    "when they last were, but where a view starts at random"},
        &options->measure_all);
  visit(OptionEntry{"hysteresis",
                    "By how much (of 1 - NCC) another hypothesis must be "
                    "better than an estimate from a coarser level or another "
                    "pass where there is no texture; the more there is, the "
                    "less",
                    OptionRange::From(0, 2)},
        &options->hysteresis);
  visit(OptionEntry{"sigma_textured",
                    "Spread of the window's weights over distance in pixels "
                    "where there is texture, which end at twice that, so that "
                    "the window is no larger than what it needs to see; the "
                    "less there is, the more it is sigma_spatial",
                    OptionRange::AtLeast(0.5).OrMinusOne(
                        "sigma_spatial everywhere")},
        &options->sigma_textured);
}

// Parameters of one depth map estimation. The defaults are COLMAP's
// (Schoenberger et al., "Pixelwise View Selection for Unstructured Multi-View
// Stereo", ECCV 2016), but for fewer samples (15 there, in every row
// and column of the window), iterations (5) and random changes (SearchOptions),
// and weights that fall off faster with colour (sigma_color 0.2) and, where
// there is texture, with distance (SearchOptions::sigma_textured), so that
// surfaces do not grow over those behind them.
// Angles are in degrees.
struct Options {
  // Half size of the correlation window, in pixels: the window has
  // 2 * window_radius + 1 rows and columns.
  int window_radius = 5;
  // Distance between the samples in the window, in pixels: 1 or 2.
  int window_step = 2;
  // Spread of the bilateral weights over distance in pixels; if <= 0, it is
  // window_radius.
  double sigma_spatial = -1;
  // Spread of the bilateral weights over difference in intensity (0 to 1).
  double sigma_color = 0.1;

  // Number of source views drawn with replacement per pixel and sweep.
  int num_samples = 3;
  // Spread of the likelihood of a view's cost (1 - NCC).
  double ncc_sigma = 0.6;
  // Triangulation angle below which a view's prior falls off, in degrees.
  double min_triangulation_angle = 1;
  // Spread of the prior on the cosine of the incident angle.
  double incident_angle_sigma = 0.9;

  // Number of iterations of four sweeps each.
  int num_iterations = 4;
  // Relative size of the random changes in the first sweep, at most 1. They
  // shrink by half in every iteration.
  double first_perturbation = 1;
  SearchOptions search;

  // Geometric pass: start from the given maps and add the geometric term.
  bool geom_consistency = true;
  // Weight of the geometric term against the photometric one.
  double geom_consistency_regularizer = 0.3;
  // Largest geometric cost: forward-backward reprojection error, in pixels.
  double geom_consistency_max_cost = 3;

  // Whether the last sweep removes estimates that too few views support.
  bool filter = true;
  // A view supports an estimate if its selection probability reaches the
  // likelihood of this correlation (-1 to 1), ...
  double filter_min_ncc = 0.1;
  // ... its triangulation angle reaches this, in degrees, ...
  double filter_min_triangulation_angle = 3;
  // ... and, in the geometric pass, its reprojection error does not exceed
  // this, in pixels.
  double filter_geom_consistency_max_cost = 1;
  // Number of views that have to support an estimate; at most the number of
  // source views is asked for.
  int filter_min_num_consistent = 2;

  TapaOptions tapa;

  // Number of the GPU that computes, as in devices.h; -1: the CPU does.
  int device = -1;
  // Number of threads of the CPU backend; -1: one per core.
  int num_threads = -1;
  // Key of all random draws. The same seed gives the same maps.
  uint64_t seed = 0;

  // Throws std::invalid_argument that names the option and its valid range.
  void Check() const;
};

inline OptionRange NumThreadsRange() {
  return OptionRange::From(1, 1024).OrMinusOne("one per core");
}

// The table of the options that COLMAP has, too, under the same names: calls
// visit(entry, pointer to the member in each of the options) for every one.
// options: any number of Options and of COLMAP's; the first says which are in
// use.
template <typename Visitor, typename... AnyOptions>
void VisitSharedOptions(const Visitor& visit, AnyOptions*... o) {
  using Range = OptionRange;
  const auto& first = *std::get<0>(std::tie(o...));
  const bool geometric = first.geom_consistency;
  // TAPA's refinement stands in for the filter.
  const bool filters =
      first.tapa.enabled ? first.tapa.refinement : first.filter;
  const auto option = [&visit](const char* name, const Range& range,
                               bool is_used, auto*... members) {
    visit(OptionEntry{name, "", range, is_used}, members...);
  };

  option("window_radius", Range::From(1, 32), true, &o->window_radius...);
  option("window_step", Range::From(1, 2), true, &o->window_step...);
  option("sigma_spatial", {}, true, &o->sigma_spatial...);
  option("sigma_color", Range::Positive(), true, &o->sigma_color...);
  option("num_samples", Range::From(1, 10000), true, &o->num_samples...);
  option("ncc_sigma", Range::Positive(), true, &o->ncc_sigma...);
  option("min_triangulation_angle", Range::From(0, 180).WithoutMax(), true,
         &o->min_triangulation_angle...);
  option("incident_angle_sigma", Range::Positive(), true,
         &o->incident_angle_sigma...);
  option("num_iterations", Range::From(1, 1000), true, &o->num_iterations...);
  // It makes the pass another one, with maps of its own.
  option("geom_consistency", {}, false, &o->geom_consistency...);
  option("geom_consistency_regularizer", Range::AtLeast(0), geometric,
         &o->geom_consistency_regularizer...);
  option("geom_consistency_max_cost", Range::AtLeast(0), geometric,
         &o->geom_consistency_max_cost...);
  option("filter", {}, !first.tapa.enabled, &o->filter...);
  option("filter_min_ncc", Range::From(-1, 1), filters, &o->filter_min_ncc...);
  option("filter_min_triangulation_angle", Range::From(0, 180), filters,
         &o->filter_min_triangulation_angle...);
  option("filter_min_num_consistent", Range::AtLeast(0), filters,
         &o->filter_min_num_consistent...);
  option("filter_geom_consistency_max_cost", Range::AtLeast(0),
         filters && geometric, &o->filter_geom_consistency_max_cost...);
}

}  // namespace tapa

#endif  // TAPA_SRC_MVS_OPTIONS_H_
