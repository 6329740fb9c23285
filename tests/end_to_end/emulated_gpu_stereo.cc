// COLMAP's patch_match_stereo, with its options, on an emulated GPU.
//
// The environment says what is wrong with the GPU, see emulator.h. Prints, at
// last, how many calls of CUDA were made.

#include <iostream>
#include <string>

#include "mvs/patch_match.h"
#include "tests/mvs/emulated_cuda/emulator.h"
#include "util/option_manager.h"

int main(int argc, char** argv) {
  std::string workspace_path;
  colmap::OptionManager options;
  options.AddRequiredOption("workspace_path", &workspace_path);
  options.AddPatchMatchStereoOptions();
  options.Parse(argc, argv);
  colmap::mvs::PatchMatchController controller(
      *options.patch_match_stereo, workspace_path, "COLMAP", "option-all");
  controller.Start();
  controller.Wait();
  std::cout << "Calls: " << emulated_cuda::GetUsage().num_calls << std::endl;
  return controller.ExitStatus();
}
