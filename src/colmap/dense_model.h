#ifndef TAPA_SRC_COLMAP_DENSE_MODEL_H_
#define TAPA_SRC_COLMAP_DENSE_MODEL_H_

#include <Eigen/Core>
#include <string>
#include <vector>

#include "base/reconstruction.h"
#include "mvs/model.h"

// This header is included by COLMAP's own sources.

namespace tapa {

// Dense stereo and fusion compute in single precision, which loses what is
// small far from the origin, as in UTM coordinates. So they work relative to
// this point: (0, 0, 0) unless the cameras are together far from it. It depends
// on the poses alone, and hardly on a single one.
Eigen::Vector3d LocalOrigin(const colmap::Reconstruction& model);

// Makes what was read from a workspace fit for dense stereo, relative to
// LocalOrigin, which it returns. Throws Failure if a camera has distortion,
// which stereo does not know.
Eigen::Vector3d PrepareDenseModel(const std::string& path,
                                  colmap::Reconstruction* model);

// For a view that shares no points with others: those whose cameras stand
// nearest and look the same way, the best first, at most so many.
std::vector<int> NeighborsByCameras(const colmap::mvs::Model& model, int view,
                                    size_t max_num);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_DENSE_MODEL_H_
