#ifndef TAPA_SRC_COLMAP_PROBLEM_READER_H_
#define TAPA_SRC_COLMAP_PROBLEM_READER_H_

#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "src/base/map.h"
#include "src/colmap/stereo_plan.h"
#include "src/colmap/view_cache.h"
#include "src/mvs/levels.h"
#include "src/mvs/problem.h"

namespace tapa {

// The engine's problem for a view, and what it borrows.
struct ProblemInput {
  Problem problem;
  std::optional<Map<Rgb>> color;
  std::vector<std::shared_ptr<const Map<uint8_t>>> photos;
  std::vector<std::shared_ptr<const Map<float>>> depth_maps;
};

// Reads what the engine needs to know of a view, and keeps as much as the
// option cache_size says, but no more than half of the memory
// that it may use (machine_limits.h). May be
// used by several threads at a time: they read one after the other.
class ProblemReader {
 public:
  // The plan must outlive it.
  explicit ProblemReader(const StereoPlan& plan);

  // Reads all photographs that are needed, so that a damaged one is found
  // before hours are spent. The cache keeps what fits. Returns false if
  // stopped; throws Failure.
  bool ReadPhotos(const std::function<bool()>& stopped);

  // Returns nothing if stopped. Throws Failure.
  std::unique_ptr<ProblemInput> Read(const ViewIndices& problem,
                                     const PassPlan& pass,
                                     const std::function<bool()>& stopped);

  // What views need to judge each other's drafts (tapa/consensus.h): cameras,
  // depth maps, the view's own maps (as Problem::depth and normal) and mask,
  // but no photographs. Sources that are no results have no drafts. Returns
  // nothing if stopped. Throws Failure.
  std::unique_ptr<ProblemInput> ReadDrafts(
      const ViewIndices& problem, const PassPlan& pass,
      const std::function<bool()>& stopped);

  // How much of what was asked for was in memory already, as a line.
  std::string DescribeCacheUse();

 private:
  // A view at a level, as one number for the caches.
  int Key(int view, int level) const;
  // A view's draft, which comes after all levels.
  int DraftKey(int view) const;
  // Read maps of a pass.
  Map<float> ReadDepth(int view, int level, Pass pass) const;
  Map<Vec3> ReadNormal(int view, int level, Pass pass) const;
  DepthNormalMaps ReadStart(const PassPlan& pass, const View& reference,
                            int view);

  const StereoPlan& plan_;
  std::mutex mutex_;
  ViewCache<uint8_t> photos_;
  // Of photometric passes, and drafts.
  ViewCache<float> depth_maps_;
};

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_PROBLEM_READER_H_
