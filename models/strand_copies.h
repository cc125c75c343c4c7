#pragma once

#include "contract/jacobian_choice.h"
#include "models/entry.h"

namespace tress::models {

/// Makes a system of four copies of a strand, whose residual costs little more than that
/// of one: for several states of the strand. Null where the model or its options have
/// none.
inline std::unique_ptr<System> strand_copies(const ModelEntry& model,
                                             const Strand& strand, Parameters options,
                                             const Effects& effects) {
  constexpr std::size_t count = 4;
  if (model.on_strands == nullptr) return nullptr;
  // Batches have the elastic Jacobian; the residual is that of any.
  if (options.knows(jacobian_parameter.name)) {
    options.set(jacobian_parameter.name, "elastic");
  }
  const std::vector<Strand> strands(count, strand);
  return model.on_strands(strands, options, std::vector<Effects>(count, effects));
}

}  // namespace tress::models
