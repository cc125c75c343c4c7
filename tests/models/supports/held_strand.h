#pragma once

#include <memory>
#include <string>
#include <vector>

#include "models/motion/signals.h"
#include "models/supports/supported_system.h"
#include "tests/models/reduced/strand_cases.h"

/// Strands of the catalogue on supports.
namespace tress::testing_support {

/// A support of a point at `place` (m) that moves by `way` (m) from 0 to `time` (s).
inline Support support(int point, Vec place, Vec way = {}, double time = 1) {
  Support made;
  made.point = point;
  made.path.position = place;
  if (norm(way) > 0) {
    made.path.translations.push_back({way, rests({0, time}, {0, 1})});
  }
  return made;
}

/// Places of the points of a system at its initial state.
inline std::vector<Vec> places_at_start(System& system) {
  MaterialPoints& points = *system.material_points();
  std::vector<double> q = zeros(system), v = q,
                      x(3 * static_cast<std::size_t>(points.count()));
  system.initial_state(q, v);
  points.positions(0, q, x);
  std::vector<Vec> places;
  for (std::size_t i = 0; i < x.size(); i += 3) places.push_back(load3(&x[i]));
  return places;
}

/// A clamp, or another support of a section, of the last point of a model at its place
/// and frame at the start. It moves by `way` in `time`.
inline Support clamp_of_tip(System& system, const std::string& model,
                            const ModelSettings& settings,
                            HeldPart part = HeldPart::frame, Vec way = {},
                            double time = 1) {
  const std::vector<Vec> x = places_at_start(system);
  const int tip = static_cast<int>(x.size()) - 1;
  Support made = support(tip, x.back(), way, time);
  made.section = part;
  std::vector<double> q = zeros(system), v = q;
  system.initial_state(q, v);
  made.path.frame = sections(system)->section(0, q, v, v, tip).frame;
  const Strand of = models::strand(parameters_of(model, settings));
  made.half_edge = rod_joint(of, nullptr, of.segments.back(), {});
  return made;
}

/// A model whose last point is held where it begins, and moves by `way` in `time`.
inline std::unique_ptr<SupportedSystem> held_at_tip(const std::string& model,
                                                    const ModelSettings& settings,
                                                    Vec way = {}, double time = 1) {
  auto strand = make_model(model, settings);
  const std::vector<Vec> x = places_at_start(*strand);
  return std::make_unique<SupportedSystem>(
      std::move(strand),
      std::vector{support(static_cast<int>(x.size()) - 1, x.back(), way, time)});
}

}  // namespace tress::testing_support
