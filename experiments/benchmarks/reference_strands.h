#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "contract/constants.h"
#include "experiments/benchmarks/reference_kernel.h"
#include "math/instructions.h"
#include "models/strand/strand.h"
#include "simulation/run/timing.h"

/// The strands that the reference kernel advances, so that every program measures with
/// the same stick: hairs of 10 elements that fall from rest.
namespace tress::experiments::benchmarks {

constexpr int reference_elements = 10;
constexpr double reference_length = 0.2, reference_step = 1e-3;  // m, s

/// Curls that differ a little from strand to strand.
inline double curl(std::size_t k) {  // 1/m
  return 20 * (1 + 0.3 * std::sin(0.37 * static_cast<double>(k % 97)));
}

inline models::Strand reference_hair(std::size_t k) {
  models::Material material;
  material.youngs_modulus = 1e9;
  material.shear_modulus = models::Material::shear_modulus_of(1e9, 0.48);
  material.internal_friction = 1e-10;
  return make_strand(material, {},
                     {.elements = reference_elements, .length = reference_length},
                     models::uniform_shape({0, curl(k), 0}));
}

class ReferenceStrands {
 public:
  explicit ReferenceStrands(std::size_t strands)
      : blocks_(strands / reference::lanes),
        state_(blocks_ * reference_elements),
        scratch_(reference_elements) {
    const models::Strand one = reference_hair(0);
    const models::CrossSection& section = one.segments.front().section;
    const Vec moduli = stiffness(one.material, section);
    // Units of length, gravity and mass, as a Head has them.
    const double mu = one.material.density * section.area(),
                 tau2 = reference_length / earth_gravity,
                 unit = mu * std::pow(reference_length, 4) / tau2;
    strand_ = {reference_elements,
               1.0 / reference_elements,
               1,
               moduli.x / unit,
               moduli.y / unit,
               one.material.internal_friction / (unit * std::sqrt(tau2)),
               1,
               reference_step / std::sqrt(tau2)};
    for (std::size_t b = 0; b < blocks_; ++b) {
      for (std::size_t i = 0; i < reference_elements; ++i) {
        reference::State& s = state_[b * reference_elements + i];
        s = reference::State{};
        for (int lane = 0; lane < reference::lanes; ++lane) {
          s.k.y[lane] = reference_length *
                        curl(b * reference::lanes + static_cast<std::size_t>(lane));
        }
        s.rest = s.k;
      }
    }
  }
  void step() {
    by(widest_instructions(), [this] {
      for (std::size_t b = 0; b < blocks_; ++b) {
        reference::step(strand_, &state_[b * reference_elements], scratch_.data());
      }
    });
  }
  /// 1/m.
  double curvature(std::size_t strand, std::size_t element) const {
    return state_[strand / reference::lanes * reference_elements + element]
               .k.y[static_cast<int>(strand % reference::lanes)] /
           reference_length;
  }

 private:
  std::size_t blocks_;
  reference::Strand strand_{};
  std::vector<reference::State> state_;
  std::vector<reference::Record> scratch_;
};

/// Time of an element's step of the reference kernel, s.
inline double reference_time() {
  constexpr int strands = 64, steps = 40;
  ReferenceStrands kernel(strands);
  std::vector<double> times;
  for (int k = 0; k < 15; ++k) {
    times.push_back(simulation::seconds_of([&] {
      for (int s = 0; s < steps; ++s) kernel.step();
    }));
  }
  return simulation::median(times) / (steps * strands * reference_elements);
}

}  // namespace tress::experiments::benchmarks
