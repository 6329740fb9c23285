#ifndef TAPA_SRC_COLMAP_HOST_OPTIONS_H_
#define TAPA_SRC_COLMAP_HOST_OPTIONS_H_

#include <string>

// This header is included by COLMAP's own sources.

namespace tapa {

// The options of dense stereo that COLMAP itself does not have. COLMAP's
// PatchMatchOptions derive from them, and the command line, project files, the
// options widget and the record beside the maps (options_record.h) list them
// through Visit: a new option is a member here, a line there, and a line where
// it is passed on (engine_options.cc).
struct HostOptions {
  // Whether to compute on a GPU, if this program can and there is one.
  bool use_gpu = true;

  // Number of threads on the CPU; -1: one per core.
  int num_threads = -1;

  // Key of all random draws, from 0. The same seed gives the same maps on
  // processors with the same SIMD instructions.
  int seed = 0;

  // Iterations of the geometric pass, which starts from the result of the
  // photometric one; -1: num_iterations, as that has.
  int num_geom_iterations = -1;
  // Whether to take COLMAP's own numbers of iterations and of samples, which
  // cost two and a half times as much (docs/results.md), in place of those
  // given.
  bool colmap_defaults = false;

  // Whether to complete surfaces without texture by TAPA-MVS (Romanoni and
  // Matteucci, ICCV 2019). The options below do nothing without it; they are
  // those of TapaOptions (src/mvs/options.h), with the same defaults.
  bool tapa = false;

  // Whether to weigh costs by textureness.
  bool tapa_texture_weighting = true;
  // Whether to propose planes fitted to superpixels, fine and coarse ones.
  bool tapa_fine_superpixels = true;
  bool tapa_coarse_superpixels = true;
  // Whether to remove speckles and fill gaps, in the last pass.
  bool tapa_refinement = true;

  // Variance of intensities (0 to 1) that counts as little texture.
  double tapa_textureness_variance = 0.00005;
  // Textureness of a flat patch, above 0 and at most 1. The paper's is 0.5.
  double tapa_min_textureness = 0.1;
  // By how much textureness changes the weights, 0 to 1.
  double tapa_weight_range = 0.2;

  // Number of fine superpixels: image width / this.
  double tapa_fine_divisor = 20;
  // Number of coarse superpixels: image width / this.
  double tapa_coarse_divisor = 30;
  // Largest distance of a point from its superpixel's plane, in scene units;
  // not positive: tapa_relative_plane_distance decides.
  double tapa_plane_distance = -1;
  // The same as a share of the superpixel's median depth.
  double tapa_relative_plane_distance = 0.01;

  // Connected regions of at most this share of the image are speckles.
  double tapa_speckle_size = 0.0002;
  // Neighbouring pixels are connected if their depths differ by at most this
  // share of the scene's range of depths.
  double tapa_speckle_continuity = 0.1;
  // Half size of the window that a missing pixel is filled from, in pixels.
  int tapa_fill_radius = 5;
  // How often the fill is repeated.
  int tapa_fill_rounds = 1;

  // Whether to believe only estimates that source views support, and to
  // complete the others with planes: part of the refinement.
  bool tapa_completion = true;
  // Share of the estimates nearby that have to lie on a plane, 0 to 1.
  double tapa_completion_agreement = 0.5;
  // What is nearby: half size of a square, as a share of the image's width.
  double tapa_completion_radius = 0.1;
  // Below this textureness planes replace estimates of little support, too.
  double tapa_completion_textureness = 0.5;
  // Share of a window's pixels that have to speak for a fill, 0 to 1.
  double tapa_completion_fill_share = 0.5;

  // Folder for pictures of what TAPA did with every view that the last pass
  // computes; empty: none. Maps do not depend on it.
  std::string tapa_debug;

  // Calls visit(name, pointer to the member, help) for every option. Members
  // are bool, int, double or std::string.
  template <typename Visitor>
  void Visit(const Visitor& visit) {
    VisitMembers(this, visit);
  }
  template <typename Visitor>
  void Visit(const Visitor& visit) const {
    VisitMembers(this, visit);
  }

 private:
  template <typename Options, typename Visitor>
  static void VisitMembers(Options* options, const Visitor& visit) {
    using S = std::string;
    visit(S("use_gpu"), &options->use_gpu,
          S("Compute on a GPU, if this program can and there is one"));
    visit(S("num_threads"), &options->num_threads,
          S("Threads on the CPU, -1: one per core"));
    visit(S("seed"), &options->seed,
          S("Key of all random draws: the same seed gives the same maps"));
    visit(S("num_geom_iterations"), &options->num_geom_iterations,
          S("Iterations of the geometric pass, -1: num_iterations"));
    visit(S("colmap_defaults"), &options->colmap_defaults,
          S("Take COLMAP's own num_iterations (5 in both passes) and "
            "num_samples (15), whatever is given here"));
    visit(S("tapa"), &options->tapa,
          S("Complete surfaces without texture (TAPA-MVS); the options tapa_* "
            "do nothing without it"));
    visit(S("tapa_texture_weighting"), &options->tapa_texture_weighting,
          S("Weigh costs by textureness"));
    visit(S("tapa_fine_superpixels"), &options->tapa_fine_superpixels,
          S("Propose planes fitted to fine superpixels"));
    visit(S("tapa_coarse_superpixels"), &options->tapa_coarse_superpixels,
          S("Propose planes fitted to coarse superpixels"));
    visit(S("tapa_refinement"), &options->tapa_refinement,
          S("Remove speckles and fill gaps, in place of the filter"));
    visit(S("tapa_textureness_variance"), &options->tapa_textureness_variance,
          S("Variance of intensities (0 to 1) that counts as little texture"));
    visit(S("tapa_min_textureness"), &options->tapa_min_textureness,
          S("Textureness of a flat patch, above 0 and at most 1; the paper's "
            "is 0.5"));
    visit(S("tapa_weight_range"), &options->tapa_weight_range,
          S("By how much textureness changes the weights, 0 to 1"));
    visit(S("tapa_fine_divisor"), &options->tapa_fine_divisor,
          S("Number of fine superpixels: image width / this"));
    visit(S("tapa_coarse_divisor"), &options->tapa_coarse_divisor,
          S("Number of coarse superpixels: image width / this"));
    visit(S("tapa_plane_distance"), &options->tapa_plane_distance,
          S("Largest distance of a point from its superpixel's plane, in scene "
            "units; not positive: tapa_relative_plane_distance decides"));
    visit(S("tapa_relative_plane_distance"),
          &options->tapa_relative_plane_distance,
          S("The same as a share of the superpixel's median depth"));
    visit(S("tapa_speckle_size"), &options->tapa_speckle_size,
          S("Connected regions of at most this share of the image are "
            "speckles"));
    visit(S("tapa_speckle_continuity"), &options->tapa_speckle_continuity,
          S("Neighbouring pixels are connected if their depths differ by at "
            "most this share of the scene's range of depths"));
    visit(S("tapa_fill_radius"), &options->tapa_fill_radius,
          S("Half size of the window that a missing pixel is filled from, in "
            "pixels"));
    visit(S("tapa_fill_rounds"), &options->tapa_fill_rounds,
          S("How often the fill is repeated"));
    visit(S("tapa_completion"), &options->tapa_completion,
          S("Believe only estimates that source views support, and complete "
            "the others with planes (beyond the paper)"));
    visit(S("tapa_completion_agreement"), &options->tapa_completion_agreement,
          S("Share of the estimates nearby that have to lie on a plane, 0 to "
            "1"));
    visit(S("tapa_completion_radius"), &options->tapa_completion_radius,
          S("What is nearby: half size of a square, as a share of the image's "
            "width"));
    visit(
        S("tapa_completion_textureness"), &options->tapa_completion_textureness,
        S("Below this textureness planes replace estimates of little support"));
    visit(S("tapa_completion_fill_share"), &options->tapa_completion_fill_share,
          S("Share of a window's pixels that have to speak for a fill, 0 to "
            "1"));
    visit(S("tapa_debug"), &options->tapa_debug,
          S("Folder for pictures of every step of TAPA for every view that is "
            "computed; empty: none"));
  }
};

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_HOST_OPTIONS_H_
