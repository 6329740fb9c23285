#ifndef TAPA_SRC_COLMAP_HOST_OPTIONS_H_
#define TAPA_SRC_COLMAP_HOST_OPTIONS_H_

#include <string>

// This header is included by COLMAP's own sources.

namespace tapa {

// The options of dense stereo that COLMAP itself does not have. COLMAP's
// PatchMatchOptions derive from them, and the command line, project files and
// the options widget list them through Visit: a new option is a member here, a
// line there, and a line where it is passed on (engine_options.cc).
struct HostOptions {
  // Whether to compute on a GPU, if this program can and there is one.
  bool use_gpu = true;

  // Number of threads on the CPU; -1: one per core.
  int num_threads = -1;

  // Key of all random draws, from 0. The same seed gives the same maps on
  // processors with the same SIMD instructions.
  int seed = 0;

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
  }
};

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_HOST_OPTIONS_H_
