#ifndef TAPA_SRC_COLMAP_WORKER_CHECKS_H_
#define TAPA_SRC_COLMAP_WORKER_CHECKS_H_

#include "src/colmap/stereo_plan.h"
#include "src/colmap/views_record.h"

namespace tapa {

// What a worker (run_part.h) makes sure of before it computes its share of a
// pass.

// That it computes with the options and from the files that the run was
// prepared with, as all other workers do. inputs: of the views to compute.
// Throws Failure.
void CheckPreparation(const StereoPlan& plan, const PassPlan& pass,
                      const ViewsRecord& inputs);

// That the maps are there that it starts from. Throws Failure.
void CheckStepBefore(const StereoPlan& plan, const PassPlan& pass,
                     const PassPlan& before);

}  // namespace tapa

#endif  // TAPA_SRC_COLMAP_WORKER_CHECKS_H_
