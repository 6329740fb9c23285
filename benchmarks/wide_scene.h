#ifndef TAPA_BENCHMARKS_WIDE_SCENE_H_
#define TAPA_BENCHMARKS_WIDE_SCENE_H_

#include <vector>

#include "src/mvs/problem.h"

namespace tapa {

// A large problem that is made within seconds: a textured plane parallel to the
// image, seen by cameras that are moved sideways. Owns what `problem` points
// to.
class WideScene {
 public:
  WideScene(int width, int height, int num_sources);
  WideScene(const WideScene&) = delete;
  WideScene& operator=(const WideScene&) = delete;

  // With depth maps, for both passes.
  const Problem& problem() const { return problem_; }
  float depth() const { return 4; }

 private:
  Problem problem_;
  std::vector<Map<uint8_t>> images_;
  Map<float> source_depth_;
};

}  // namespace tapa

#endif  // TAPA_BENCHMARKS_WIDE_SCENE_H_
