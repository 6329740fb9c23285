#include "src/colmap/problem_config.h"

#include <gtest/gtest.h>

#include <fstream>
#include <set>

#include "src/base/failure.h"
#include "tests/colmap/test_folder.h"

namespace tapa {
namespace {

using Names = std::vector<std::string>;

// names: those of the model's images.
std::vector<ViewConfig> Parse(const std::string& text,
                              const std::set<std::string>& names = {}) {
  const TestFolder folder;
  const std::string path = folder.Path("patch-match.cfg");
  std::ofstream(path) << text;
  return ReadProblemConfig(path, [&names](const std::string& name) {
    return names.count(name) > 0;
  });
}

TEST(ReadProblemConfig, ReadsAllKinds) {
  const auto config = Parse(
      "# a comment\n"
      "a b.jpg\r\n"
      "__all__\r\n"
      "\n"
      "  b.jpg\n"
      "__auto__, 20\n"
      "c.jpg\n"
      "# another one\n"
      "a b.jpg, b.jpg,x/d.jpg\n");
  ASSERT_EQ(config.size(), 3);
  EXPECT_EQ(config[0].reference, "a b.jpg");
  EXPECT_EQ(config[0].sources, ViewConfig::Sources::kAll);
  EXPECT_EQ(config[1].reference, "b.jpg");
  EXPECT_EQ(config[1].sources, ViewConfig::Sources::kAuto);
  EXPECT_EQ(config[1].max_num_sources, 20);
  EXPECT_EQ(config[2].sources, ViewConfig::Sources::kNamed);
  EXPECT_EQ(config[2].source_names, (Names{"a b.jpg", "b.jpg", "x/d.jpg"}));
}

TEST(ReadProblemConfig, RefusesNonsense) {
  for (const char* text : {
           "",
           "# only a comment\n",
           "a.jpg\n",
           "a.jpg\n__all__\nb.jpg\n",
           "a.jpg\n , ,\n",
           "a.jpg\n__auto__\n",
           "a.jpg\n__auto__, x\n",
           "a.jpg\n__auto__, 0\n",
           "a.jpg\n__auto__, -3\n",
           "a.jpg\n__auto__, 3, 4\n",
           "a.jpg\n__auto__, 99999999999\n",
       }) {
    EXPECT_THROW(Parse(text), Failure) << text;
  }
  EXPECT_THROW(ReadProblemConfig("/nowhere/patch-match.cfg",
                                 [](const std::string&) { return true; }),
               Failure);
}

TEST(ReadProblemConfig, ReadsLongListsInTimeThatGrowsWithThem) {
  // It took time that grew with the cube of their length.
  const auto config =
      Parse("a.jpg\nb.jpg" + std::string(100000, ',') + "c.jpg\n");
  EXPECT_EQ(config[0].source_names, (Names{"b.jpg", "c.jpg"}));
}

TEST(ReadProblemConfig, SkipsByteOrderMark) {
  EXPECT_EQ(Parse("\xef\xbb\xbf"
                  "a.jpg\r\n__all__\r\n")[0]
                .reference,
            "a.jpg");
}

TEST(ReadProblemConfig, KnowsNamesWithAnyCharacter) {
  const auto config = Parse(
      "#1.jpg\n"
      "Hall, left; 2.jpg, b.jpg,  c.jpg; Hall, left.jpg\n"
      "# a comment\n"
      " c.jpg\n"
      "#1.jpg,Hall, left; 2.jpg\n",
      {"#1.jpg", "Hall, left; 2.jpg", "Hall, left.jpg", " c.jpg", "b.jpg"});
  ASSERT_EQ(config.size(), 2);
  EXPECT_EQ(config[0].reference, "#1.jpg");
  EXPECT_EQ(config[0].source_names,
            (Names{"Hall, left; 2.jpg", "b.jpg", " c.jpg", "Hall, left.jpg"}));
  EXPECT_EQ(config[1].reference, " c.jpg");
  EXPECT_EQ(config[1].source_names, (Names{"#1.jpg", "Hall, left; 2.jpg"}));
}

}  // namespace
}  // namespace tapa
