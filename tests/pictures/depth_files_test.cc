#include "src/pictures/depth_files.h"

#include <gtest/gtest.h>

#include <climits>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <opencv2/core.hpp>
#include <opencv2/imgcodecs.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "src/base/failure.h"

namespace tapa {
namespace {

class DepthFiles : public testing::Test {
 protected:
  DepthFiles() : folder_(testing::TempDir() + "/depth_files_XXXXXX") {
    setenv("OPENCV_IO_ENABLE_OPENEXR", "1", 1);
    // Of its own: tests run side by side.
    if (mkdtemp(folder_.data()) == nullptr) {
      throw std::runtime_error("no folder for " + folder_);
    }
  }
  ~DepthFiles() override { std::filesystem::remove_all(folder_); }

  std::string Path(const std::string& name) const {
    return folder_ + "/" + name;
  }

  std::string Write(const std::string& name, const std::string& bytes) const {
    std::ofstream(Path(name), std::ios::binary) << bytes;
    return Path(name);
  }

  std::string Read(const std::string& name) const {
    std::ifstream file(Path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }

  // As text of the message; empty: there is none. Takes no file with pixels
  // beyond this number of rows or columns.
  std::string ErrorOf(const std::string& path, int max_side = 1000) const {
    try {
      ReadDepthFile(path, [&](int width, int height) {
        if (width > max_side || height > max_side) {
          throw Failure(path + " would be " + std::to_string(width) + "x" +
                        std::to_string(height));
        }
      });
    } catch (const Failure& error) {
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos);
      return error.what();
    }
    return "";
  }

  std::string folder_;
};

// 3 x 2 values.
const std::vector<float> kValues = {1.5f, 0, 3, 4, 65504, 0.25f};

cv::Mat Floats() {
  return cv::Mat(2, 3, CV_32F, const_cast<float*>(kValues.data())).clone();
}

void ExpectValues(const Map<float>& map) {
  ASSERT_EQ(map.width(), 3);
  ASSERT_EQ(map.height(), 2);
  for (int i = 0; i < 6; ++i) {
    EXPECT_EQ(map.data()[i], kValues[i]) << i;
  }
}

template <typename T>
std::string BytesOf(const std::vector<T>& values) {
  return {reinterpret_cast<const char*>(values.data()),
          values.size() * sizeof(T)};
}

std::string Npy(const std::string& type, const std::string& shape,
                const std::string& values, bool fortran = false,
                int version = 1) {
  const std::string header = "{'descr': '" + type + "', 'fortran_order': " +
                             (fortran ? "True" : "False") +
                             ", 'shape': " + shape + ", }\n";
  std::string size(version == 1 ? 2 : 4, '\0');
  size[0] = static_cast<char>(header.size());
  return std::string("\x93NUMPY") + static_cast<char>(version) + '\0' + size +
         header + values;
}

TEST_F(DepthFiles, ReadsExr) {
  cv::imwrite(Path("a.exr"), Floats());
  ExpectValues(ReadDepthFile(Path("a.exr")));
  // Of a channel called Z.
  std::string bytes = Read("a.exr");
  const size_t list = bytes.find(std::string("chlist\0", 7));
  ASSERT_NE(list, std::string::npos);
  ASSERT_EQ(bytes[list + 11], 'Y');
  bytes[list + 11] = 'Z';
  ExpectValues(ReadDepthFile(Write("z.exr", bytes)));
  // Of 16 bits.
  cv::imwrite(Path("half.exr"), Floats(),
              {cv::IMWRITE_EXR_TYPE, cv::IMWRITE_EXR_TYPE_HALF});
  ExpectValues(ReadDepthFile(Path("half.exr")));
}

TEST_F(DepthFiles, ReadsPfm) {
  cv::imwrite(Path("a.pfm"), Floats());
  ExpectValues(ReadDepthFile(Path("a.pfm")));
  // Big-endian, and from the lowest row up.
  std::string bytes = "Pf\n3 2\n1.0\n";
  for (const int i : {3, 4, 5, 0, 1, 2}) {
    const std::string value = BytesOf(std::vector<float>{kValues[i]});
    bytes.append(value.rbegin(), value.rend());
  }
  ExpectValues(ReadDepthFile(Write("big.pfm", bytes)));
}

TEST_F(DepthFiles, ReadsPngOf16Bits) {
  const cv::Mat values = (cv::Mat_<uint16_t>(2, 3) << 1, 0, 300, 4, 65535, 7);
  cv::imwrite(Path("a.png"), values);
  const Map<float> map = ReadDepthFile(Path("a.png"));
  ASSERT_EQ(map.width(), 3);
  EXPECT_EQ(map.At(0, 2), 300);
  EXPECT_EQ(map.At(1, 1), 65535);
}

TEST_F(DepthFiles, ReadsNpy) {
  ExpectValues(
      ReadDepthFile(Write("a.npy", Npy("<f4", "(2, 3)", BytesOf(kValues)))));
  ExpectValues(ReadDepthFile(
      Write("b.npy", Npy("<f4", "(2, 3)", BytesOf(kValues), false, 2))));
  ExpectValues(ReadDepthFile(Write(
      "c.npy",
      Npy("<f8", "(2, 3)",
          BytesOf(std::vector<double>(kValues.begin(), kValues.end()))))));
  // Halves of 1.5, 0, 3, 4, 65504 and 0.25.
  const std::vector<uint16_t> halves = {0x3E00, 0,      0x4200,
                                        0x4400, 0x7BFF, 0x3400};
  ExpectValues(
      ReadDepthFile(Write("d.npy", Npy("<f2", "(2, 3)", BytesOf(halves)))));
}

TEST_F(DepthFiles, KeepsWhatIsNoDepth) {
  const std::vector<float> values = {NAN, INFINITY, -1};
  const Map<float> map =
      ReadDepthFile(Write("a.npy", Npy("<f4", "(1, 3)", BytesOf(values))));
  EXPECT_TRUE(std::isnan(map.At(0, 0)));
  EXPECT_EQ(map.At(0, 1), INFINITY);
  EXPECT_EQ(map.At(0, 2), -1);
}

TEST_F(DepthFiles, RefusesOtherNpy) {
  const std::string values = BytesOf(kValues);
  for (const std::string& bytes :
       {Npy(">f4", "(2, 3)", values), Npy("<i4", "(2, 3)", values),
        Npy("|O", "(2, 3)", values), Npy("<f4", "(6,)", values),
        Npy("<f4", "(2, 3, 1)", values), Npy("<f4", "(2, 3)", values, true)}) {
    EXPECT_NE(ErrorOf(Write("a.npy", bytes)).find("shape"), std::string::npos);
  }
  for (const std::string& bytes :
       {Npy("<f4", "(2, 4)", values), Npy("<f4", "(0, 3)", ""),
        Npy("<f4", "(2, 3)", values + "x"),
        Npy("<f4", "(999999, 999999)", values)}) {
    EXPECT_NE(ErrorOf(Write("a.npy", bytes)).find("bytes"), std::string::npos);
  }
}

TEST_F(DepthFiles, RefusesDamagedFiles) {
  cv::imwrite(Path("a.exr"), Floats());
  cv::imwrite(Path("a.pfm"), Floats());
  cv::imwrite(Path("a.png"), cv::Mat(20, 30, CV_16U, cv::Scalar(77)));
  Write("a.npy", Npy("<f4", "(2, 3)", BytesOf(kValues)));
  for (const std::string name : {"a.exr", "a.pfm", "a.png", "a.npy"}) {
    const std::string bytes = Read(name);
    for (const size_t size :
         {size_t{0}, size_t{3}, size_t{9}, bytes.size() / 2}) {
      EXPECT_NE(ErrorOf(Write(name, bytes.substr(0, size))), "")
          << name << " " << size;
    }
    EXPECT_NE(ErrorOf(Write(name, "This is no depth map.\n")), "") << name;
  }
  EXPECT_NE(ErrorOf(Path("absent.exr")), "");
}

TEST_F(DepthFiles, AsksForTheSizeBeforePixelsAreDecoded) {
  const cv::Mat values(2, 30, CV_16U, cv::Scalar(7));
  cv::imwrite(Path("a.png"), values);
  cv::Mat floats;
  values.convertTo(floats, CV_32F);
  for (const char* name : {"a.exr", "a.pfm"}) {
    cv::imwrite(Path(name), floats);
  }
  Write("a.npy", Npy("<f4", "(2, 30)", std::string(240, '\0')));
  for (const std::string name : {"a.exr", "a.pfm", "a.png", "a.npy"}) {
    EXPECT_EQ(ErrorOf(Path(name), 30), "");
    EXPECT_EQ(ErrorOf(Path(name), 29), Path(name) + " would be 30x2");
    // Nothing of the pixels is needed to refuse them.
    const std::string bytes = Read(name);
    if (name != "a.npy") {
      EXPECT_EQ(ErrorOf(Write(name, bytes.substr(0, bytes.size() - 20)), 29),
                Path(name) + " would be 30x2");
    }
  }
}

TEST_F(DepthFiles, RefusesSizesThatNoMapHas) {
  std::string png(
      "\x89PNG\r\n\x1a\n\0\0\0\rIHDR\x7f\xff\xff\xff\x7f\xff\xff\xff\x10\0",
      26);
  EXPECT_NE(ErrorOf(Write("a.png", png), INT_MAX).find("damaged"),
            std::string::npos);
  EXPECT_NE(ErrorOf(Write("a.pfm", "Pf\n999999999 999999999\n-1\n"), INT_MAX)
                .find("damaged"),
            std::string::npos);
}

TEST_F(DepthFiles, RefusesExrAttributesThatAreLargerThanTheFile) {
  cv::imwrite(Path("a.exr"), Floats());
  std::string bytes = Read("a.exr");
  const size_t type = bytes.find(std::string("chlist\0", 7));
  ASSERT_NE(type, std::string::npos);
  bytes.replace(type + 7, 4, "\x66\x66\x66\x66");  // 1.7 GB.
  EXPECT_NE(ErrorOf(Write("a.exr", bytes)).find("damaged"), std::string::npos);
}

// Otherwise the size that was checked would be that of another format.
TEST_F(DepthFiles, RefusesWhatHasTheNameOfAnotherFormat) {
  cv::imwrite(Path("a.exr"), Floats());
  const std::string attributes = Read("a.exr").substr(8);
  const std::string pfm = "Pf\n3 2\n-";
  EXPECT_NE(
      ErrorOf(Write("b.exr", pfm.substr(0, 8) + attributes)).find("damaged"),
      std::string::npos);
  cv::imwrite(Path("a.pfm"), Floats());
  EXPECT_NE(ErrorOf(Write("c.exr", Read("a.pfm"))).find("damaged"),
            std::string::npos);
  // A medical image, to OpenCV.
  std::string medical = Read("a.exr");
  medical.replace(128, 4, "DICM");
  EXPECT_NE(ErrorOf(Write("d.exr", medical)).find("damaged"),
            std::string::npos);
}

// The library takes as many bytes as the type needs, and would read the rest,
// and the sizes there, as attributes. So such a header counts for nothing.
TEST_F(DepthFiles, RefusesExrAttributesOfAnotherSizeThanTheirType) {
  cv::imwrite(Path("a.exr"), Floats());
  const std::string bytes = Read("a.exr");
  // The pixels are not where they should be then, but the header is.
  const auto accepts = [&](const std::string& attribute) {
    bool was_asked = false;
    try {
      ReadDepthFile(Write("b.exr", std::string(bytes).insert(8, attribute)),
                    [&](int, int) { was_asked = true; });
    } catch (const Failure& error) {
      const std::string line = error.what();
      EXPECT_TRUE(line.find("damaged") != std::string::npos ||
                  line.find("of type preview") != std::string::npos)
          << line;
    }
    return was_asked;
  };
  EXPECT_TRUE(accepts(std::string("a\0compression\0\1\0\0\0\0", 19)));
  EXPECT_FALSE(accepts(std::string("a\0compression\0\2\0\0\0\0\0", 20)));
  EXPECT_TRUE(accepts(std::string("a\0chlist\0\1\0\0\0\0", 14)));
  EXPECT_FALSE(accepts(std::string("a\0chlist\0\2\0\0\0b\0", 15)));
  EXPECT_FALSE(
      accepts(std::string("a\0preview\0\x8\0\0\0\0\x40\0\0\0\x40\0\0", 22)));
  EXPECT_TRUE(accepts(std::string("a\0other\0\2\0\0\0bc", 14)));
}

TEST_F(DepthFiles, RefusesLongHeaders) {
  // Blanks that a search would have to pass over.
  const std::string blanks(1000000, ' ');
  std::string bytes = Npy("<f4", "(2, 3)", BytesOf(kValues), false, 2);
  const size_t size = bytes.find("{");
  bytes.insert(bytes.find("'<f4'"), blanks);
  const uint32_t header =
      static_cast<uint32_t>(bytes.size() - size - sizeof(float) * 6);
  bytes.replace(8, 4, reinterpret_cast<const char*>(&header), 4);
  EXPECT_NE(ErrorOf(Write("a.npy", bytes)).find("header"), std::string::npos);
}

TEST_F(DepthFiles, RefusesColoursAndBytes) {
  cv::imwrite(Path("a.png"), cv::Mat(2, 3, CV_8U, cv::Scalar(7)));
  EXPECT_NE(ErrorOf(Path("a.png")).find("16 bits"), std::string::npos);
  cv::imwrite(Path("b.png"), cv::Mat(2, 3, CV_16UC3, cv::Scalar(7, 8, 9)));
  EXPECT_NE(ErrorOf(Path("b.png")).find("one channel"), std::string::npos);
  cv::imwrite(Path("c.exr"), cv::Mat(2, 3, CV_32FC3, cv::Scalar(7, 8, 9)));
  EXPECT_NE(ErrorOf(Path("c.exr")).find("one channel"), std::string::npos);
}

}  // namespace
}  // namespace tapa
