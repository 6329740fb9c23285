#ifndef TAPA_SRC_MVS_CAMERA_TABLE_H_
#define TAPA_SRC_MVS_CAMERA_TABLE_H_

#include <vector>

#include "src/mvs/problem.h"
#include "src/mvs/sweep/depth_normal.h"
#include "src/mvs/sweep/source_cameras.h"

namespace tapa {

// A camera in the form that gives the rays of its pixels.
RefCamera MakeRefCamera(const Camera& camera);

// Computes and owns the cameras of a problem in the form that sweeps read: for
// indices of pixels, whole numbers being their centres.
class CameraTable {
 public:
  explicit CameraTable(const Problem& problem);

  const RefCamera& reference() const { return reference_; }
  // Points into this table, which must outlive it.
  SourceCameras sources() const;
  // All of them, see ArrangeCameras; arrays are padded to this many elements.
  const std::vector<float>& coefficients() const { return coefficients_; }
  int padded_count() const { return padded_count_; }

 private:
  RefCamera reference_;
  int count_;
  int padded_count_;
  // One row of padded_count_ views for every coefficient.
  std::vector<float> coefficients_;
};

}  // namespace tapa

#endif  // TAPA_SRC_MVS_CAMERA_TABLE_H_
