#include "src/mvs/options.h"

namespace tapa {

void Options::Check() const {
  const auto check = [](const OptionEntry& entry, const auto* value) {
    CheckOption(entry, *value);
  };
  VisitSharedOptions(check, this);
  VisitTapaOptions(&tapa, check);
  VisitSearchOptions(&search, check);
  check({"first_perturbation", "", OptionRange::From(0, 1).WithoutMin()},
        &first_perturbation);
  check({"device", "", OptionRange::AtLeast(0).OrMinusOne("the CPU")}, &device);
  check({"num_threads", "", NumThreadsRange()}, &num_threads);
}

}  // namespace tapa
