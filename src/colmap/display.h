#ifndef TAPA_SRC_COLMAP_DISPLAY_H_
#define TAPA_SRC_COLMAP_DISPLAY_H_

#include <cstdlib>
#include <iostream>

// This header is included by COLMAP's own sources.

namespace tapa {

// Whether a window could be opened, which COLMAP's GPU code for features needs;
// says so if not.
inline bool HasDisplay() {
  for (const char* name : {"DISPLAY", "WAYLAND_DISPLAY", "QT_QPA_PLATFORM"}) {
    const char* value = std::getenv(name);
    if (value != nullptr && *value != '\0') {
      return true;
    }
  }
  std::cout << "There is no display: the CPU is used." << std::endl;
  return false;
}

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_DISPLAY_H_
