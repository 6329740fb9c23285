#ifndef TAPA_SRC_UI_STEREO_PANEL_H_
#define TAPA_SRC_UI_STEREO_PANEL_H_

#include <functional>
#include <memory>
#include <string>

class QTableWidget;
class QWidget;

// This header is included by COLMAP's own sources.

namespace colmap {
namespace mvs {
class PatchMatchController;
}  // namespace mvs
}  // namespace colmap

namespace tapa {

// Makes the buttons of the table that open a view's maps; pass: as in the names
// of files.
using MapButtons = std::function<QWidget*(const std::string& image_name,
                                          const std::string& pass)>;

// Starts dense stereo and returns. A panel below the table of COLMAP's window
// for dense reconstruction tells how far it is and can stop it. Views can be
// looked at meanwhile, and get their buttons as soon as their maps are there;
// everything else in the window has to wait.
void StartStereo(QWidget* window, QTableWidget* table,
                 std::unique_ptr<colmap::mvs::PatchMatchController> stereo,
                 MapButtons map_buttons);

}  // namespace tapa

#endif  // TAPA_SRC_UI_STEREO_PANEL_H_
