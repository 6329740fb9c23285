#ifndef TAPA_SRC_COLMAP_OPTION_ROWS_H_
#define TAPA_SRC_COLMAP_OPTION_ROWS_H_

#include <limits>
#include <string>
#include <type_traits>

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
  // Steps follow the value, which may be small.
  auto* box = widget->AddOptionDouble(option, name, -1, 1e7, 0.01, 8);
  box->setStepType(std::decay_t<decltype(*box)>::AdaptiveDecimalStepType);
}
template <typename Widget>
void AddOptionRow(Widget* widget, const std::string& name,
                  std::string* option) {
  widget->AddOptionText(option, name);
}

// Whether the widget has an option on the tab of TAPA.
inline bool IsTapaOption(const std::string& name) {
  return name.compare(0, 4, "tapa") == 0;
}

template <typename Widget>
void AddOptionRowsIf(bool is_tapa, Widget* widget, HostOptions* options) {
  options->Visit([is_tapa, widget](const std::string& name, auto option,
                                   const std::string& /* help */) {
    if (IsTapaOption(name) == is_tapa) {
      AddOptionRow(widget, name, option);
    }
  });
}

// Adds a row per option, without those of TAPA, to a COLMAP OptionsWidget.
template <typename Widget>
void AddOptionRows(Widget* widget, HostOptions* options) {
  AddOptionRowsIf(false, widget, options);
}

// Makes a COLMAP OptionsWidget with the options of TAPA, which are too many for
// the tab of stereo. The parent owns it.
template <typename Widget, typename Parent>
Widget* NewTapaTab(Parent* parent, HostOptions* options) {
  Widget* widget = new Widget(parent);
  AddOptionRowsIf(true, widget, options);
  return widget;
}

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_OPTION_ROWS_H_
