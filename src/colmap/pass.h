#ifndef TAPA_SRC_COLMAP_PASS_H_
#define TAPA_SRC_COLMAP_PASS_H_

namespace tapa {

// The kinds of maps, each made by a pass over all views: geometric ones from
// the photometric ones of their level. With TAPA's consensus
// (src/mvs/tapa/consensus.h) what the geometric pass of full size makes is a
// draft, and views judge each other's drafts to make the geometric maps.
enum class Pass { kPhotometric, kDraft, kGeometric };

// Whether maps of a pass at a level (src/mvs/levels.h) are there for the user
// when the run is over.
inline bool IsResult(Pass pass, int level) {
  return level == 0 && pass != Pass::kDraft;
}

// As in the names of files.
inline const char* PassName(Pass pass) {
  switch (pass) {
    case Pass::kPhotometric:
      return "photometric";
    case Pass::kDraft:
      return "draft";
    default:
      return "geometric";
  }
}

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_PASS_H_
