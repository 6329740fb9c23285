#include "src/colmap/photo_formats.h"

#include <memory>

#include "src/base/failure.h"
#include "src/colmap/fatal_errors.h"
#include "src/colmap/text_files.h"
#include "util/misc.h"

namespace tapa {

FIBITMAP* LoadPicture(const std::string& path, int flags) {
  if (!colmap::ExistsFile(path)) {
    return nullptr;
  }
  // The library does not tell where reading failed.
  std::string content;
  try {
    content = ReadWholeFile(path);
  } catch (const ReadFailure&) {
    if (!IsGraphical()) {
      throw;
    }
    return nullptr;
  }
  const std::unique_ptr<FIMEMORY, decltype(&FreeImage_CloseMemory)> memory(
      FreeImage_OpenMemory(reinterpret_cast<BYTE*>(&content[0]),
                           static_cast<DWORD>(content.size())),
      &FreeImage_CloseMemory);
  FREE_IMAGE_FORMAT format = FreeImage_GetFileTypeFromMemory(memory.get(), 0);
  if (format == FIF_UNKNOWN) {
    // Some formats are known by the names of their files only.
    format = FreeImage_GetFileType(path.c_str(), 0);
  }
  return format == FIF_UNKNOWN
             ? nullptr
             : FreeImage_LoadFromMemory(format, memory.get(), flags);
}

}  // namespace tapa
