#include "experiments/validation/rods/motion.h"

#include <algorithm>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>

#include "contract/forms/energetics.h"
#include "contract/input_error.h"
#include "experiments/problems/formulations.h"
#include "experiments/validation/rods/rod.h"
#include "models/effects/gravity.h"
#include "simulation/run/simulation.h"

namespace tress::experiments::validation {
namespace {

/// Records the lowest of the points passed to its potential; exerts no force.
class LowestPoint final : public Effect {
 public:
  std::string_view name() const override { return "lowest_point"; }
  Needs needs() const override { return {}; }
  void add_load(double, const Points&, InOut) const noexcept override {}
  void add_derivatives(double, const Points&, double, double,
                       InOut) const noexcept override {}
  double potential(double, const Points& p) const noexcept override {
    for (std::size_t i = 0; i < p.length.size(); ++i) {
      if (p.length[i] > 0) z_ = std::min(z_, p.x[3 * i + 2]);
    }
    return 0;
  }
  double power(double, const Points&) const noexcept override { return 0; }
  double z() const { return z_; }

 private:
  mutable double z_ = std::numeric_limits<double>::infinity();
};

}  // namespace

Effects weight() { return {std::make_shared<Gravity>(Vec{0, 0, -earth_gravity})}; }

double lowest_point(const ModelVariant& variant, const Strand& strand) {
  const auto lowest = std::make_shared<LowestPoint>();
  const auto system = on_strand(variant, strand, {lowest});
  const State start = initial_state(*system);
  (void)system->energetics()->energy(0, start.q, start.v);
  return lowest->z();
}

std::string no_twist(const ModelVariant& variant) {
  TestRod rod;
  constexpr double twist = 1;  // 1/m
  rod.initial = uniform_shape({twist, 0, 0});
  const auto system = on_strand(variant, rod.strand(4, horizontal_clamp()), {});
  const State start = initial_state(*system);
  const double energy = system->energetics()->energy(0, start.q, start.v).potential;
  const double expected = rod.twisting() * twist * twist * rod.length / 2;
  return energy > expected / 2 ? "" : "no twist";
}

Track track(std::string_view integrator, System& system, double dt, double t_end,
            const Look& look, const std::function<bool(double value)>& enough) {
  const auto formulations = usable_formulations(find_integrator(integrator), system);
  if (formulations.empty()) {
    throw InputError("cannot drive this model", std::string(integrator),
                     "use another integrator");
  }
  Options options;
  options.formulation = formulations.front();
  options.step = dt;
  Track seen;
  bool stopped = false;
  const Observer each_step = [&](double t, In q, In v) {
    seen.t.push_back(t);
    seen.value.push_back(look(t, q, v));
    stopped = enough && enough(seen.value.back());
    return !stopped;
  };
  const State start = initial_state(system);
  system.reset();
  each_step(0, start.q, start.v);
  const Simulation run = simulate(integrator, system, options, start, t_end, each_step);
  if (run.status != Status::ok && !stopped) throw std::runtime_error(run.failure);
  return seen;
}

Look place(System& system, int point, int axis) {
  MaterialPoints& points = *system.material_points();
  const int i = point < 0 ? points.count() + point : point;
  const auto at = static_cast<std::size_t>(3 * i + axis);
  return [&points, at,
          x = std::vector<double>(3 * static_cast<std::size_t>(points.count()))](
             double t, In q, In) mutable {
    points.positions(t, q, x);
    return x[at];
  };
}

Look kinetic(System& system) {
  return [&system](double t, In q, In v) {
    return system.energetics()->energy(t, q, v).kinetic;
  };
}

}  // namespace tress::experiments::validation
