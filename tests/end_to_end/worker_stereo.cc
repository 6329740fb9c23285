// Dense stereo of a workspace by given workers.
//
//   worker_stereo WORKSPACE DEVICE...
//
// DEVICE: as in StereoRun. The options are those of a quick test.

#include <cstdlib>
#include <exception>
#include <iostream>
#include <vector>

#include "mvs/patch_match.h"
#include "src/colmap/stereo_plan.h"
#include "src/colmap/stereo_run.h"

int main(int argc, char** argv) {
  if (argc < 3) {
    std::cerr << "usage: worker_stereo WORKSPACE DEVICE..." << std::endl;
    return 2;
  }
  colmap::mvs::PatchMatchOptions options;
  options.num_iterations = 1;
  options.window_radius = 3;
  options.num_threads = 1;
  options.tapa.enabled = true;
  options.write_consistency_graph = true;
  tapa::WorkspaceLocation location;
  location.path = argv[1];
  location.format = "COLMAP";
  location.pmvs_option_name = "option-all";
  std::vector<int> workers;
  for (int i = 2; i < argc; ++i) {
    workers.push_back(std::atoi(argv[i]));
  }
  try {
    tapa::StereoRun run(tapa::MakeStereoPlan(options, location), workers,
                        [] { return false; });
    return run.Run() && run.NumDone() == run.NumViews() ? EXIT_SUCCESS
                                                        : EXIT_FAILURE;
  } catch (const std::exception& error) {
    std::cerr << "ERROR: " << error.what() << std::endl;
    return EXIT_FAILURE;
  }
}
