#include <cmath>
#include <numbers>

#include "contract/basics.h"
#include "example.h"
#include "models/effects/place.h"

namespace example {
namespace {

using namespace tress;
using namespace tress::models;

/// The torque of a uniform magnetic field on a strand that is magnetised along its
/// tangent t, with the magnetic moment M per length. An effect exerts forces on points,
/// not torques on sections. The energy of the field shows which forces do the work of the
/// torque M t x B per length: with the tip x_1 and the root x_0,
///
///     E = -M int t.B ds = -M B.(x_1 - x_0),   so the tip bears M B, the root -M B.
///
/// The field turns about an axis, by B'. The power is dE/dt at fixed places.
class MagneticRod final : public Effect {
 public:
  /// Numbers of the scene.
  struct Settings {
    double moment = 0;  // M, A m
    Vec field;          // B at t = 0, T
    Vec axis;           // of any length
    double turns = 0;   // 1/s
  };
  explicit MagneticRod(const Settings& settings) : s_(settings) {
    if (const double size = norm(s_.axis); size > 0) s_.axis = (1 / size) * s_.axis;
  }

  std::string_view name() const override { return "magnetic_rod"; }
  Needs needs() const override { return {.position = s_.turns != 0}; }
  void add_load(double t, const Points& p, InOut f) const noexcept override {
    const Vec force = s_.moment * field(t);
    add(shares_of_place(p, 1), force, f);
    add(shares_of_place(p, 0), -1.0 * force, f);
  }
  void add_derivatives(double, const Points&, double, double,
                       InOut) const noexcept override {}
  double potential(double t, const Points& p) const noexcept override {
    return -s_.moment * dot(field(t), span(p));
  }
  double power(double t, const Points& p) const noexcept override {
    if (s_.turns == 0) return 0;
    const Vec rate = (2 * std::numbers::pi * s_.turns) * cross(s_.axis, field(t));
    return -s_.moment * dot(rate, span(p));
  }

 private:
  Vec field(double t) const {
    const double angle = 2 * std::numbers::pi * s_.turns * t;
    return angle == 0 ? s_.field : rotation(s_.axis, angle) * s_.field;
  }
  static Vec span(const Points& p) {
    return shares_of_place(p, 1).mean(p.x) - shares_of_place(p, 0).mean(p.x);
  }
  static void add(const PlaceShares& place, const Vec& force, InOut f) {
    for (std::size_t k = 0; k < place.count; ++k) {
      double* const load = &f[3 * (place.first + k)];
      store3(load3(load) + place.weight[k] * force, load);
    }
  }

  Settings s_;
};

constexpr Parameter magnet_parameters[] = {
    {.name = "moment_a_m",
     .help = "magnetic moment per length along the tangent (A m)",
     .number = 0.1,
     .min = -1e6,
     .max = 1e6},
    {.name = "field_t",
     .help = "magnetic field at t = 0 (T)",
     .min = -1e3,
     .max = 1e3,
     .components = 3,
     .fallback = "0,0,0.05"},
    {.name = "axis",
     .help = "axis about which the field turns, of any length",
     .min = -1e6,
     .max = 1e6,
     .components = 3,
     .fallback = "0,1,0"},
    {.name = "turns_hz",
     .help = "turns of the field per second (1/s)",
     .number = 0,
     .min = -1e6,
     .max = 1e6},
};

}  // namespace

EffectEntry magnetic_rod_entry() {
  return {.id = "magnetic_rod",
          .summary = "torque of a uniform magnetic field on a magnetised strand",
          .source = "Wang et al. 2020",
          .parameters = magnet_parameters,
          .make = [](const Parameters& p, const RootMotion&) {
            return std::unique_ptr<const Effect>(std::make_unique<MagneticRod>(
                MagneticRod::Settings{p.number("moment_a_m"), p.vec("field_t"),
                                      p.vec("axis"), p.number("turns_hz")}));
          }};
}

}  // namespace example
