#include "src/mvs/tapa/superpixels.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <mutex>
#include <opencv2/imgproc.hpp>
#include <opencv2/ximgproc/seeds.hpp>
#include <set>
#include <utility>

namespace tapa {
namespace {

// SEEDS halves its blocks three times, so they need some pixels to begin with.
constexpr int kMinSize = 16;
constexpr int kMinSuperpixelSize = 8;
constexpr int kMaxSuperpixels = 60000;

constexpr int kBinsPerChannel = 8;
using Histogram =
    std::array<float, kBinsPerChannel * kBinsPerChannel * kBinsPerChannel>;

int BinOf(const Rgb& color) {
  constexpr int kBinWidth = 256 / kBinsPerChannel;
  return (color.r / kBinWidth * kBinsPerChannel + color.g / kBinWidth) *
             kBinsPerChannel +
         color.b / kBinWidth;
}

// Sums to 1.
std::vector<Histogram> ComputeHistograms(const Map<Rgb>& image,
                                         const Map<uint16_t>& labels,
                                         int count) {
  std::vector<Histogram> histograms(count, Histogram{});
  std::vector<int> sizes(count, 0);
  for (size_t i = 0; i < image.size(); ++i) {
    const int label = labels.data()[i];
    ++histograms[label][BinOf(image.data()[i])];
    ++sizes[label];
  }
  for (int k = 0; k < count; ++k) {
    for (float& value : histograms[k]) {
      value /= std::max(sizes[k], 1);
    }
  }
  return histograms;
}

float Similarity(const Histogram& a, const Histogram& b) {
  float sum = 0;
  for (size_t i = 0; i < a.size(); ++i) {
    sum += std::sqrt(a[i] * b[i]);
  }
  return std::min(sum, 1.0f);
}

// Gives labels that occur the numbers from 0 on and returns how many there are.
int Renumber(Map<uint16_t>* labels) {
  std::vector<int> numbers(0x10000, -1);
  int count = 0;
  for (size_t i = 0; i < labels->size(); ++i) {
    int& number = numbers[labels->data()[i]];
    if (number < 0) {
      number = count++;
    }
    labels->data()[i] = static_cast<uint16_t>(number);
  }
  return count;
}

// Whether OpenCV's SEEDS finds rows and columns for its blocks; it divides by
// their numbers. It makes ten superpixels of fewer.
bool HasGrid(const Map<Rgb>& image, int num_superpixels) {
  const double count = std::max(num_superpixels, 10);
  const int rows =
      static_cast<int>(std::sqrt(count * image.height() / image.width()));
  return rows > 0 &&
         static_cast<int64_t>(rows) * image.width() >= image.height();
}

// OpenCV fills tables when it converts for the first time, and does so in every
// thread that comes before they are ready, where others read them.
void PrepareLab() {
  static std::once_flag once;
  std::call_once(once, [] {
    cv::Mat lab;
    cv::cvtColor(cv::Mat(1, 1, CV_8UC3, cv::Scalar()), lab, cv::COLOR_RGB2Lab);
  });
}

// Leaves the labels alone where the image's shape has no room for blocks.
// OpenCV's SEEDS mislabels floating point input, so it gets 8-bit Lab.
void RunSeeds(const Map<Rgb>& image, int num_superpixels,
              Map<uint16_t>* labels) {
  constexpr int kNumLevels = 4;
  constexpr int kPrior = 2;
  constexpr int kHistogramBins = 5;
  constexpr int kNumIterations = 10;
  const cv::Mat rgb(image.height(), image.width(), CV_8UC3,
                    const_cast<Rgb*>(image.data()));
  PrepareLab();
  cv::Mat lab;
  cv::cvtColor(rgb, lab, cv::COLOR_RGB2Lab);
  const auto seeds = cv::ximgproc::createSuperpixelSEEDS(
      image.width(), image.height(), 3, num_superpixels, kNumLevels, kPrior,
      kHistogramBins);
  if (seeds->getNumberOfSuperpixels() < 1) {
    return;
  }
  seeds->iterate(lab, kNumIterations);
  cv::Mat result;
  seeds->getLabels(result);
  for (int row = 0; row < image.height(); ++row) {
    for (int col = 0; col < image.width(); ++col) {
      labels->At(row, col) = static_cast<uint16_t>(result.at<int>(row, col));
    }
  }
}

}  // namespace

std::vector<std::vector<Neighbor>> FindNeighbors(const Map<Rgb>& image,
                                                 const Map<uint16_t>& labels,
                                                 int count) {
  std::set<std::pair<int, int>> borders;
  const auto add = [&](int a, int b) {
    if (a != b) {
      borders.emplace(a, b);
      borders.emplace(b, a);
    }
  };
  for (int row = 0; row < labels.height(); ++row) {
    for (int col = 0; col < labels.width(); ++col) {
      const int label = labels.At(row, col);
      if (col > 0) add(label, labels.At(row, col - 1));
      if (row > 0) add(label, labels.At(row - 1, col));
    }
  }
  const std::vector<Histogram> histograms =
      ComputeHistograms(image, labels, count);
  std::vector<std::vector<Neighbor>> neighbors(count);
  for (const auto& [a, b] : borders) {
    neighbors[a].push_back({b, Similarity(histograms[a], histograms[b])});
  }
  return neighbors;
}

Superpixels ComputeSuperpixels(const Map<Rgb>& image, int num_superpixels) {
  Superpixels result;
  if (image.empty()) {
    return result;
  }
  result.labels = Map<uint16_t>(image.width(), image.height(), 0);
  const size_t room = image.size() / (kMinSuperpixelSize * kMinSuperpixelSize);
  const int count = static_cast<int>(
      std::min<size_t>({static_cast<size_t>(std::max(num_superpixels, 1)), room,
                        static_cast<size_t>(kMaxSuperpixels)}));
  if (std::min(image.width(), image.height()) >= kMinSize && count > 1 &&
      HasGrid(image, count)) {
    RunSeeds(image, count, &result.labels);
  }
  result.neighbors =
      FindNeighbors(image, result.labels, Renumber(&result.labels));
  return result;
}

}  // namespace tapa
