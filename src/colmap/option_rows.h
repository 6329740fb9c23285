#ifndef TAPA_SRC_COLMAP_OPTION_ROWS_H_
#define TAPA_SRC_COLMAP_OPTION_ROWS_H_

#include <limits>
#include <string>

#include "tapa/host_options.h"

// This header is included by COLMAP's own sources.

namespace tapa {

template <typename Widget>
void AddOptionRow(Widget* widget, const std::string& name, bool* option) {
  widget->AddOptionBool(option, name);
}
template <typename Widget>
void AddOptionRow(Widget* widget, const std::string& name, int* option) {
  widget->AddOptionInt(option, name, -1, std::numeric_limits<int>::max());
}
template <typename Widget>
void AddOptionRow(Widget* widget, const std::string& name, double* option) {
  widget->AddOptionDouble(option, name, -1, 1e7, 0.01, 5);
}
template <typename Widget>
void AddOptionRow(Widget* widget, const std::string& name,
                  std::string* option) {
  widget->AddOptionText(option, name);
}

// Adds a row per option to a COLMAP OptionsWidget.
template <typename Widget>
void AddOptionRows(Widget* widget, HostOptions* options) {
  options->Visit([widget](const std::string& name, auto option,
                          const std::string& /* help */) {
    AddOptionRow(widget, name, option);
  });
}

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_OPTION_ROWS_H_
