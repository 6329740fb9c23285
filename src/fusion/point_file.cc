#include "src/fusion/point_file.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstdlib>
#include <cstring>

#include "src/base/failure.h"
#include "src/base/read_at.h"
#include "src/fusion/fused_cloud.h"

namespace tapa {
namespace {

// Some file systems, such as NFS, have no files without a name: there it loses
// its name at once.
int OpenNameless(const std::string& folder) {
  const int file =
      open(folder.c_str(), O_TMPFILE | O_RDWR | O_EXCL | O_CLOEXEC, 0600);
  if (file >= 0) {
    return file;
  }
  std::string path = folder + "/points.part-XXXXXX";
  const int named = mkostemp(path.data(), O_CLOEXEC);
  if (named >= 0) {
    unlink(path.c_str());
  }
  return named;
}

}  // namespace

PointFile::PointFile(const std::string& folder)
    : folder_(folder), file_(OpenNameless(folder)) {}

PointFile::~PointFile() {
  if (file_ >= 0) {
    close(file_);
  }
}

size_t PointFile::Append(const FusedPoint* points, size_t count) {
  const char* bytes = reinterpret_cast<const char*>(points);
  const size_t size = count * sizeof(FusedPoint);
  for (size_t done = 0; done < size;) {
    const auto at = static_cast<off_t>(num_points_ * sizeof(FusedPoint) + done);
    const ssize_t written = pwrite(file_, bytes + done, size - done, at);
    if (written > 0) {
      done += static_cast<size_t>(written);
    } else if (written == 0 || errno != EINTR) {
      Fail("written to", written == 0 ? ENOSPC : errno);
    }
  }
  num_points_ += count;
  return num_points_ - count;
}

void PointFile::Read(size_t begin, size_t count, FusedPoint* points) const {
  const size_t size = count * sizeof(FusedPoint);
  const int64_t num_read =
      ReadAt(file_, points, size, begin * sizeof(FusedPoint));
  if (num_read != static_cast<int64_t>(size)) {
    Fail("read from", num_read < 0 ? errno : EIO);
  }
}

void PointFile::Fail(const char* what, int error) const {
  throw Failure("Points that memory should not hold cannot be " +
                std::string(what) + " a file in " + folder_ + ": " +
                std::strerror(error) +
                "; see to it that there is room, or raise "
                "--StereoFusion.agreement_cache_size, which limits them, too");
}

}  // namespace tapa
