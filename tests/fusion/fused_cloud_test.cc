#include "src/fusion/fused_cloud.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <vector>

namespace tapa {
namespace {

FusedView ViewOfPoints(int view, int num_points) {
  FusedView fused;
  fused.view = view;
  fused.points.resize(num_points);
  for (int i = 0; i < num_points; ++i) {
    fused.points[i].position.x = 1e6f * view + i;
  }
  return fused;
}

std::vector<float> Positions(const FusedCloud& cloud) {
  std::vector<float> positions;
  for (const FusedView& view : cloud.views) {
    view.VisitPoints([&](const FusedPoint& point) {
      positions.push_back(point.position.x);
    });
  }
  return positions;
}

// Of which the second and the last one do not fit into memory.
void AddViews(FusedCloud* cloud) {
  cloud->max_bytes_in_memory = 1000 * sizeof(FusedPoint);
  cloud->Add(ViewOfPoints(1, 600));
  cloud->Add(ViewOfPoints(2, 40000));
  cloud->Add(ViewOfPoints(3, 400));
  cloud->Add(ViewOfPoints(4, 1));
}

TEST(FusedCloud, KeepsPointsThatDoNotFitIntoMemoryInAFile) {
  FusedCloud all;
  all.views = {ViewOfPoints(1, 600), ViewOfPoints(2, 40000),
               ViewOfPoints(3, 400), ViewOfPoints(4, 1)};
  const std::filesystem::path folder =
      testing::TempDir() + "/fused_cloud_in_a_file";
  std::filesystem::remove_all(folder);
  std::filesystem::create_directories(folder);
  FusedCloud cloud;
  cloud.folder = folder;
  AddViews(&cloud);
  EXPECT_EQ(cloud.NumPoints(), 41001u);
  EXPECT_EQ(Positions(cloud), Positions(all));
  EXPECT_EQ(cloud.views[0].num_in_file, 0u);
  EXPECT_EQ(cloud.views[1].points.capacity(), 0u);
  EXPECT_EQ(cloud.views[2].num_in_file, 0u);
  EXPECT_EQ(cloud.views[3].num_in_file, 1u);
  EXPECT_TRUE(std::filesystem::is_empty(folder));
  std::filesystem::remove_all(folder);
}

TEST(FusedCloud, KeepsAllInMemoryWhereThereCanBeNoFile) {
  FusedCloud cloud;
  cloud.folder = testing::TempDir() + "/no_such_folder";
  AddViews(&cloud);
  EXPECT_EQ(cloud.NumPoints(), 41001u);
  EXPECT_EQ(cloud.views[1].points.size(), 40000u);
}

}  // namespace
}  // namespace tapa
