#include "src/colmap/tapa_debug.h"

#include <unistd.h>

#include "src/base/atomic_file.h"
#include "src/pictures/image_io.h"
#include "util/misc.h"

namespace tapa {
namespace {

std::string PathOf(const std::string& folder, const std::string& picture) {
  return colmap::JoinPaths(folder, picture + ".png");
}

}  // namespace

std::string PictureFolder(const std::string& tapa_debug,
                          const std::string& view) {
  return colmap::JoinPaths(tapa_debug, view);
}

// The last one is written last.
bool HasTapaPictures(const std::string& folder) {
  return colmap::ExistsFile(PathOf(folder, TapaPictureNames().back()));
}

void RemoveTapaPictures(const std::string& folder) {
  for (const std::string& name : TapaPictureNames()) {
    unlink(PathOf(folder, name).c_str());
  }
}

bool WriteTapaPictures(const std::vector<NamedPicture>& pictures,
                       const std::string& folder,
                       const std::function<bool()>& stopped) {
  for (const NamedPicture& picture : pictures) {
    if (stopped()) {
      return false;
    }
    const std::vector<unsigned char> bytes = EncodePng(picture.image);
    AtomicFile file(PathOf(folder, picture.name));
    file.Write(bytes.data(), bytes.size());
    file.Commit();
  }
  return true;
}

}  // namespace tapa
