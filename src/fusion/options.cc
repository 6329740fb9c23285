#include "src/fusion/options.h"

namespace tapa {

void CheckFusionOptions(const FusionOptions& options) {
  VisitFusionOptions(&options, [](const OptionEntry& entry, const auto* value) {
    CheckOption(entry, *value);
  });
}

}  // namespace tapa
