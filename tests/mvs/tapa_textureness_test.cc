#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <stdexcept>

#include "src/mvs/tapa/textureness.h"
#include "tests/mvs/tapa_reference.h"

namespace tapa {
namespace {

Map<uint8_t> RandomImage(int width, int height, int low, int high, int seed) {
  std::mt19937 generator(seed);
  std::uniform_int_distribution<int> intensity(low, high);
  Map<uint8_t> image(width, height);
  for (size_t i = 0; i < image.size(); ++i) {
    image.data()[i] = static_cast<uint8_t>(intensity(generator));
  }
  return image;
}

void ExpectReference(const Map<uint8_t>& image,
                     const TexturenessOptions& options) {
  const Map<float> textureness = ComputeTextureness(image, options);
  ASSERT_EQ(textureness.width(), image.width());
  ASSERT_EQ(textureness.height(), image.height());
  for (int row = 0; row < image.height(); ++row) {
    for (int col = 0; col < image.width(); ++col) {
      ASSERT_NEAR(textureness.At(row, col),
                  reference::Textureness(image, row, col, options), 1e-6)
          << "row " << row << " col " << col;
    }
  }
}

TEST(TexturenessTest, AgreesWithDefinition) {
  const struct {
    int width, height;
  } sizes[] = {{1, 1}, {2, 1}, {3, 200}, {200, 3}, {4, 4}, {5, 5}, {61, 47}};
  const struct {
    int low, high;
  } ranges[] = {{0, 255}, {120, 121}, {100, 104}, {0, 0}, {255, 255}};
  int seed = 0;
  for (const auto& size : sizes) {
    for (const auto& range : ranges) {
      const Map<uint8_t> image =
          RandomImage(size.width, size.height, range.low, range.high, ++seed);
      for (const int radius : {0, 1, 2, 7, 40}) {
        TexturenessOptions options;
        options.radius = radius;
        ExpectReference(image, options);
      }
    }
  }
}

TEST(TexturenessTest, FlatImageIsExactlyTheMinimum) {
  for (const int value : {0, 1, 77, 255}) {
    const Map<float> textureness =
        ComputeTextureness(Map<uint8_t>(9, 7, static_cast<uint8_t>(value)));
    for (size_t i = 0; i < textureness.size(); ++i) {
      EXPECT_EQ(textureness.data()[i], 0.5f);
    }
  }
}

TEST(TexturenessTest, HalfBlackHalfWhite) {
  // Two pixels, 0 and 255: the variance is 0.25 in both clipped patches.
  Map<uint8_t> image(2, 1);
  image.At(0, 1) = 255;
  const Map<float> textureness = ComputeTextureness(image);
  EXPECT_FLOAT_EQ(textureness.At(0, 0), 0.25005f / 0.2501f);
  EXPECT_FLOAT_EQ(textureness.At(0, 1), 0.25005f / 0.2501f);
}

TEST(TexturenessTest, EmptyImage) {
  EXPECT_TRUE(ComputeTextureness(Map<uint8_t>()).empty());
}

TEST(TexturenessTest, LargeRadiusDoesNotOverflow) {
  TexturenessOptions options;
  options.radius = 1000;
  Map<uint8_t> image(2001, 2001, 255);
  for (int row = 0; row < 2001; ++row) {
    for (int col = 0; col < 2001; col += 2) image.At(row, col) = 0;
  }
  const Map<float> textureness = ComputeTextureness(image, options);
  EXPECT_NEAR(textureness.At(1000, 1000), 0.25005 / 0.2501, 1e-6);
}

TEST(TexturenessTest, RejectsOptions) {
  const Map<uint8_t> image(3, 3);
  TexturenessOptions options;
  options.radius = -1;
  EXPECT_THROW(ComputeTextureness(image, options), std::invalid_argument);
  options = TexturenessOptions();
  options.epsilon = 0;
  EXPECT_THROW(ComputeTextureness(image, options), std::invalid_argument);
  options = TexturenessOptions();
  options.min_textureness = std::nan("");
  EXPECT_THROW(ComputeTextureness(image, options), std::invalid_argument);
}

}  // namespace
}  // namespace tapa
