#ifndef TAPA_TESTS_EVAL_TEST_FILES_H_
#define TAPA_TESTS_EVAL_TEST_FILES_H_

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>
#include <vector>

namespace tapa {

// A folder that is empty when a test begins and gone when it ends.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string pattern =
        (std::filesystem::temp_directory_path() / "tapa_eval_XXXXXX").string();
    EXPECT_NE(mkdtemp(pattern.data()), nullptr);
    path_ = pattern;
  }
  ~TemporaryFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  // Path of a file in this folder; the folders above it are made.
  std::string File(const std::string& name) const {
    const std::filesystem::path path = path_ / name;
    std::filesystem::create_directories(path.parent_path());
    return path.string();
  }
  std::string path() const { return path_.string(); }

 private:
  std::filesystem::path path_;
};

inline void ExpectContains(const std::string& text, const std::string& part) {
  EXPECT_NE(text.find(part), std::string::npos)
      << "'" << part << "' is not in: " << text;
}

// That reading a file fails with one line, which names it and says `part`.
template <typename Read>
void ExpectReadError(const Read& read, const std::string& path,
                     const std::string& part) {
  try {
    read(path);
    ADD_FAILURE() << "no error: " << part;
  } catch (const std::runtime_error& error) {
    const std::string text = error.what();
    ExpectContains(text, path);
    ExpectContains(text, part);
    EXPECT_EQ(text.find('\n'), std::string::npos) << text;
  }
}

inline void WriteText(const std::string& path, const std::string& text) {
  std::ofstream(path, std::ios::binary) << text;
}

// Writes values as they are behind a header of COLMAP's form.
inline void WriteColmapMap(const std::string& path, int width, int height,
                           int channels, const std::vector<float>& values) {
  std::ofstream stream(path, std::ios::binary);
  stream << width << "&" << height << "&" << channels << "&";
  stream.write(reinterpret_cast<const char*>(values.data()),
               static_cast<std::streamsize>(values.size() * sizeof(float)));
}

inline void WriteDepthPng(const std::string& path, int width, int height,
                          const std::vector<uint16_t>& values) {
  cv::Mat image(height, width, CV_16UC1);
  for (int i = 0; i < width * height; ++i) {
    image.at<uint16_t>(i / width, i % width) = values.at(i);
  }
  ASSERT_TRUE(cv::imwrite(path, image));
}

inline void WritePhotograph(const std::string& path, int width, int height,
                            int contrast = 100) {
  cv::Mat image(height, width, CV_8UC3);
  cv::RNG random(1);
  random.fill(image, cv::RNG::UNIFORM, 100, 101 + contrast);
  ASSERT_TRUE(cv::imwrite(path, image));
}

}  // namespace tapa

#endif  // TAPA_TESTS_EVAL_TEST_FILES_H_
