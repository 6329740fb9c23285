#include "src/colmap/run_part.h"

#include <regex>
#include <string>

#include "src/base/failure.h"

namespace tapa {

RunPart::RunPart(const colmap::mvs::PatchMatchOptions& options)
    : step_(options.step) {
  static const std::regex pattern("([0-9]{1,6})/([0-9]{1,6})");
  std::smatch numbers;
  if (std::regex_match(options.share, numbers, pattern)) {
    share_ = std::stoul(numbers[1]) - 1;
    num_shares_ = std::stoul(numbers[2]);
  }
  // Also if it is 0/... .
  if (numbers.empty() || share_ >= num_shares_) {
    throw Failure("PatchMatchStereo.share is " + options.share +
                  ", but must be one of several shares, as in 2/10");
  }
  if (num_shares_ > 1 && !IsWorker()) {
    throw Failure("PatchMatchStereo.share is " + options.share +
                  ", but only a step from 1 on can be shared out; give "
                  "PatchMatchStereo.step, too");
  }
}

size_t RunPart::PassIndex(size_t num_passes) const {
  const auto step = static_cast<size_t>(step_);
  if (step > num_passes) {
    throw Failure("PatchMatchStereo.step is " + std::to_string(step) +
                  ", but this run has only the steps 1 to " +
                  std::to_string(num_passes));
  }
  return step - 1;
}

bool RunPart::HasItem(size_t item, size_t num_items) const {
  return item * num_shares_ / num_items == share_;
}

bool RunPart::HasNumber(size_t number) const {
  return number % num_shares_ == share_;
}

}  // namespace tapa
