#include "experiments/hard_cases/hard_case.h"

#include "contract/input_error.h"
#include "experiments/problems/strand_models.h"
#include "experiments/problems/strand_scenes.h"
#include "models/effects/obstacle.h"
#include "models/strand/strand_parameters.h"

namespace tress::experiments::hard_cases {
namespace {

constexpr double energy_tolerance = 0.01;  // as strand_scenes.h has it
constexpr double reach_tolerance = 1e-3;   // the same

std::vector<HardCase> all_cases() {
  std::vector<HardCase> all;
  for (auto* cases : {extreme_cases, motion_cases, contact_cases, constraint_cases}) {
    for (HardCase& hard : cases()) all.push_back(std::move(hard));
  }
  return all;
}

/// Energy (J) of the strand hanging straight down from its root.
double hanging(const Situation& s) {
  const double gravity = s.parameters.number("gravity_m_s2");
  double energy = 0, below = 0;
  for (const Segment& segment : s.strand.segments) {
    const double mass =
        s.strand.material.density * segment.section.area() * segment.length;
    energy -= mass * gravity * (below + segment.length / 2);
    below += segment.length;
  }
  return energy;
}

void touch_by_impulses(const ModelSettings& settings, Situation& s) {
  for (auto& effect : s.effects) {
    if (auto obstacle = effect->obstacle()) effect = std::move(obstacle);
  }
  Parameters rubs(models::strand_friction_parameters(), "case");
  for (const auto& [key, value] : settings) rubs.set(key, value);
  s.rubbing = std::make_unique<Rubbing>(std::vector{s.strand}, rubs, s.effects);
}

}  // namespace

std::span<const HardCase> hard_case_catalogue() {
  static const std::vector<HardCase> all = all_cases();
  return all;
}

Situation situation(const HardCase& hard, const Subject& subject,
                    const Parameters& defaults) {
  Situation s{defaults, {}, {}, 0, 0, nullptr, {}, nullptr};
  set_known(s.parameters, subject.settings);
  if (subject.model->on_strand != nullptr) {
    set_known(s.parameters, hard.settings);
    s.strand = strand(s.parameters);
    if (hard.shape != nullptr) hard.shape(s.strand);
    s.effects = strand_effects(s.parameters);
    if (hard.act != nullptr) hard.act(s.strand, s.effects);
    if (hard.impulses) touch_by_impulses(*hard.impulses, s);
    s.length = s.strand.length();
    s.mass = s.strand.mass();
    s.system = subject.model->on_strand(s.strand, s.parameters, s.effects);
  } else {
    s.length = s.parameters.number("length_m");
    s.mass = s.parameters.number("mass_kg");
    s.system = subject.model->make(s.parameters);
  }
  if (hard.objection != nullptr) {
    const std::string reason = hard.objection(*s.system);
    if (!reason.empty()) {
      throw InputError(reason, "case " + std::string(hard.name),
                       "see the cases that it can have");
    }
  }
  s.start = perturbed_start(*s.system);
  if (hard.displace != nullptr) hard.displace(s, s.start);
  return s;
}

double energy_scale(const Situation& s) {
  if (s.strand.segments.empty()) {
    return s.mass * s.parameters.number("gravity_m_s2") * s.length;
  }
  const State start = initial_state(*s.system);
  return s.system->energetics()->energy(0, start.q, start.v).total() - hanging(s);
}

StabilityBounds passive_bounds(const Situation& s, double) {
  return {.energy = energy_tolerance * energy_scale(s)};
}

StabilityBounds driven_bounds(const Situation& s, double t_end) {
  return {.reach = (1 + reach_tolerance) * s.length,
          .speed = strand_speed_bound(s.parameters, t_end)};
}

StabilityBounds no_bounds(const Situation&, double) { return {}; }

}  // namespace tress::experiments::hard_cases
