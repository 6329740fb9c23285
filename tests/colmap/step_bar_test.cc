#include "src/colmap/step_bar.h"

#include <gtest/gtest.h>

#include <string>

namespace tapa {
namespace {

// What is shown after COLMAP has printed a line, so many seconds later than the
// one before.
class StepBarTest : public testing::Test {
 protected:
  std::string After(const std::string& line, double seconds = 0) {
    seconds_ += seconds;
    reader_.Read(line, seconds_);
    return reader_.Bar(seconds_);
  }

 private:
  StepReader reader_;
  double seconds_ = 1000;
};

TEST_F(StepBarTest, FeaturesByPhotograph) {
  EXPECT_EQ(After("Feature extraction"), "");
  EXPECT_EQ(After("Processed file [1/4]", 30),
            "[#####               ]  25.0 %  0:01:30 to go  Finding features");
  // What does not tell leaves it as it is.
  EXPECT_EQ(After("  Name:            [3/4].jpg"),
            "[#####               ]  25.0 %  0:01:30 to go  Finding features");
  EXPECT_EQ(After("Processed file [2/4]", 30),
            "[##########          ]  50.0 %  0:01:00 to go  Finding features");
  EXPECT_EQ(After("Processed file [4/4]", 60), "");
}

TEST_F(StepBarTest, MatchesByBlockOrPhotograph) {
  After("Exhaustive feature matching");
  EXPECT_EQ(After("Matching block [1/2, 1/2] in 1.000s", 10),
            "[#####               ]  25.0 %  0:00:30 to go  Matching features");
  EXPECT_EQ(After("Matching block [2/2, 1/2] in 1.000s", 20),
            "[###############     ]  75.0 %  0:00:10 to go  Matching features");
  EXPECT_EQ(After("Sequential feature matching", 50), "");
  EXPECT_EQ(After("Matching image [1/5] in 1.000s", 10),
            "[####                ]  20.0 %  0:00:40 to go  Matching features");
}

TEST_F(StepBarTest, PosesOfTheConnectedPhotographs) {
  After("Loading database");
  EXPECT_EQ(After("Loading images... 11 in 0.003s (connected 10)"), "");
  EXPECT_EQ(
      After("Registering image #7 (5)", 20),
      "[##########          ]  50.0 %  0:00:20 to go  Finding camera poses");
}

TEST_F(StepBarTest, AnotherStepTakesItsPlace) {
  After("Image undistortion");
  EXPECT_NE(After("Undistorting image [1/3]", 1), "");
  EXPECT_EQ(After("Dense stereo", 1), "");
  EXPECT_EQ(After("Undistorting image [1/3]", 1), "");
  After("StereoFusion::Options");
  EXPECT_NE(After("Fusing image [1/3] with index 0 in 0.1s (5 points)", 1), "");
}

TEST_F(StepBarTest, LinesThatAreOdd) {
  EXPECT_EQ(After("Processed file [1/4]"), "");
  EXPECT_EQ(After("Registering image #7 (5)"), "");
  After("Feature extraction");
  for (const char* line : {"Processed file [", "Processed file [1/0]", "",
                           "Processed file [0/4]", "Processed file [5/4]"}) {
    EXPECT_EQ(After(line, 1), "") << line;
  }
}

}  // namespace
}  // namespace tapa
