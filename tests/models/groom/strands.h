#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "contract/system.h"
#include "models/catalogue.h"
#include "models/strand/strand_parameters.h"

/// Short soft strands with free roots, of any model.
namespace tress::testing_support {

using namespace models;

struct FreeStrand {
  Vec at{}, velocity{};
  Frame frame{};          // its e0 is the strand's direction
  double radius = 40e-6;  // m
  double modulus = 1e6;   // Pa
  std::string root = "free";
};

inline std::unique_ptr<System> make_strand_of(std::string_view model,
                                              const FreeStrand& free,
                                              Effects effects = {}) {
  const ModelEntry& entry = find_model(model);
  Parameters parameters(setup_parameters(entry), "model " + std::string(model));
  const auto set = [&](const char* key, double value) {
    parameters.set(key, std::to_string(value));
  };
  set("length_m", 0.05);
  set("elements", 5);
  set("radius_m", free.radius);
  set("youngs_modulus_pa", free.modulus);
  if (free.root == "free") parameters.set("motion", free.root);
  Strand strand = models::strand(parameters);
  if (strand.free_root) {
    strand.free_root = FreeRoot{free.at, free.frame, free.velocity, {}};
  } else {
    strand.root.position = free.at;
    strand.root.frame = free.frame;
  }
  return entry.on_strand(strand, parameters, std::move(effects));
}

}  // namespace tress::testing_support
