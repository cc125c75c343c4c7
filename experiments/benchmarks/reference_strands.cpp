// Apart, so that the stick is as long in every program: how much of it the compiler
// inlines would depend on what else stands in a benchmark's source.
#include "experiments/benchmarks/reference_strands.h"

#include <cmath>

#include "contract/constants.h"
#include "math/instructions.h"
#include "simulation/run/timing.h"

namespace tress::experiments::benchmarks {

ReferenceStrands::ReferenceStrands(std::size_t strands)
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

void ReferenceStrands::step() {
  by(widest_instructions(), [this] {
    for (std::size_t b = 0; b < blocks_; ++b) {
      reference::step(strand_, &state_[b * reference_elements], scratch_.data());
    }
  });
}

double reference_time() {
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
