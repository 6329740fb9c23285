#ifndef TAPA_SRC_COLMAP_PHOTO_FORMATS_H_
#define TAPA_SRC_COLMAP_PHOTO_FORMATS_H_

#include <FreeImage.h>

#include <string>

// This header is included by COLMAP's own sources.

namespace tapa {

// COLMAP knows 8 bits per channel: photographs of 16, in grey or in colour, are
// reduced to these. Takes the bitmap over, and returns it if it is of another
// kind; nothing if it cannot be converted.
inline FIBITMAP* ReduceTo8Bits(FIBITMAP* bitmap) {
  if (bitmap == nullptr) {
    return nullptr;
  }
  FIBITMAP* reduced = nullptr;
  switch (FreeImage_GetImageType(bitmap)) {
    case FIT_UINT16:
      reduced = FreeImage_ConvertTo8Bits(bitmap);
      break;
    case FIT_RGB16:
    case FIT_RGBA16:
      reduced = FreeImage_ConvertTo24Bits(bitmap);
      break;
    default:
      return bitmap;
  }
  FreeImage_Unload(bitmap);
  return reduced;
}

// Decodes a file. Returns nothing if it is no picture, or a damaged one. Throws
// ReadFailure, but not in the graphical interface: a photograph that cannot be
// read is not to be left out, as those are.
FIBITMAP* LoadPicture(const std::string& path, int flags = 0);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_PHOTO_FORMATS_H_
