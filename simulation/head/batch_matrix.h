#pragma once

#include <string>
#include <string_view>

#include "integrators/catalogue.h"
#include "models/catalogue.h"

namespace tress::simulation {

/// Support of a model's strands as one batch, with an integrator and effects.
struct BatchCase {
  /// Support of the strands as a batch.
  enum class Way {
    none,        // the integrator does not drive the model
    lanes,       // in SIMD lanes
    replicated,  // each as a system of its own (ReplicatedHead)
    refused      // they are no batch
  };
  Way way = Way::none;      // how strands run
  std::string scene = {};   // a small one, as text; empty: none
  std::string reason = {};  // why there are no lanes, or no batch
};

/// `effects`: tables of effects of a scene. Options of the model are those by default,
/// but for the Jacobian approximation that lanes need; the formulation is the first that
/// the integrator has for the model.
BatchCase batch_case(const ModelEntry& model, const IntegratorEntry& integrator,
                     std::string_view effects);

/// Returns the table of supported batches: models by integrators, and effects where there
/// are lanes, with the reasons that the program itself prints.
std::string batch_matrix();

}  // namespace tress::simulation
