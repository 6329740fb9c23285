#ifndef TAPA_SRC_COLMAP_PASS_H_
#define TAPA_SRC_COLMAP_PASS_H_

namespace tapa {

// The two passes of stereo: the geometric one starts from the result of the
// photometric one.
enum class Pass { kPhotometric, kGeometric };

// As in the names of files.
inline const char* PassName(Pass pass) {
  return pass == Pass::kGeometric ? "geometric" : "photometric";
}

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_PASS_H_
