#include "src/colmap/prior_fit.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>
#include <random>

namespace tapa {
namespace {

// Samples of depths from 2 to 10 all over the image.
std::vector<PriorSample> Samples(
    int count, const std::function<double(const PriorSample&)>& prior_of) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> share(0, 1);
  std::vector<PriorSample> samples(count);
  for (PriorSample& sample : samples) {
    sample.depth = 2 + 8 * share(random);
    sample.x = share(random);
    sample.y = share(random);
    sample.prior = prior_of(sample);
  }
  return samples;
}

// Largest relative error at the samples.
double LargestError(const PriorFit& fit,
                    const std::vector<PriorSample>& samples) {
  double largest = 0;
  for (const PriorSample& s : samples) {
    largest =
        std::max(largest, std::abs(fit.Depth(s.prior, s.x, s.y) / s.depth - 1));
  }
  return largest;
}

TEST(FitPrior, FindsScaleAndShiftOfDepth) {
  const auto samples =
      Samples(100, [](const PriorSample& s) { return 250 * s.depth + 4000; });
  const PriorFit fit = FitPrior(samples);
  EXPECT_TRUE(fit.IsGood());
  EXPECT_FALSE(fit.is_inverse);
  EXPECT_NEAR(fit.scale, 1 / 250.0, 1e-9);
  EXPECT_NEAR(fit.shift, -16, 1e-6);
  EXPECT_EQ(fit.share, 1);
  EXPECT_LT(LargestError(fit, samples), 1e-5);
}

TEST(FitPrior, FindsScaleAndShiftOfInverseDepth) {
  const auto samples =
      Samples(100, [](const PriorSample& s) { return 3 / s.depth + 0.7; });
  const PriorFit fit = FitPrior(samples);
  EXPECT_TRUE(fit.IsGood());
  EXPECT_TRUE(fit.is_inverse);
  EXPECT_LT(LargestError(fit, samples), 1e-5);
}

TEST(FitPrior, LeavesOutliersAlone) {
  std::mt19937 random(2);
  auto samples = Samples(200, [](const PriorSample& s) { return s.depth; });
  for (int i = 0; i < 36; ++i) {
    samples[i].prior = 0.1 + 12.0 * (random() % 1000) / 1000;
  }
  const PriorFit fit = FitPrior(samples);
  EXPECT_TRUE(fit.IsGood());
  for (int i = 36; i < 200; ++i) {
    EXPECT_NEAR(fit.UncorrectedDepth(samples[i].prior) / samples[i].depth, 1,
                0.02);
  }
}

TEST(FitPrior, RefusesWhatSaysNoMoreThanOneDepth) {
  std::mt19937 random(3);
  const auto noise = [&random](const PriorSample&) {
    return 1.0 + random() % 1000;
  };
  EXPECT_FALSE(FitPrior(Samples(500, noise)).IsGood());
  EXPECT_FALSE(
      FitPrior(Samples(500, [](const PriorSample&) { return 3.0; })).IsGood());
  EXPECT_FALSE(FitPrior(Samples(500, [](const PriorSample& s) {
                 return 1 + s.x;
               })).IsGood());
}

TEST(FitPrior, NeedsSomeSamples) {
  const auto same = [](const PriorSample& s) { return s.depth; };
  EXPECT_TRUE(FitPrior(Samples(kMinPriorSamples, same)).IsGood());
  EXPECT_FALSE(FitPrior(Samples(kMinPriorSamples - 1, same)).IsGood());
  EXPECT_FALSE(FitPrior({}).IsGood());
}

TEST(FitPrior, CorrectsErrorsThatChangeSlowly) {
  const auto bent = [](const PriorSample& s) {
    return s.depth * (1 + 0.08 * std::sin(3 * s.x) * std::cos(4 * s.y));
  };
  const auto samples = Samples(1000, bent);
  const PriorFit fit = FitPrior(samples);
  ASSERT_TRUE(fit.IsGood());
  PriorFit uncorrected = fit;
  uncorrected.correction = {};
  EXPECT_GT(LargestError(uncorrected, samples), 0.03);
  EXPECT_LT(LargestError(fit, samples), 0.02);
}

TEST(PriorFit, HasNoDepthWhereThePriorHasNone) {
  const PriorFit fit =
      FitPrior(Samples(50, [](const PriorSample& s) { return 5 + s.depth; }));
  for (const double none :
       {0.0, -1.0, double{NAN}, std::numeric_limits<double>::infinity()}) {
    EXPECT_EQ(fit.Depth(none, 0.5, 0.5), 0) << none;
  }
  // What would be behind the camera.
  EXPECT_EQ(fit.Depth(4, 0.5, 0.5), 0);
  EXPECT_GT(fit.Depth(6, 0.5, 0.5), 0);
  // Corners and beyond.
  for (const double at : {-0.1, 0.0, 1.0, 1.1}) {
    EXPECT_GT(fit.Depth(6, at, at), 0);
  }
}

}  // namespace
}  // namespace tapa
