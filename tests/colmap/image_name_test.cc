#include "src/colmap/image_name.h"

#include <gtest/gtest.h>

#include "src/base/failure.h"

namespace tapa {
namespace {

// Empty: there is none.
std::string Error(const std::string& name) {
  try {
    CheckImageName(name);
    return "";
  } catch (const Failure& error) {
    return error.what();
  }
}

TEST(CheckImageName, KnowsNamesOfFilesBelowAFolder) {
  for (const std::string& name :
       {std::string("a.jpg"), std::string("left/a b.jpg"), std::string("..a"),
        std::string("a../..b/c..d"), std::string(" #1, 2; 3.jpg"),
        std::string("\xc3\xa9\xff.jpg"), std::string(255, 'a')}) {
    EXPECT_EQ(Error(name), "");
  }
}

TEST(CheckImageName, RefusesNamesOfOtherPlaces) {
  for (const char* name :
       {"..", "../a.jpg", "a/../../b.jpg", "a/..", "/a.jpg", "//a.jpg"}) {
    EXPECT_NE(Error(name).find(std::string("'") + name + "'"),
              std::string::npos)
        << name;
  }
  EXPECT_NE(Error(""), "");
}

TEST(CheckImageName, RefusesWhatIsNoNameAndSaysSoOnOneLine) {
  using std::string_literals::operator""s;
  for (const std::string& name : {"a\nb.jpg"s, "a\rb.jpg"s, "\x1b[2Ja.jpg"s,
                                  "a\0b.jpg"s, "a\tb.jpg"s, "\x7f.jpg"s}) {
    const std::string error = Error(name);
    EXPECT_NE(error.find("not for names"), std::string::npos) << error;
    for (const char character : error) {
      EXPECT_GE(static_cast<unsigned char>(character), ' ');
    }
  }
  std::string deep;
  while (deep.size() < 5000) {
    deep += "folder/";
  }
  for (const std::string& name : {std::string(256, 'a'), deep}) {
    const std::string error = Error(name);
    EXPECT_NE(error.find("too long"), std::string::npos) << error;
    EXPECT_LT(error.size(), 300);
  }
}

}  // namespace
}  // namespace tapa
