#ifndef TAPA_SRC_COLMAP_PROGRESS_NEWS_H_
#define TAPA_SRC_COLMAP_PROGRESS_NEWS_H_

#include <functional>
#include <string>

#include "src/colmap/pass.h"

// This header is included by COLMAP's own sources.

namespace tapa {

// How far a run of dense stereo is.
struct ProgressNews {
  // Part of all work that is done, 0 to 1.
  double share = 0;
  // For the user: time to go, and level, pass and view that are computed.
  std::string text;
  // The view of which a pass has just written maps that stay; empty: none.
  std::string finished_view;
  Pass finished_pass = Pass::kPhotometric;
};

// Called by any thread, by one at a time and not often; must return soon.
using ProgressListener = std::function<void(const ProgressNews&)>;

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_PROGRESS_NEWS_H_
