#ifndef TAPA_SRC_FUSION_POINT_FILE_H_
#define TAPA_SRC_FUSION_POINT_FILE_H_

#include <cstddef>
#include <string>

namespace tapa {

struct FusedPoint;

// Points that are more than memory should hold: a file without a name, which is
// gone when the program ends, however it does.
class PointFile {
 public:
  // folder: where there is room.
  explicit PointFile(const std::string& folder);
  ~PointFile();
  PointFile(const PointFile&) = delete;
  PointFile& operator=(const PointFile&) = delete;

  // Whether the folder can have one.
  bool IsOpen() const { return file_ >= 0; }
  // Returns at which number of points it begins. Throws Failure if there is no
  // room.
  size_t Append(const FusedPoint* points, size_t count);
  // Throws Failure if it cannot be read.
  void Read(size_t begin, size_t count, FusedPoint* points) const;

 private:
  [[noreturn]] void Fail(const char* what, int error) const;

  const std::string folder_;
  int file_ = -1;
  size_t num_points_ = 0;
};

}  // namespace tapa

#endif  // TAPA_SRC_FUSION_POINT_FILE_H_
