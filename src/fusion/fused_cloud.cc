#include "src/fusion/fused_cloud.h"

#include <utility>

namespace tapa {

void FusedCloud::Add(FusedView view) {
  num_in_memory_ += view.points.size();
  const bool is_full =
      num_in_memory_ > max_bytes_in_memory / sizeof(FusedPoint);
  if (is_full && file_ == nullptr) {
    file_ = std::make_shared<PointFile>(folder);
  }
  if (is_full && file_->IsOpen()) {
    num_in_memory_ -= view.points.size();
    view.begin_in_file = file_->Append(view.points.data(), view.points.size());
    view.num_in_file = view.points.size();
    view.file = file_;
    std::vector<FusedPoint>().swap(view.points);  // Its memory, too.
  }
  views.push_back(std::move(view));
}

}  // namespace tapa
