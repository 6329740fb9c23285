#include "src/colmap/model_files.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <type_traits>

#include "base/camera_models.h"
#include "src/base/failure.h"
#include "src/colmap/image_name.h"
#include "src/colmap/text_files.h"
#include "util/endian.h"
#include "util/misc.h"

namespace tapa {
namespace {

using colmap::camera_t;
using colmap::image_t;
using colmap::point2D_t;
using colmap::point3D_t;

constexpr char kBlanks[] = " \t";

// What a file says of an image's points.
struct Observations {
  std::vector<Eigen::Vector2d> positions;
  // kInvalidPoint3DId: of no point.
  std::vector<point3D_t> point_ids;
};

// The number of a camera, an image or a point, unless it is the one by which
// COLMAP says that there is none.
template <typename Id>
Id CheckId(Id id, Id invalid, const char* what) {
  if (id == invalid) {
    throw Failure(std::to_string(id) + " is not the number of " + what);
  }
  return id;
}

camera_t CheckCameraId(camera_t id) {
  return CheckId(id, colmap::kInvalidCameraId, "a camera");
}

image_t CheckImageId(image_t id) {
  return CheckId(id, colmap::kInvalidImageId, "an image");
}

// Of a photograph, in pixels. Maps are not larger, either (map_files.cc).
bool IsSide(size_t pixels) { return pixels >= 1 && pixels <= 1000000; }

// Puts a model together. Throws Failure, without the name of the file, for what
// makes no sense.
class ModelBuilder {
 public:
  explicit ModelBuilder(const ModelParts& parts) : parts_(parts) {
    parts_.cameras->clear();
    parts_.images->clear();
    parts_.points->clear();
    parts_.image_ids->clear();
  }

  void Add(const colmap::Camera& camera) {
    const std::string name = "camera " + std::to_string(camera.CameraId());
    if (!camera.VerifyParams()) {
      throw Failure(
          name + " has " + std::to_string(camera.NumParams()) +
          " parameters, but its model " +
          colmap::CameraModelIdToName(camera.ModelId()) + " takes " +
          std::to_string(colmap::CameraModelNumParams(camera.ModelId())));
    }
    if (!IsSide(camera.Width()) || !IsSide(camera.Height())) {
      throw Failure(name + " has " + std::to_string(camera.Width()) + "x" +
                    std::to_string(camera.Height()) +
                    " pixels, which no photograph has");
    }
    for (const double value : camera.Params()) {
      if (!std::isfinite(value)) {
        throw Failure(name + " has a parameter that is not a finite number");
      }
    }
    if (!parts_.cameras->emplace(camera.CameraId(), camera).second) {
      throw Failure(name + " is there twice");
    }
  }

  void Add(const Eigen::Vector4d& rotation, const Eigen::Vector3d& translation,
           const Observations& observations, colmap::Image image) {
    CheckImageName(image.Name());
    const std::string name =
        "image " + std::to_string(image.ImageId()) + " (" + image.Name() + ")";
    const auto camera = parts_.cameras->find(image.CameraId());
    if (camera == parts_.cameras->end()) {
      throw Failure(name + " was taken by camera " +
                    std::to_string(image.CameraId()) +
                    ", which is not among the cameras");
    }
    if (!rotation.allFinite() || !translation.allFinite()) {
      throw Failure(name + " has a pose that is not made of finite numbers");
    }
    if (rotation.norm() == 0) {
      throw Failure(name + " has the rotation 0 0 0 0, which is none");
    }
    image.SetQvec(rotation);
    image.NormalizeQvec();
    image.SetTvec(translation);
    image.SetUp(camera->second);
    image.SetPoints2D(observations.positions);
    for (size_t i = 0; i < observations.point_ids.size(); ++i) {
      if (observations.point_ids[i] != colmap::kInvalidPoint3DId) {
        image.SetPoint3DForPoint2D(static_cast<point2D_t>(i),
                                   observations.point_ids[i]);
      }
    }
    image.SetRegistered(true);
    if (!parts_.images->emplace(image.ImageId(), image).second) {
      throw Failure(name + " is there twice");
    }
    parts_.image_ids->push_back(image.ImageId());
  }

  void Add(point3D_t id, colmap::Point3D point) {
    CheckId(id, colmap::kInvalidPoint3DId, "a point");
    const std::string name = "point " + std::to_string(id);
    for (const colmap::TrackElement& element : point.Track().Elements()) {
      if (parts_.images->count(element.image_id) == 0) {
        throw Failure(name + " is seen in image " +
                      std::to_string(element.image_id) +
                      ", which is not among the images");
      }
    }
    point.Track().Compress();
    if (!parts_.points->emplace(id, point).second) {
      throw Failure(name + " is there twice");
    }
    *parts_.max_point_id = std::max(*parts_.max_point_id, id);
  }

 private:
  const ModelParts parts_;
};

void SetModel(int model_id, colmap::Camera* camera) {
  if (!colmap::ExistsCameraModelWithId(model_id)) {
    throw Failure("there is no camera model of number " +
                  std::to_string(model_id));
  }
  camera->SetModelId(model_id);
}

// The numbers of a line.
class Fields {
 public:
  explicit Fields(const std::string& line) : line_(line) {}

  bool AtEnd() {
    SkipBlanks();
    return position_ == line_.size();
  }

  // what: what is read, for the message.
  std::string Word(const char* what) {
    SkipBlanks();
    const size_t begin = position_;
    position_ = std::min(line_.find_first_of(kBlanks, begin), line_.size());
    if (begin == position_) {
      throw Failure(std::string("the line ends where ") + what +
                    " should follow");
    }
    return line_.substr(begin, position_ - begin);
  }

  template <typename Number>
  Number Read(const char* what) {
    SkipBlanks();
    const char* begin = line_.data() + position_;
    const char* const end = line_.data() + line_.size();
    begin += begin != end && *begin == '+';
    Number number{};
    const auto result = std::from_chars(begin, end, number);
    const bool is_whole =
        result.ptr == end || *result.ptr == ' ' || *result.ptr == '\t';
    bool is_valid = is_whole && result.ec == std::errc();
    if constexpr (std::is_same_v<Number, double>) {
      // Zero or infinite, as good as.
      if (is_whole && result.ec == std::errc::result_out_of_range) {
        number = std::strtod(begin, nullptr);
        is_valid = true;
      }
    }
    if (!is_valid) {
      throw Failure("'" + Word(what).substr(0, 40) + "' is not " + what);
    }
    position_ = result.ptr - line_.data();
    return number;
  }

  Eigen::Vector3d ReadVector(const char* what) {
    Eigen::Vector3d vector;
    for (int i = 0; i < 3; ++i) {
      vector(i) = Read<double>(what);
    }
    return vector;
  }

  // See ReadTextModel.
  std::string Rest() {
    if (has_single_blanks_ && position_ < line_.size()) {
      ++position_;
    } else {
      SkipBlanks();
    }
    std::string rest = line_.substr(position_);
    position_ = line_.size();
    rest.erase(rest.find_last_not_of(kBlanks) + 1);
    if (rest.empty()) {
      throw Failure("the line ends where the name of the image should follow");
    }
    return rest;
  }

 private:
  void SkipBlanks() {
    const size_t begin = position_;
    position_ = std::min(line_.find_first_not_of(kBlanks, begin), line_.size());
    if (position_ != begin) {
      has_single_blanks_ = has_single_blanks_ && position_ == begin + 1 &&
                           line_[begin] == ' ' && begin > 0;
    }
  }

  const std::string& line_;
  size_t position_ = 0;
  bool has_single_blanks_ = true;
};

// Calls read(line) for every line that is neither empty nor a comment, and says
// where it failed. read may take further lines from the file.
template <typename Read>
void ReadLines(const std::string& path, const Read& read) {
  TextLines lines(path);
  std::string line;
  while (lines.Next(&line)) {
    const int number = lines.Number();
    const size_t begin = line.find_first_not_of(kBlanks);
    if (begin == std::string::npos || line[begin] == '#') {
      continue;
    }
    try {
      read(line, &lines);
    } catch (const Failure& error) {
      throw Failure(path + ", line " + std::to_string(number) + ": " +
                    error.what());
    }
  }
}

colmap::Camera ParseCamera(const std::string& line) {
  Fields fields(line);
  colmap::Camera camera;
  camera.SetCameraId(
      CheckCameraId(fields.Read<camera_t>("the number of a camera")));
  const std::string model = fields.Word("a camera model");
  if (!colmap::ExistsCameraModelWithName(model)) {
    throw Failure("there is no camera model '" + model + "'");
  }
  camera.SetModelIdFromName(model);
  camera.SetWidth(fields.Read<size_t>("a width in pixels"));
  camera.SetHeight(fields.Read<size_t>("a height in pixels"));
  camera.Params().clear();
  while (!fields.AtEnd()) {
    camera.Params().push_back(fields.Read<double>("a parameter of the camera"));
  }
  return camera;
}

Observations ParseObservations(const std::string& line,
                               const std::string& image_name) {
  constexpr char kWhat[] = "part of a point (X Y POINT3D_ID)";
  Observations observations;
  try {
    Fields fields(line);
    while (!fields.AtEnd()) {
      const double x = fields.Read<double>(kWhat);
      const double y = fields.Read<double>(kWhat);
      observations.positions.emplace_back(x, y);
      // -1 is kInvalidPoint3DId.
      observations.point_ids.push_back(
          static_cast<point3D_t>(fields.Read<int64_t>(kWhat)));
    }
  } catch (const Failure& error) {
    throw Failure("the next line, which lists the points of " + image_name +
                  " and is empty if there are none: " + error.what());
  }
  return observations;
}

void ParseImage(const std::string& line, TextLines* lines,
                ModelBuilder* builder) {
  Fields fields(line);
  colmap::Image image;
  image.SetImageId(
      CheckImageId(fields.Read<image_t>("the number of an image")));
  Eigen::Vector4d rotation;
  for (int i = 0; i < 4; ++i) {
    rotation(i) = fields.Read<double>("part of a rotation (QW QX QY QZ)");
  }
  const Eigen::Vector3d translation =
      fields.ReadVector("part of a translation (TX TY TZ)");
  image.SetCameraId(
      CheckCameraId(fields.Read<camera_t>("the number of a camera")));
  image.SetName(fields.Rest());
  Observations observations;
  std::string next;
  if (lines->Next(&next)) {
    observations = ParseObservations(next, image.Name());
  }
  builder->Add(rotation, translation, observations, image);
}

void ParsePoint(const std::string& line, ModelBuilder* builder) {
  Fields fields(line);
  const point3D_t id = fields.Read<point3D_t>("the number of a point");
  colmap::Point3D point;
  point.SetXYZ(fields.ReadVector("a coordinate of a point"));
  for (int i = 0; i < 3; ++i) {
    point.Color(i) =
        static_cast<uint8_t>(fields.Read<int>("a colour from 0 to 255"));
  }
  point.SetError(fields.Read<double>("an error in pixels"));
  while (!fields.AtEnd()) {
    const image_t image_id = fields.Read<image_t>("the number of an image");
    point.Track().AddElement(
        image_id, fields.Read<point2D_t>("the number of a point in an image"));
  }
  builder->Add(id, point);
}

// The values of a binary file, one after the other.
class BinaryFile {
 public:
  explicit BinaryFile(const std::string& path)
      : content_(ReadWholeFile(path)) {}

  template <typename Value>
  Value Read() {
    Require(sizeof(Value));
    Value value;
    std::memcpy(&value, content_.data() + position_, sizeof(value));
    position_ += sizeof(value);
    return colmap::LittleEndianToNative(value);
  }

  std::string ReadName() {
    const size_t end = content_.find('\0', position_);
    if (end == std::string::npos) {
      Require(content_.size());
    }
    const std::string name = content_.substr(position_, end - position_);
    position_ = end + 1;
    return name;
  }

  Eigen::Vector3d ReadVector() {
    Eigen::Vector3d vector;
    for (int i = 0; i < 3; ++i) {
      vector(i) = Read<double>();
    }
    return vector;
  }

  // A number of things that take so many bytes each.
  size_t ReadCount(size_t min_bytes) {
    const uint64_t count = Read<uint64_t>();
    if (count > (content_.size() - position_) / min_bytes) {
      Require(content_.size());
    }
    return count;
  }

 private:
  void Require(size_t num_bytes) const {
    if (content_.size() - position_ < num_bytes) {
      throw Failure("the file ends too early; it is not whole");
    }
  }

  const std::string content_;
  size_t position_ = 0;
};

// Calls read(file) for every element of a file, and says what has failed.
template <typename Read>
void ReadElements(const std::string& path, const Read& read) {
  try {
    BinaryFile file(path);
    const size_t count = file.ReadCount(1);
    for (size_t i = 0; i < count; ++i) {
      read(&file);
    }
  } catch (const Failure& error) {
    throw Failure(path + ": " + error.what());
  }
}

colmap::Camera ReadCamera(BinaryFile* file) {
  colmap::Camera camera;
  camera.SetCameraId(CheckCameraId(file->Read<camera_t>()));
  SetModel(file->Read<int>(), &camera);
  camera.SetWidth(file->Read<uint64_t>());
  camera.SetHeight(file->Read<uint64_t>());
  for (double& value : camera.Params()) {
    value = file->Read<double>();
  }
  return camera;
}

void ReadImage(BinaryFile* file, ModelBuilder* builder) {
  colmap::Image image;
  image.SetImageId(CheckImageId(file->Read<image_t>()));
  Eigen::Vector4d rotation;
  for (int i = 0; i < 4; ++i) {
    rotation(i) = file->Read<double>();
  }
  const Eigen::Vector3d translation = file->ReadVector();
  image.SetCameraId(CheckCameraId(file->Read<camera_t>()));
  image.SetName(file->ReadName());
  Observations observations;
  const size_t count = file->ReadCount(2 * sizeof(double) + sizeof(point3D_t));
  for (size_t i = 0; i < count; ++i) {
    const double x = file->Read<double>();
    const double y = file->Read<double>();
    observations.positions.emplace_back(x, y);
    observations.point_ids.push_back(file->Read<point3D_t>());
  }
  builder->Add(rotation, translation, observations, image);
}

void ReadPoint(BinaryFile* file, ModelBuilder* builder) {
  const point3D_t id = file->Read<point3D_t>();
  colmap::Point3D point;
  point.SetXYZ(file->ReadVector());
  for (int i = 0; i < 3; ++i) {
    point.Color(i) = file->Read<uint8_t>();
  }
  point.SetError(file->Read<double>());
  const size_t length = file->ReadCount(sizeof(image_t) + sizeof(point2D_t));
  for (size_t i = 0; i < length; ++i) {
    const image_t image_id = file->Read<image_t>();
    point.Track().AddElement(image_id, file->Read<point2D_t>());
  }
  builder->Add(id, point);
}

}  // namespace

void ReadTextModel(const std::string& folder, const ModelParts& parts) {
  ModelBuilder builder(parts);
  ReadLines(colmap::JoinPaths(folder, "cameras.txt"),
            [&](const std::string& line, TextLines*) {
              builder.Add(ParseCamera(line));
            });
  ReadLines(colmap::JoinPaths(folder, "images.txt"),
            [&](const std::string& line, TextLines* lines) {
              ParseImage(line, lines, &builder);
            });
  ReadLines(
      colmap::JoinPaths(folder, "points3D.txt"),
      [&](const std::string& line, TextLines*) { ParsePoint(line, &builder); });
}

void ReadBinaryModel(const std::string& folder, const ModelParts& parts) {
  ModelBuilder builder(parts);
  ReadElements(colmap::JoinPaths(folder, "cameras.bin"),
               [&](BinaryFile* file) { builder.Add(ReadCamera(file)); });
  ReadElements(colmap::JoinPaths(folder, "images.bin"),
               [&](BinaryFile* file) { ReadImage(file, &builder); });
  ReadElements(colmap::JoinPaths(folder, "points3D.bin"),
               [&](BinaryFile* file) { ReadPoint(file, &builder); });
}

}  // namespace tapa
