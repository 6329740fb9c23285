// Is examples/room what it says it is? The scores of the project rest on it:
// depth that is exact and belongs to the cameras, a sparse model that agrees
// with both, and photographs in which stereo has something to fail at.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <sstream>
#include <string>
#include <vector>

namespace {

namespace fs = std::filesystem;

constexpr int kNumViews = 12;
constexpr int kWidth = 720;
constexpr int kHeight = 480;
constexpr double kUnitsPerMetre = 4000.0;

struct Observation {
  double x, y;
  int64_t point;
};

struct Image {
  std::string name;
  cv::Matx33d R;
  cv::Vec3d t;
  std::vector<Observation> observations;
  cv::Mat_<uint8_t> grey;
  cv::Mat_<double> depth;  // metres
};

struct Point {
  cv::Vec3d position;
  std::vector<std::pair<int, size_t>> track;
};

struct Room {
  double fx = 0, fy = 0, cx = 0, cy = 0;
  std::map<int, Image> images;
  std::map<int64_t, Point> points;
};

fs::path RoomDir() { return TAPA_ROOM_DIR; }

std::string ViewName(const int view) {
  char name[32];
  std::snprintf(name, sizeof(name), "room_%02d", view);
  return name;
}

// Lines that are not comments, empty ones included.
std::vector<std::string> ReadLines(const fs::path& path) {
  std::ifstream file(path);
  std::vector<std::string> lines;
  for (std::string line; std::getline(file, line);) {
    if (line.empty() || line[0] != '#') lines.push_back(line);
  }
  return lines;
}

cv::Matx33d RotationOf(const double w, const double x, const double y,
                       const double z) {
  return {1 - 2 * (y * y + z * z), 2 * (x * y - w * z),
          2 * (x * z + w * y),     2 * (x * y + w * z),
          1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
          2 * (x * z - w * y),     2 * (y * z + w * x),
          1 - 2 * (x * x + y * y)};
}

Room Load() {
  Room room;
  for (const std::string& line :
       ReadLines(RoomDir() / "sparse" / "cameras.txt")) {
    int id, width, height;
    std::string model;
    std::istringstream(line) >> id >> model >> width >> height >> room.fx >>
        room.fy >> room.cx >> room.cy;
    EXPECT_EQ(id, 1);
    EXPECT_EQ(model, "PINHOLE");
    EXPECT_EQ(width, kWidth);
    EXPECT_EQ(height, kHeight);
  }
  const std::vector<std::string> lines =
      ReadLines(RoomDir() / "sparse" / "images.txt");
  for (size_t i = 0; i + 1 < lines.size(); i += 2) {
    int id, camera;
    double w, x, y, z;
    Image image;
    std::istringstream(lines[i]) >> id >> w >> x >> y >> z >> image.t[0] >>
        image.t[1] >> image.t[2] >> camera >> image.name;
    image.R = RotationOf(w, x, y, z);
    std::istringstream row(lines[i + 1]);
    for (Observation o; row >> o.x >> o.y >> o.point;)
      image.observations.push_back(o);
    const std::string stem = fs::path(image.name).stem().string();
    image.grey = cv::imread((RoomDir() / "images" / image.name).string(),
                            cv::IMREAD_GRAYSCALE);
    const cv::Mat depth =
        cv::imread((RoomDir() / "gt_depth" / (stem + ".png")).string(),
                   cv::IMREAD_UNCHANGED);
    if (depth.type() == CV_16UC1) {
      depth.convertTo(image.depth, CV_64F, 1.0 / kUnitsPerMetre);
    }
    room.images[id] = image;
  }
  for (const std::string& line :
       ReadLines(RoomDir() / "sparse" / "points3D.txt")) {
    std::istringstream row(line);
    int64_t id;
    double r, g, b, error;
    Point point;
    row >> id >> point.position[0] >> point.position[1] >> point.position[2] >>
        r >> g >> b >> error;
    std::pair<int, size_t> element;
    while (row >> element.first >> element.second)
      point.track.push_back(element);
    room.points[id] = point;
  }
  return room;
}

template <typename T>
T Quantile(std::vector<T> values, const double q) {
  if (values.empty()) return std::numeric_limits<T>::quiet_NaN();
  const size_t n = static_cast<size_t>(q * (values.size() - 1));
  std::nth_element(values.begin(), values.begin() + n, values.end());
  return values[n];
}

class RoomTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { room_ = new Room(Load()); }
  static void TearDownTestSuite() {
    delete room_;
    room_ = nullptr;
  }

  void SetUp() override {
    ASSERT_EQ(room_->images.size(), static_cast<size_t>(kNumViews));
    for (const auto& [id, image] : room_->images) {
      ASSERT_EQ(image.grey.size(), cv::Size(kWidth, kHeight)) << image.name;
      ASSERT_EQ(image.depth.size(), cv::Size(kWidth, kHeight)) << image.name;
    }
  }

  // The world point that the centre of a pixel sees. Its position in COLMAP's
  // frame is half a pixel further than its index.
  static cv::Vec3d PointAt(const Image& image, const int row, const int col) {
    const double z = image.depth(row, col);
    const cv::Vec3d camera((col + 0.5 - room_->cx) / room_->fx * z,
                           (row + 0.5 - room_->cy) / room_->fy * z, z);
    return image.R.t() * (camera - image.t);
  }

  // Position in COLMAP's frame, and depth.
  static cv::Vec3d Project(const Image& image, const cv::Vec3d& point) {
    const cv::Vec3d camera = image.R * point + image.t;
    return {room_->fx * camera[0] / camera[2] + room_->cx,
            room_->fy * camera[1] / camera[2] + room_->cy, camera[2]};
  }

  static Room* room_;
};

Room* RoomTest::room_ = nullptr;

TEST(RoomFilesTest, AreAllThereAndSmall) {
  for (int view = 0; view < kNumViews; ++view) {
    const std::string name = ViewName(view);
    EXPECT_TRUE(fs::is_regular_file(RoomDir() / "images" / (name + ".jpg")))
        << name;
    EXPECT_TRUE(fs::is_regular_file(RoomDir() / "gt_depth" / (name + ".png")))
        << name;
  }
  for (const char* name :
       {"README.md", "scene.pov", "scene.py", "../generate.py",
        "sparse/cameras.txt", "sparse/images.txt", "sparse/points3D.txt"}) {
    EXPECT_TRUE(fs::is_regular_file(RoomDir() / name)) << name;
  }
  uintmax_t bytes = 0;
  for (const auto& entry : fs::recursive_directory_iterator(RoomDir())) {
    if (entry.is_regular_file()) bytes += entry.file_size();
  }
  std::printf("size: %.2f MB\n", bytes / 1e6);
  EXPECT_LE(bytes, 8000000u);
}

TEST_F(RoomTest, CamerasAreOrderedAlongAWalk) {
  EXPECT_GT(room_->fx, 0);
  EXPECT_EQ(room_->fx, room_->fy);
  EXPECT_EQ(room_->cx, kWidth / 2.0);
  EXPECT_EQ(room_->cy, kHeight / 2.0);
  double length = 0;
  cv::Vec3d last;
  for (const auto& [id, image] : room_->images) {
    EXPECT_EQ(image.name, ViewName(id - 1) + ".jpg");
    EXPECT_NEAR(cv::determinant(image.R), 1.0, 1e-9);
    const cv::Vec3d centre = -(image.R.t() * image.t);
    if (id > 1) {
      EXPECT_GT(cv::norm(centre - last), 0.1);
      EXPECT_LT(cv::norm(centre - last), 0.4);
      EXPECT_GT(centre[0], last[0]);
      length += cv::norm(centre - last);
    }
    last = centre;
  }
  std::printf("length of the walk: %.2f m\n", length);
  EXPECT_GT(length, 1.8);
}

TEST_F(RoomTest, SparseModelIsConsistent) {
  ASSERT_GE(room_->points.size(), 1500u);
  size_t num_observations = 0;
  std::vector<double> errors;
  for (const auto& [point_id, point] : room_->points) {
    ASSERT_GE(point.track.size(), 2u);
    num_observations += point.track.size();
    for (const auto& [image_id, index] : point.track) {
      ASSERT_EQ(room_->images.count(image_id), 1u);
      const Image& image = room_->images.at(image_id);
      ASSERT_LT(index, image.observations.size());
      const Observation& o = image.observations[index];
      EXPECT_EQ(o.point, point_id);
      const cv::Vec3d projected = Project(image, point.position);
      EXPECT_GT(projected[2], 0);
      errors.push_back(std::hypot(projected[0] - o.x, projected[1] - o.y));
      EXPECT_LT(errors.back(), 2.0);
    }
  }
  size_t num_rows = 0;
  for (const auto& [id, image] : room_->images) {
    num_rows += image.observations.size();
    EXPECT_GE(image.observations.size(), 300u) << image.name;
  }
  EXPECT_EQ(num_rows, num_observations);
  std::printf(
      "%zu points, %zu observations, median reprojection error %.3f px\n",
      room_->points.size(), num_observations, Quantile(errors, 0.5));
}

TEST_F(RoomTest, SparseModelAgreesWithDepth) {
  std::vector<double> relative;
  for (const auto& [id, image] : room_->images) {
    for (const Observation& o : image.observations) {
      const double z = Project(image, room_->points.at(o.point).position)[2];
      const int col = std::clamp(static_cast<int>(o.x), 0, kWidth - 1);
      const int row = std::clamp(static_cast<int>(o.y), 0, kHeight - 1);
      relative.push_back(std::abs(z - image.depth(row, col)) /
                         image.depth(row, col));
    }
  }
  std::printf("sparse against depth: median %.3f %%, 90th percentile %.3f %%\n",
              100 * Quantile(relative, 0.5), 100 * Quantile(relative, 0.9));
  EXPECT_LT(Quantile(relative, 0.5), 0.005);
  // Features on edges of things may fall to either side.
  EXPECT_LT(Quantile(relative, 0.8), 0.02);
}

TEST_F(RoomTest, EveryPixelHasDepth) {
  for (const auto& [id, image] : room_->images) {
    double low, high;
    cv::minMaxLoc(image.depth, &low, &high);
    EXPECT_GT(low, 0.5) << image.name;
    EXPECT_LT(high, 7.9) << image.name;
  }
}

// The room's planes are known from scene.pov; y points down here.
TEST_F(RoomTest, PlanesAreFlatAndWhereTheSceneHasThem) {
  struct Plane {
    const char* name;
    int axis;
    double value;
    double min_share;
  };
  // A depth that were half a pixel off would be 3 to 10 mm off on the floor.
  for (const Plane& plane :
       {Plane{"back wall", 2, 4.6, 0.05}, Plane{"left wall", 0, -2.5, 0.01},
        Plane{"floor", 1, 0.0, 0.01}, Plane{"rug", 1, -0.012, 0.02},
        Plane{"table top", 1, -0.432, 0.01}}) {
    std::vector<double> distances;
    double sum = 0;
    size_t exact = 0;
    for (const auto& [id, image] : room_->images) {
      for (int row = 0; row < kHeight; ++row) {
        for (int col = 0; col < kWidth; ++col) {
          const cv::Vec3d point = PointAt(image, row, col);
          const double off = point[plane.axis] - plane.value;
          // This band has pixels of other things too: the table's rounded edge,
          // the foot of the mug, the front of the sofa's seat at that height.
          if (std::abs(off) > 0.005) continue;
          distances.push_back(std::abs(off));
          if (std::abs(off) > 0.0005) continue;
          sum += off;
          ++exact;
        }
      }
    }
    const double n = distances.size();
    const double share = n / (kNumViews * kWidth * kHeight);
    std::printf(
        "%-9s %4.1f %% of all pixels within 5 mm; of these %.2f %% within 0.5 "
        "mm "
        "(mean %+.3f mm); median distance %.3f mm, 95th percentile %.3f mm\n",
        plane.name, 100 * share, 100 * exact / n, 1e3 * sum / exact,
        1e3 * Quantile(distances, 0.5), 1e3 * Quantile(distances, 0.95));
    EXPECT_GT(share, plane.min_share) << plane.name;
    EXPECT_LT(std::abs(sum / exact), 0.0001) << plane.name;
    EXPECT_LT(Quantile(distances, 0.5), 0.0002) << plane.name;
    EXPECT_GT(exact / n, 0.8) << plane.name;
  }
}

// Bilinear weights and the top-left pixel at a position in COLMAP's frame.
struct Sample {
  int row, col;
  double a, b;
  bool inside;
  Sample(const double x, const double y) {
    col = static_cast<int>(std::floor(x - 0.5));
    row = static_cast<int>(std::floor(y - 0.5));
    a = x - 0.5 - col;
    b = y - 0.5 - row;
    inside = col >= 0 && row >= 0 && col + 1 < kWidth && row + 1 < kHeight;
  }
  template <typename F>
  double operator()(const F& value) const {
    return (1 - b) * ((1 - a) * value(row, col) + a * value(row, col + 1)) +
           b * ((1 - a) * value(row + 1, col) + a * value(row + 1, col + 1));
  }
};

// Warps every view into others. Depth must agree, and so must the photographs.
TEST_F(RoomTest, ViewsAgreeWithEachOther) {
  std::vector<float> depth_errors, grey_errors;
  size_t agree = 0;
  double sum_x = 0, sum_y = 0, sum_xx = 0, sum_yy = 0, sum_xy = 0;
  for (const auto& [i, from] : room_->images) {
    for (const int j : {i + 1, i - 3, i + 5}) {
      if (room_->images.count(j) == 0) continue;
      const Image& to = room_->images.at(j);
      for (int row = 0; row < kHeight; row += 2) {
        for (int col = 0; col < kWidth; col += 2) {
          const cv::Vec3d seen = Project(to, PointAt(from, row, col));
          const Sample sample(seen[0], seen[1]);
          if (seen[2] <= 0 || !sample.inside) continue;
          double low = 1e9, high = 0;
          for (int k = 0; k < 4; ++k) {
            const double z = to.depth(sample.row + k / 2, sample.col + k % 2);
            low = std::min(low, z);
            high = std::max(high, z);
          }
          // Something stands in front, or the four pixels straddle an edge.
          if (high < seen[2] - 0.02 || high - low > 0.02 * low) continue;
          // Inverse depth is linear on a plane, so this interpolates exactly.
          const double z =
              1 / sample([&](int r, int c) { return 1 / to.depth(r, c); });
          const double error = std::abs(z - seen[2]);
          depth_errors.push_back(error);
          if (error > 0.002) continue;
          ++agree;
          const double a = from.grey(row, col);
          const double b =
              sample([&](int r, int c) { return double(to.grey(r, c)); });
          grey_errors.push_back(std::abs(a - b));
          sum_x += a;
          sum_y += b;
          sum_xx += a * a;
          sum_yy += b * b;
          sum_xy += a * b;
        }
      }
    }
  }
  const double n = agree;
  const double correlation = (sum_xy / n - sum_x / n * sum_y / n) /
                             std::sqrt((sum_xx / n - sum_x / n * sum_x / n) *
                                       (sum_yy / n - sum_y / n * sum_y / n));
  const double share = n / depth_errors.size();
  std::printf(
      "depth warped into other views: median difference %.3f mm, within 2 mm "
      "%.2f %%\n",
      1e3 * Quantile(depth_errors, 0.5), 100 * share);
  std::printf(
      "photographs warped: median difference %.2f grey levels, correlation "
      "%.4f\n",
      Quantile(grey_errors, 0.5), correlation);
  EXPECT_GE(share, 0.9);
  EXPECT_LT(Quantile(depth_errors, 0.5), 0.0005);
  EXPECT_LT(Quantile(grey_errors, 0.5), 4.0);
  EXPECT_GT(correlation, 0.95);
}

// A surface that fewer than three views see cannot be judged well.
TEST_F(RoomTest, MostIsSeenByFourViews) {
  size_t enough = 0, total = 0;
  for (const auto& [i, from] : room_->images) {
    for (int row = 0; row < kHeight; row += 4) {
      for (int col = 0; col < kWidth; col += 4) {
        const cv::Vec3d point = PointAt(from, row, col);
        int views = 0;
        for (const auto& [j, to] : room_->images) {
          const cv::Vec3d seen = Project(to, point);
          const int c = static_cast<int>(std::floor(seen[0]));
          const int r = static_cast<int>(std::floor(seen[1]));
          if (seen[2] <= 0 || c < 0 || r < 0 || c >= kWidth || r >= kHeight)
            continue;
          views += std::abs(to.depth(r, c) - seen[2]) < 0.02 * seen[2];
        }
        enough += views >= 4;
        ++total;
      }
    }
  }
  std::printf("seen by four views or more: %.1f %%\n", 100.0 * enough / total);
  EXPECT_GT(enough, 0.9 * total);
}

// t = (Var + e) / (Var + e / 0.5) over 5x5 pixels of intensities in 0..1.
TEST_F(RoomTest, AboutHalfIsTextureless) {
  constexpr double kE = 0.00005;
  for (const auto& [id, image] : room_->images) {
    cv::Mat_<double> value, mean, square;
    image.grey.convertTo(value, CV_64F, 1 / 255.0);
    cv::boxFilter(value, mean, -1, {5, 5}, {-1, -1}, true,
                  cv::BORDER_REFLECT_101);
    cv::boxFilter(value.mul(value), square, -1, {5, 5}, {-1, -1}, true,
                  cv::BORDER_REFLECT_101);
    size_t low = 0;
    for (int row = 0; row < kHeight; ++row) {
      for (int col = 0; col < kWidth; ++col) {
        const double variance =
            std::max(0.0, square(row, col) - mean(row, col) * mean(row, col));
        low += (variance + kE) / (variance + kE / 0.5) < 0.75;
      }
    }
    const double share = double(low) / (kWidth * kHeight);
    std::printf("%s: %.1f %% of the pixels have textureness below 0.75\n",
                image.name.c_str(), 100 * share);
    EXPECT_GT(share, 0.35) << image.name;
    EXPECT_LT(share, 0.60) << image.name;
  }
}

}  // namespace
