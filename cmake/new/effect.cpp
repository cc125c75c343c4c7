// FILL IN: what this effect is, in one sentence.
#include "contract/fill_in.h"
#include "math/dual.h"
#include "models/effects/catalogue.h"
#include "models/motion/root_motion.h"

namespace tress::models {
namespace {

/// FILL IN: the force with symbols and units, and the source with equation numbers.
///
///     f(t, x, v) on a point of mass m that carries the length l
///
/// Its derivatives come from dual numbers. O(points).
class PointForce final : public Effect {
 public:
  explicit PointForce(double strength) : strength_(strength) {}

  std::string_view name() const override { return "skeleton_name"; }
  /// FILL IN: only what the force reads.
  Needs needs() const override {
    return {.position = true, .velocity = true, .derivatives = true};
  }

  void add_load(double t, const Points& p, InOut f) const noexcept override {
    for (std::size_t i = 0; i < p.mass.size(); ++i) {
      const Vec load =
          force(t, load3(&p.x[3 * i]), load3(&p.v[3 * i]), p.mass[i], p.length[i]);
      store3(load3(&f[3 * i]) + load, &f[3 * i]);
    }
  }

  void add_derivatives(double t, const Points& p, double pos, double vel,
                       InOut blocks) const noexcept override {
    for (std::size_t i = 0; i < p.mass.size(); ++i) {
      Dual<3> x[3], v[3], f[3];
      for (std::size_t k = 0; k < 3; ++k) {
        x[k].value = p.x[3 * i + k];
        v[k].value = p.v[3 * i + k];
        x[k].part[k] = pos;
        v[k].part[k] = vel;
      }
      store3(force(t, load3(x), load3(v), p.mass[i], p.length[i]), f);
      for (std::size_t k = 0; k < 9; ++k) blocks[9 * i + k] += f[k / 3].part[k % 3];
    }
  }

  /// FILL IN: J, of the part of the force that has one.
  double potential(double /*t*/, const Points& /*p*/) const noexcept override {
    return 0;
  }

  /// FILL IN: W, of the rest of the force.
  double power(double /*t*/, const Points& /*p*/) const noexcept override { return 0; }

 private:
  /// FILL IN: N, for any scalar T. `mass` in kg, `length` in m.
  template <class T>
  Vec3<T> force(double /*t*/, const Vec3<T>& /*x*/, const Vec3<T>& /*v*/, double /*mass*/,
                double /*length*/) const {
    return T(strength_) * Vec3<T>();
  }

  double strength_;
};

/// FILL IN: keys with their units. With their defaults the effect must act on a hair of
/// 10 cm.
constexpr Parameter own_parameters[] = {{.name = "strength",
                                         .help = "of the force (unit)",
                                         .number = 1,
                                         .min = -1e6,
                                         .max = 1e6}};

std::unique_ptr<const Effect> make_force(const Parameters& parameters,
                                         const RootMotion& /*head*/) {
  fill_in("needs, force, potential and power, above");
  return std::make_unique<PointForce>(parameters.number("strength"));
}

}  // namespace

EffectEntry skeleton_name_entry() {
  return {.id = "skeleton_name",
          .summary = "FILL IN: what acts, one line",
          .source = "FILL IN: author year",
          .parameters = own_parameters,
          .make = make_force};
}

}  // namespace tress::models
