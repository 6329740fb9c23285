#include "src/colmap/dense_model.h"

#include <gtest/gtest.h>

#include "src/base/failure.h"

namespace tapa {
namespace {

// Cameras in a row along x, one unit apart, that look along z.
colmap::Reconstruction Row(const Eigen::Vector3d& shift, int num_images = 4,
                           const std::string& camera_model = "PINHOLE") {
  colmap::Reconstruction model;
  colmap::Camera camera;
  camera.SetCameraId(1);
  camera.InitializeWithName(camera_model, 100, 64, 48);
  model.AddCamera(camera);
  for (int i = 0; i < num_images; ++i) {
    colmap::Image image;
    image.SetImageId(i + 1);
    image.SetCameraId(1);
    image.SetName(std::to_string(i));
    image.SetQvec(Eigen::Vector4d(1, 0, 0, 0));
    image.SetTvec(-shift - Eigen::Vector3d(i, 0, 0));
    model.AddImage(image);
    model.RegisterImage(i + 1);
  }
  return model;
}

TEST(LocalOrigin, IsThatOfTheModelWhereItIsNear) {
  EXPECT_TRUE(LocalOrigin(colmap::Reconstruction()).isZero(0));
  EXPECT_TRUE(LocalOrigin(Row({0, 0, 0})).isZero(0));
  EXPECT_TRUE(LocalOrigin(Row({5, -9, 3})).isZero(0));
}

TEST(LocalOrigin, IsNearTheCamerasElsewhere) {
  const Eigen::Vector3d far(500000, 5200000, 200);
  const Eigen::Vector3d origin = LocalOrigin(Row(far, 10));
  EXPECT_LT((origin - far).norm(), 10);
  EXPECT_EQ(LocalOrigin(Row(far, 11)), origin) << "a view was added";
  EXPECT_EQ(LocalOrigin(Row(far, 1)), far);
}

TEST(PrepareDenseModel, KeepsDigits) {
  const Eigen::Vector3d far(500000.25, 5200000.5, 200);
  colmap::Reconstruction model = Row(far);
  model.AddPoint3D(far + Eigen::Vector3d(0.001, 0, 4), colmap::Track());
  const Eigen::Vector3d origin = LocalOrigin(model);
  PrepareDenseModel("workspace", &model);
  const Eigen::Vector3d point =
      model.Points3D().begin()->second.XYZ() + origin - far;
  EXPECT_NEAR(point.x(), 0.001, 1e-8);
  const Eigen::Vector3d center = model.Image(2).ProjectionCenter() + origin;
  EXPECT_NEAR((center - far - Eigen::Vector3d(1, 0, 0)).norm(), 0, 1e-8);
}

TEST(PrepareDenseModel, RefusesDistortion) {
  colmap::Reconstruction model = Row({0, 0, 0}, 2, "SIMPLE_RADIAL");
  PrepareDenseModel("workspace", &model);  // It has none yet.
  model.Camera(1).Params().back() = -0.2;
  EXPECT_THROW(PrepareDenseModel("workspace", &model), Failure);
  // Without any parameter of distortion it is no pinhole camera.
  colmap::Reconstruction fisheye = Row({0, 0, 0}, 2, "OPENCV_FISHEYE");
  EXPECT_THROW(PrepareDenseModel("workspace", &fisheye), Failure);
}

TEST(NeighborsByCameras, TakesTheNearestThatLookTheSameWay) {
  colmap::mvs::Model model;
  const float K[9] = {100, 0, 32, 0, 100, 24, 0, 0, 1};
  const float ahead[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
  const float back[9] = {-1, 0, 0, 0, 1, 0, 0, 0, -1};
  for (const float x : {0.0f, 1.0f, 3.0f, 7.0f}) {
    const float t[3] = {-x, 0, 0};
    model.images.emplace_back("", 64, 48, K, ahead, t);
  }
  const float t[3] = {0.5f, 0, 0};
  model.images.emplace_back("", 64, 48, K, back, t);
  EXPECT_EQ(NeighborsByCameras(model, 1, 9), (std::vector<int>{0, 2, 3}));
  EXPECT_EQ(NeighborsByCameras(model, 2, 2), (std::vector<int>{1, 0}));
  EXPECT_TRUE(NeighborsByCameras(model, 4, 9).empty());
}

}  // namespace
}  // namespace tapa
