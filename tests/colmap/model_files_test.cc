#include "src/colmap/model_files.h"

#include <gtest/gtest.h>

#include <fstream>

#include "base/reconstruction.h"
#include "src/base/failure.h"
#include "src/colmap/text_files.h"
#include "tests/colmap/test_folder.h"

namespace tapa {
namespace {

constexpr char kCameras[] = "# comment\n3 PINHOLE 640 480 500 500 320 240\n";
constexpr char kImages[] =
    "7 1 0 0 0 0.5 0 0 3 first view.jpg\n"
    "10 20 1 30 40 -1\n"
    "8 1 0 0 0 -0.5 0 0 3 second.jpg\n"
    "\n";
constexpr char kPoints[] = "1 0.1 0.2 4 255 0 9 0.5 7 0 8 0\n";

class ModelFiles : public testing::Test {
 protected:
  void Write(const std::string& name, const std::string& text) {
    std::ofstream(folder_.Path(name), std::ios::binary) << text;
  }

  void WriteModel() {
    Write("cameras.txt", kCameras);
    Write("images.txt", kImages);
    Write("points3D.txt", kPoints);
  }

  colmap::Reconstruction ReadText() {
    colmap::Reconstruction model;
    model.ReadText(folder_.Path(""));
    return model;
  }

  // What is wrong with the model in the folder.
  std::string Error(bool is_text = true) {
    try {
      colmap::Reconstruction model;
      is_text ? model.ReadText(folder_.Path(""))
              : model.ReadBinary(folder_.Path(""));
      return "";
    } catch (const Failure& error) {
      return error.what();
    }
  }

  const TestFolder folder_;
};

TEST_F(ModelFiles, ReadsText) {
  WriteModel();
  const colmap::Reconstruction model = ReadText();
  EXPECT_EQ(model.RegImageIds(), (std::vector<colmap::image_t>{7, 8}));
  EXPECT_EQ(model.Camera(3).Width(), 640);
  const colmap::Image& image = model.Image(7);
  EXPECT_EQ(image.Name(), "first view.jpg");
  EXPECT_EQ(image.Tvec(0), 0.5);
  ASSERT_EQ(image.NumPoints2D(), 2);
  EXPECT_EQ(image.Point2D(1).X(), 30);
  EXPECT_EQ(image.Point2D(0).Point3DId(), 1);
  EXPECT_FALSE(image.Point2D(1).HasPoint3D());
  EXPECT_EQ(model.Point3D(1).XYZ(), Eigen::Vector3d(0.1, 0.2, 4));
  EXPECT_EQ(model.Point3D(1).Track().Length(), 2);
}

TEST_F(ModelFiles, BinaryIsTheSame) {
  WriteModel();
  const colmap::Reconstruction model = ReadText();
  model.WriteBinary(folder_.Path(""));
  colmap::Reconstruction binary;
  binary.ReadBinary(folder_.Path(""));
  EXPECT_EQ(binary.NumRegImages(), 2);
  EXPECT_EQ(binary.Camera(3).Params(), model.Camera(3).Params());
  for (const colmap::image_t id : model.RegImageIds()) {
    EXPECT_EQ(binary.Image(id).Name(), model.Image(id).Name());
    EXPECT_EQ(binary.Image(id).Qvec(), model.Image(id).Qvec());
    EXPECT_EQ(binary.Image(id).Tvec(), model.Image(id).Tvec());
    EXPECT_EQ(binary.Image(id).NumPoints2D(), model.Image(id).NumPoints2D());
    EXPECT_EQ(binary.Image(id).NumPoints3D(), model.Image(id).NumPoints3D());
  }
  EXPECT_EQ(binary.Point3D(1).XYZ(), model.Point3D(1).XYZ());
  EXPECT_EQ(binary.Point3D(1).Color(), model.Point3D(1).Color());
  EXPECT_EQ(binary.Point3D(1).Track().Length(), 2);
}

TEST_F(ModelFiles, ReadsWhatEditorsMake) {
  Write("cameras.txt",
        "\xef\xbb\xbf"
        "3\tPINHOLE  640 480 500 500 320 240 \r\n");
  Write("images.txt",
        "\xef\xbb\xbf# comment\r\n7  1 0 0 0  +0.5 0 0  3   a b.jpg \r\n\r\n"
        "8 1 0 0 0 1e-400 0 0 3  c.jpg");
  Write("points3D.txt", "");
  const colmap::Reconstruction model = ReadText();
  EXPECT_EQ(model.Image(7).Name(), "a b.jpg");
  EXPECT_EQ(model.Image(7).Tvec(0), 0.5);
  // Single blanks stand before it: the second one is part of the name.
  EXPECT_EQ(model.Image(8).Name(), " c.jpg");
}

TEST_F(ModelFiles, NamesWhatIsWrong) {
  const struct {
    const char* file;
    const char* text;
    const char* error;
  } kCases[] = {
      {"cameras.txt", "1 PINHOLE 640 x", "cameras.txt, line 1: 'x' is not"},
      {"cameras.txt", "1 PINHOLE 640", "the line ends where a height"},
      {"cameras.txt", "1 PINHOLE 640 480 500 500 320", "takes 4"},
      {"cameras.txt", "1 PINHOLE 640 480 500 500 320 nan", "finite"},
      {"cameras.txt", "1 NONE 640 480 500", "no camera model 'NONE'"},
      {"images.txt", "7 1 0 0 0 0 0 0 5 a.jpg\n\n", "camera 5"},
      {"images.txt", "7 1 0 0 0 nan 0 0 3 a.jpg\n\n", "finite"},
      {"images.txt", "7 1 0 0 0 0 1e999 0 3 a.jpg\n\n", "finite"},
      {"images.txt", "7 0 0 0 0 0 0 0 3 a.jpg\n\n", "rotation"},
      {"images.txt", "7 1 0 0 0 0 0 0 3\n\n", "name of the image"},
      {"images.txt", "7 1 0 0 0 0 0 0 3 ../a.jpg\n\n", "'../a.jpg'"},
      // Numbers by which COLMAP says that there is none, on which it aborts.
      {"images.txt", "7 1 0 0 0 0 0 0 4294967295 a.jpg\n\n", "4294967295"},
      {"images.txt", "4294967295 1 0 0 0 0 0 0 3 a.jpg\n\n", "4294967295"},
      {"cameras.txt", "4294967295 PINHOLE 640 480 500 500 320 240\n",
       "4294967295"},
      {"points3D.txt", "18446744073709551615 0 0 1 9 9 9 0.5 7 0\n",
       "18446744073709551615"},
      {"cameras.txt", "3 PINHOLE 0 480 500 500 320 240\n", "0x480"},
      {"cameras.txt", "3 PINHOLE 4294967297 480 500 500 320 240\n",
       "4294967297x480"},
      {"images.txt", "7 1 0 0 0 0 0 0 3 a.jpg\n\n7 1 0 0 0 0 0 0 3 b.jpg\n\n",
       "twice"},
      {"images.txt", "7 1 0 0 0 0 0 0 3 a.jpg\n8 1 0 0 0 0 0 0 3 b.jpg\n",
       "the next line, which lists the points of a.jpg"},
      {"points3D.txt", "1 0 0 1 9 9 9 0.5 70 0", "image 70"},
      {"points3D.txt", "1 0 0 1 9 9 9 0.5 7", "the line ends"},
  };
  for (const auto& test : kCases) {
    WriteModel();
    Write(test.file, test.text);
    const std::string error = Error();
    EXPECT_NE(error.find(folder_.Path(test.file)), std::string::npos) << error;
    EXPECT_NE(error.find(test.error), std::string::npos) << error;
  }
}

TEST_F(ModelFiles, RefusesBinaryFilesThatEndTooEarly) {
  WriteModel();
  ReadText().WriteBinary(folder_.Path(""));
  for (const char* name : {"cameras.bin", "images.bin", "points3D.bin"}) {
    const std::string whole = ReadWholeFile(folder_.Path(name));
    for (size_t size = 0; size < whole.size(); ++size) {
      Write(name, whole.substr(0, size));
      EXPECT_NE(Error(/* is_text */ false).find(name), std::string::npos)
          << name << " of " << size << " bytes";
    }
    Write(name, whole);
  }
  EXPECT_EQ(Error(/* is_text */ false), "");
}

TEST_F(ModelFiles, RefusesFilesThatAreNotThere) {
  EXPECT_NE(Error().find("cameras.txt"), std::string::npos);
}

}  // namespace
}  // namespace tapa
