#include "contract/basics.h"
#include "example.h"

namespace example {
namespace {

using namespace tress;
using namespace tress::models;

/// What a frame that turns uniformly about a vertical axis does to a strand described in
/// it: with w the rate and r the way from the axis, the force on a mass m is
///
///     f = m (w^2 r - 2 w e_z x v),   potential -m w^2 |r|^2/2;
///
/// the second, Coriolis', does no work.
class RotatingFrame final : public Effect {
 public:
  RotatingFrame(double rate, const Vec& centre) : rate_(rate), centre_(centre) {}

  std::string_view name() const override { return "rotating_frame"; }
  Needs needs() const override {
    return {.position = true, .velocity = true, .derivatives = true};
  }
  void add_load(double, const Points& p, InOut f) const noexcept override {
    for (std::size_t i = 0; i < p.mass.size(); ++i) {
      const Vec r = from_axis(p, i);
      const double pull = p.mass[i] * rate_ * rate_, turn = 2 * p.mass[i] * rate_;
      f[3 * i] += pull * r.x + turn * p.v[3 * i + 1];
      f[3 * i + 1] += pull * r.y - turn * p.v[3 * i];
    }
  }
  void add_derivatives(double, const Points& p, double pos, double vel,
                       InOut blocks) const noexcept override {
    for (std::size_t i = 0; i < p.mass.size(); ++i) {
      const double pull = pos * p.mass[i] * rate_ * rate_;
      const double turn = 2 * vel * p.mass[i] * rate_;
      blocks[9 * i] += pull;
      blocks[9 * i + 1] += turn;
      blocks[9 * i + 3] -= turn;
      blocks[9 * i + 4] += pull;
    }
  }
  double potential(double, const Points& p) const noexcept override {
    double sum = 0;
    for (std::size_t i = 0; i < p.mass.size(); ++i) {
      const Vec r = from_axis(p, i);
      sum -= p.mass[i] * rate_ * rate_ * dot(r, r) / 2;
    }
    return sum;
  }
  double power(double, const Points&) const noexcept override { return 0; }

 private:
  Vec from_axis(const Points& p, std::size_t i) const {
    return {p.x[3 * i] - centre_.x, p.x[3 * i + 1] - centre_.y, 0};
  }

  double rate_;
  Vec centre_;
};

constexpr Parameter frame_parameters[] = {
    {.name = "rate_per_s",
     .help = "angular velocity about the vertical (rad/s)",
     .number = 10,
     .min = -1e4,
     .max = 1e4},
    {.name = "centre_m",
     .help = "a point of the axis (m)",
     .min = -1e6,
     .max = 1e6,
     .components = 3,
     .fallback = "0,0,0"},
};

}  // namespace

EffectEntry rotating_frame_entry() {
  return {.id = "rotating_frame",
          .summary = "centrifugal and Coriolis force of a frame that turns uniformly",
          .source = "Landau & Lifshitz 1976, section 39",
          .parameters = frame_parameters,
          .make = [](const Parameters& p, const RootMotion&) {
            return std::unique_ptr<const Effect>(std::make_unique<RotatingFrame>(
                p.number("rate_per_s"), p.vec("centre_m")));
          }};
}

}  // namespace example
