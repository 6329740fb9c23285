#ifndef TAPA_SRC_COLMAP_HOST_OPTIONS_H_
#define TAPA_SRC_COLMAP_HOST_OPTIONS_H_

#include <string>

#include "src/mvs/options.h"

// This header is included by COLMAP's own sources.

namespace tapa {

// The options of dense stereo that COLMAP itself does not have. COLMAP's
// PatchMatchOptions derive from them. What each is for stands in
// VisitHostOptions.
struct HostOptions {
  bool use_gpu = true;
  int num_threads = -1;
  int seed = 0;
  int num_levels = -1;
  int num_fine_iterations = 1;
  int num_geom_iterations = 2;
  double first_perturbation = 1;
  double fine_perturbation = 0.0078125;
  double geom_perturbation = 0.125;
  SearchOptions search;
  bool colmap_defaults = false;
  std::string mask_path;
  std::string prior_path;
  TapaOptions tapa;
  std::string tapa_debug;
  int step = -1;
  std::string share = "1/1";
};

// The table of these options: calls visit(entry, pointer to the member) for
// every one, bool, int, double or std::string. The command line, project files,
// the options widget, the checks and the record beside the maps
// (options_record.h) follow from it, so that a new option is a member and an
// entry. Options: HostOptions, or the same as const.
template <typename Options, typename Visitor>
void VisitHostOptions(Options* options, const Visitor& visit) {
  auto& o = *options;
  const auto option = [&visit](const char* name, auto* member,
                               bool changes_maps, const char* help,
                               const OptionRange& range = {}) {
    visit(OptionEntry{name, help, range, changes_maps}, member);
  };

  option("use_gpu", &o.use_gpu, false,
         "Compute on a GPU, if this program can and there is one");
  option("num_threads", &o.num_threads, false, "Threads on the CPU",
         NumThreadsRange());
  option("seed", &o.seed, true,
         "Key of all random draws: the same seed gives the same maps, on "
         "processors with the same SIMD instructions",
         OptionRange::AtLeast(0));
  option("num_levels", &o.num_levels, true,
         "Image sizes, each half of the one before, that stereo goes through "
         "from coarse to fine; 1: only the full one",
         OptionRange::From(1, 16).OrMinusOne("by the size of the images"));
  // What counts is the pass's num_iterations and first_perturbation.
  option("num_fine_iterations", &o.num_fine_iterations, false,
         "Iterations of the photometric pass at all levels but the coarsest; "
         "at most num_iterations",
         OptionRange::From(1, 1000));
  option("num_geom_iterations", &o.num_geom_iterations, false,
         "Iterations of the geometric pass, which starts from the result of "
         "the photometric one; at most num_iterations",
         OptionRange::From(1, 1000));
  option("first_perturbation", &o.first_perturbation, true,
         "Relative size of the first random changes where a view starts at "
         "random; they shrink by half in every iteration",
         OptionRange::From(0, 1).WithoutMin());
  option("fine_perturbation", &o.fine_perturbation, false,
         "The same at all levels but the coarsest; at most "
         "first_perturbation",
         OptionRange::From(0, 1).WithoutMin());
  option("geom_perturbation", &o.geom_perturbation, false,
         "The same in the geometric pass of the coarsest level; at most "
         "first_perturbation",
         OptionRange::From(0, 1).WithoutMin());
  VisitSearchOptions(&o.search, visit);
  option("colmap_defaults", &o.colmap_defaults, false,
         "Take COLMAP's own numbers, whatever is given here: one level, "
         "num_iterations 5 in both passes, num_samples 15, window_step 1, "
         "sigma_color 0.2, all random changes and of full size; they cost "
         "several times as much "
         "(docs/results.md)");
  // What counts is what is in them, see views_record.h.
  option("mask_path", &o.mask_path, false,
         "Folder of masks of the workspace's photographs, with the names of "
         "these and .png after them: where they are black, nothing is "
         "computed; empty: none");
  option("prior_path", &o.prior_path, false,
         "Folder of depth maps from elsewhere (EXR, PFM, 16-bit PNG, NPY; of "
         "any size and unit), with the names of the photographs: they are "
         "fitted to the sparse points and tried as hypotheses; empty: none");
  VisitTapaOptions(&o.tapa, visit);
  option("tapa_debug", &o.tapa_debug, false,
         "Folder for pictures of every step of TAPA for every view that the "
         "last pass computes; empty: none");
  option("step", &o.step, false,
         "On several machines (docs/usage.md): 0 prepares the run and says "
         "which steps it has, a number from 1 on computes the views of one "
         "step",
         OptionRange::AtLeast(0).OrMinusOne("all, by one program"));
  option("share", &o.share, false,
         "Which views of a step to compute, as in 2/10: the second of ten "
         "shares");
}

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_HOST_OPTIONS_H_
