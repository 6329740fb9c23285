// Dense stereo of a workspace on an emulated GPU, as patch_match_stereo does
// it.
//
//   emulated_gpu_stereo WORKSPACE GPU_INDEX
//
// GPU_INDEX: "none" for the CPU. The environment says what is wrong with the
// GPU, see emulator.h. The other options are those of a quick test. Prints, at
// last, how many calls of CUDA were made.

#include <iostream>
#include <string>

#include "mvs/patch_match.h"
#include "tests/mvs/emulated_cuda/emulator.h"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: emulated_gpu_stereo WORKSPACE GPU_INDEX" << std::endl;
    return 2;
  }
  colmap::mvs::PatchMatchOptions options;
  options.num_iterations = 1;
  options.window_radius = 3;
  options.num_threads = 1;
  options.tapa = true;
  options.num_samples = 5;
  options.max_image_size = 64;
  options.use_gpu = std::string(argv[2]) != "none";
  if (options.use_gpu) {
    options.gpu_index = argv[2];
  }
  colmap::mvs::PatchMatchController controller(options, argv[1], "COLMAP",
                                               "option-all");
  controller.Start();
  controller.Wait();
  std::cout << "Calls: " << emulated_cuda::GetUsage().num_calls << std::endl;
  return controller.ExitStatus();
}
