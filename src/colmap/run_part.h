#ifndef TAPA_SRC_COLMAP_RUN_PART_H_
#define TAPA_SRC_COLMAP_RUN_PART_H_

#include <cstddef>

#include "mvs/patch_match.h"

namespace tapa {

// A run of dense stereo on several machines is done in parts: a first program
// prepares it, workers then compute a share of the views of one pass each, and
// an ordinary run at the end, which finds all maps there, makes sure of that
// and tidies up. All of them share the workspace's folder (docs/usage.md).
class RunPart {
 public:
  // The whole run.
  RunPart() = default;
  // Of the options step and share. Throws Failure if they are not valid.
  explicit RunPart(const colmap::mvs::PatchMatchOptions& options);

  bool IsWhole() const { return step_ < 0; }
  // Looks at all and writes the records of all passes, but no maps.
  bool IsPreparation() const { return step_ == 0; }
  // Computes, and writes nothing but maps.
  bool IsWorker() const { return step_ > 0; }

  // Of a worker: the pass that it computes. Throws Failure if there are not as
  // many.
  size_t PassIndex(size_t num_passes) const;

  // Whether the share has an item of a list. Neighbours in the list, which have
  // sources in common, are in one share as a rule.
  bool HasItem(size_t item, size_t num_items) const;
  // The same for a list of which items may be gone for some of the workers.
  bool HasNumber(size_t number) const;

 private:
  int step_ = -1;
  // From 0 on.
  size_t share_ = 0;
  size_t num_shares_ = 1;
};

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_RUN_PART_H_
