#ifndef TAPA_SRC_COLMAP_OPTION_ROWS_H_
#define TAPA_SRC_COLMAP_OPTION_ROWS_H_

#include <algorithm>
#include <limits>
#include <string>
#include <type_traits>

#include "src/colmap/fusion_options.h"
#include "src/colmap/host_options.h"

// This header is included by COLMAP's own sources.

namespace tapa {

// The limits of a row for an option that is a number.
inline double LowestInRow(const OptionRange& range) {
  return range.minus_one.empty() ? std::max(range.min, -1.0) : -1;
}
inline double HighestInRow(const OptionRange& range, double limit) {
  return std::min(range.max, limit);
}

template <typename Widget>
void AddOptionRow(Widget* widget, const OptionEntry& entry, bool* option) {
  widget->AddOptionBool(option, entry.name);
}
template <typename Widget>
void AddOptionRow(Widget* widget, const OptionEntry& entry, int* option) {
  widget->AddOptionInt(option, entry.name,
                       static_cast<int>(LowestInRow(entry.range)),
                       static_cast<int>(HighestInRow(
                           entry.range, std::numeric_limits<int>::max())));
}
template <typename Widget>
void AddOptionRow(Widget* widget, const OptionEntry& entry, double* option) {
  // Steps follow the value, which may be small.
  auto* box =
      widget->AddOptionDouble(option, entry.name, LowestInRow(entry.range),
                              HighestInRow(entry.range, 1e7), 0.01, 8);
  box->setStepType(std::decay_t<decltype(*box)>::AdaptiveDecimalStepType);
}
template <typename Widget>
void AddOptionRow(Widget* widget, const OptionEntry& entry,
                  std::string* option) {
  widget->AddOptionText(option, entry.name);
}

// Whether the widget has an option on the tab of TAPA.
inline bool IsTapaOption(const std::string& name) {
  return name.compare(0, 4, "tapa") == 0;
}

template <typename Widget>
void AddOptionRowsIf(bool is_tapa, Widget* widget, HostOptions* options) {
  VisitHostOptions(options,
                   [is_tapa, widget](const OptionEntry& entry, auto* option) {
                     if (IsTapaOption(entry.name) == is_tapa) {
                       AddOptionRow(widget, entry, option);
                     }
                   });
}

// Adds a row per option, without those of TAPA, to a COLMAP OptionsWidget.
template <typename Widget>
void AddOptionRows(Widget* widget, HostOptions* options) {
  AddOptionRowsIf(false, widget, options);
}

// Adds a row per option of the fusion that weighs agreement.
template <typename Widget>
void AddFusionRows(Widget* widget, FusionOptions* options) {
  VisitFusionOptions(options, [widget](const OptionEntry& entry, auto* option) {
    AddOptionRow(widget, entry, option);
  });
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
