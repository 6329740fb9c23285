#include "src/colmap/views_record.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "src/base/failure.h"
#include "tests/colmap/test_folder.h"

namespace tapa {
namespace {

// Inputs of the first of three views, with these masks.
ViewInputs InputsWith(const std::string& own_mask,
                      const std::string& source_mask) {
  std::vector<SceneView> views(3);
  views[1].name = "b.png";
  views[2].name = "c.png";
  return DescribeInputs(views, 0, {1, 2},
                        {{0, {"photo0", own_mask, ""}},
                         {1, {"photo1", source_mask, ""}},
                         {2, {"photo2", "", ""}}});
}

TEST(ViewsRecord, ReadsWhatItWrote) {
  const TestFolder folder;
  const std::string path = folder.Path("views.txt");
  const ViewsRecord record = {{"a b.png", InputsWith("mask0", "mask1")},
                              {"c.png", InputsWith("", "")}};
  WriteViewsRecord(path, record);
  const ViewsRecord read = ReadViewsRecord(path);
  ASSERT_EQ(read.size(), 2u);
  for (const auto& [name, inputs] : record) {
    EXPECT_EQ(DescribeDifference(read.at(name), inputs), "");
    EXPECT_EQ(read.at(name).masks, inputs.masks);
    EXPECT_EQ(read.at(name).photo, "photo0");
  }
}

// As versions without masks wrote it.
TEST(ViewsRecord, WithoutMasksIsAsBeforeThereWereAny) {
  const TestFolder folder;
  const std::string path = folder.Path("views.txt");
  const ViewInputs inputs = InputsWith("", "");
  EXPECT_EQ(inputs.masks, "");
  const std::string line = inputs.camera + " photo0 " + inputs.sources + " " +
                           inputs.source_cameras + " " + inputs.source_photos +
                           " a.png";
  std::ofstream(path) << line << "\n";
  const ViewsRecord read = ReadViewsRecord(path);
  EXPECT_EQ(DescribeDifference(read.at("a.png"), inputs), "");
  WriteViewsRecord(path, read);
  std::ifstream file(path);
  std::string last;
  for (std::string next; std::getline(file, next);) {
    last = next;
  }
  EXPECT_EQ(last, line);
}

TEST(ViewsRecord, NoticesOtherPriors) {
  const auto inputs_with = [](const std::string& mask, const std::string& own,
                              const std::string& source) {
    std::vector<SceneView> views(2);
    views[1].name = "b.png";
    return DescribeInputs(
        views, 0, {1},
        {{0, {"photo0", mask, own}}, {1, {"photo1", "", source}}});
  };
  const TestFolder folder;
  const std::string path = folder.Path("views.txt");
  for (const std::string mask : {"", "mask0"}) {
    const ViewInputs inputs = inputs_with(mask, "prior0", "prior1");
    EXPECT_EQ(DescribeDifference(inputs_with(mask, "", "prior1"), inputs),
              "other priors");
    EXPECT_EQ(DescribeDifference(inputs_with(mask, "prior0", "prior"), inputs),
              "other priors");
    EXPECT_EQ(DescribeDifference(inputs, inputs_with(mask, "", "")),
              "other priors");
    WriteViewsRecord(path, {{"a.png", inputs}});
    const ViewInputs read = ReadViewsRecord(path).at("a.png");
    EXPECT_EQ(DescribeDifference(read, inputs), "");
    EXPECT_EQ(read.masks, inputs.masks);
    EXPECT_EQ(read.priors, inputs.priors);
  }
}

TEST(ViewsRecord, NoticesOtherMasks) {
  const ViewInputs inputs = InputsWith("mask0", "mask1");
  EXPECT_EQ(DescribeDifference(InputsWith("mask", "mask1"), inputs),
            "other masks");
  EXPECT_EQ(DescribeDifference(InputsWith("mask0", ""), inputs), "other masks");
  EXPECT_EQ(DescribeDifference(InputsWith("mask1", "mask0"), inputs),
            "other masks");
  EXPECT_EQ(DescribeDifference(InputsWith("", ""), inputs), "other masks");
  EXPECT_EQ(DescribeDifference(inputs, InputsWith("", "")), "other masks");
}

}  // namespace
}  // namespace tapa
