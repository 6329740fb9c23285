#ifndef TAPA_SRC_COLMAP_DISPLAY_H_
#define TAPA_SRC_COLMAP_DISPLAY_H_

// This header is included by COLMAP's own sources.

namespace tapa {

// Whether COLMAP's GPU code for features, which needs a window and OpenGL, can
// be used; says so if not. Tries in a process of its own, since Qt ends the
// program where there is no display, whatever the environment says.
bool CanUseOpenGl();

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_DISPLAY_H_
