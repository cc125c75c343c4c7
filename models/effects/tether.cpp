#include "models/effects/tether.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "contract/input_error.h"
#include "math/mat3.h"

namespace tress::models {
namespace {

using std::numbers::pi;

constexpr Parameter parameters_of_tether[] = {
    {.name = "at",
     .help = "held point, as a fraction of the strand's length: 0 root, 1 tip. The "
             "tether holds the point of the model that carries this part of the length",
     .number = 1,
     .min = 0,
     .max = 1},
    {.name = "stiffness_n_m",
     .help = "spring towards the target (N/m)",
     .number = 0,
     .min = 0,
     .max = 1e9},
    {.name = "damping_n_s_m",
     .help = "force against the velocity relative to the target (N s/m)",
     .number = 0,
     .min = 0,
     .max = 1e9},
    {.name = "pull_n",
     .help = "force towards the target, whatever the distance (N)",
     .number = 0,
     .min = 0,
     .max = 1e9},
    {.name = "soft_m",
     .help = "distance within which the pull fades (m)",
     .number = 1e-3,
     .min = 1e-9,
     .max = 1e3},
    {.name = "target_m",
     .help = "point x, y, z towards which it pulls (m)",
     .min = -1e6,
     .max = 1e6,
     .components = 3,
     .fallback = "0,0,0"},
    {.name = "amplitude_m",
     .help = "the target moves by this x, y, z times sin(2 pi frequency t) (m)",
     .min = -1e6,
     .max = 1e6,
     .components = 3,
     .fallback = "0,0,0"},
    {.name = "frequency_hz",
     .help = "frequency of the target's motion (1/s)",
     .number = 1,
     .min = 0,
     .max = 1e6},
    {.name = "t_on_s",
     .help = "time at which it starts to pull (s)",
     .number = 0,
     .min = -1e6,
     .max = 1e6},
    {.name = "t_off_s",
     .help = "time at which it starts to let go (s)",
     .number = 1e6,
     .min = -1e6,
     .max = 1e6},
    {.name = "ramp_s",
     .help = "time in which it takes hold and lets go (s)",
     .number = 1e-2,
     .min = 1e-9,
     .max = 1e6}};

double rise(double y) {
  y = std::clamp(y, 0.0, 1.0);
  return y * y * (3 - 2 * y);
}
double rise_rate(double y) {
  y = std::clamp(y, 0.0, 1.0);
  return 6 * y * (1 - y);
}

}  // namespace

std::span<const Parameter> tether_parameters() { return parameters_of_tether; }

std::unique_ptr<const Effect> make_tether(const Parameters& parameters,
                                          const RootMotion&) {
  return std::make_unique<Tether>(
      Tether::Settings{.at = parameters.number("at"),
                       .stiffness = parameters.number("stiffness_n_m"),
                       .damping = parameters.number("damping_n_s_m"),
                       .pull = parameters.number("pull_n"),
                       .soft = parameters.number("soft_m"),
                       .target = parameters.vec("target_m"),
                       .amplitude = parameters.vec("amplitude_m"),
                       .frequency = parameters.number("frequency_hz"),
                       .on = parameters.number("t_on_s"),
                       .off = parameters.number("t_off_s"),
                       .ramp = parameters.number("ramp_s")});
}

Tether::Tether(const Settings& settings) : s_(settings) {
  const bool finite = is_finite(s_.target) && is_finite(s_.amplitude) &&
                      std::isfinite(s_.stiffness + s_.damping + s_.pull + s_.soft +
                                    s_.frequency + s_.on + s_.off + s_.ramp);
  if (!finite || s_.stiffness < 0 || s_.damping < 0 || s_.pull < 0 || s_.soft <= 0 ||
      s_.ramp <= 0) {
    throw InputError("a number is negative or not finite", "effect tether",
                     "give stiffness, damping and pull >= 0, soft and ramp > 0");
  }
  if (!(s_.at >= 0 && s_.at <= 1)) {
    throw InputError("the place along the strand is not on it", "effect tether",
                     "give `at` between 0 (root) and 1 (tip)");
  }
  if (s_.off < s_.on) {
    throw InputError("it lets go before it takes hold", "effect tether",
                     "give t_off >= t_on");
  }
}

Vec Tether::target(double t) const {
  return s_.target + std::sin(2 * pi * s_.frequency * t) * s_.amplitude;
}

Vec Tether::target_rate(double t) const {
  const double w = 2 * pi * s_.frequency;
  return (w * std::cos(w * t)) * s_.amplitude;
}

double Tether::strength(double t) const {
  return rise((t - s_.on) / s_.ramp) * (1 - rise((t - s_.off) / s_.ramp));
}

double Tether::strength_rate(double t) const {
  const double on = (t - s_.on) / s_.ramp, off = (t - s_.off) / s_.ramp;
  return (rise_rate(on) * (1 - rise(off)) - rise(on) * rise_rate(off)) / s_.ramp;
}

double Tether::next_breakpoint(double t) const noexcept {
  double next = std::numeric_limits<double>::infinity();
  for (const double time : {s_.on, s_.on + s_.ramp, s_.off, s_.off + s_.ramp}) {
    if (time > t) next = std::min(next, time);
  }
  return next;
}

/// Lengths are sums whose order differs: where a place lies between two points, rounding
/// does not choose between them.
std::size_t Tether::held(const Points& p) const {
  constexpr double rounding = 1e-12;
  double total = 0;
  for (const double length : p.length) total += length;
  double sum = 0;
  std::size_t i = 0;
  while (i + 1 < p.length.size() && (sum += p.length[i]) < (s_.at - rounding) * total)
    ++i;
  return i;
}

double Tether::soft_length(const Vec& d) const {
  return std::sqrt(dot(d, d) + s_.soft * s_.soft);
}

Vec Tether::attraction(const Vec& d) const {
  return (s_.stiffness + s_.pull / soft_length(d)) * d;
}

double Tether::energy(const Vec& d) const {
  return s_.stiffness / 2 * dot(d, d) + s_.pull * soft_length(d);
}

void Tether::add_load(double t, const Points& p, InOut f) const noexcept {
  const std::size_t i = held(p);
  const Vec d = target(t) - load3(&p.x[3 * i]);
  const Vec drift = target_rate(t) - load3(&p.v[3 * i]);
  double* load = &f[3 * i];
  store3(load3(load) + strength(t) * (attraction(d) + s_.damping * drift), load);
}

void Tether::add_derivatives(double t, const Points& p, double pos, double vel,
                             InOut blocks) const noexcept {
  const std::size_t i = held(p);
  const Vec d = target(t) - load3(&p.x[3 * i]);
  const double length = soft_length(d);
  const double s = strength(t);
  const double same = pos * (s_.stiffness + s_.pull / length) + vel * s_.damping;
  const double along = pos * s_.pull / (length * length * length);
  add9(s * (along * outer(d, d) - same * identity()), &blocks[9 * i]);
}

double Tether::potential(double t, const Points& p) const noexcept {
  return strength(t) * energy(target(t) - load3(&p.x[3 * held(p)]));
}

double Tether::power(double t, const Points& p) const noexcept {
  const std::size_t i = held(p);
  const Vec d = target(t) - load3(&p.x[3 * i]);
  const Vec v = load3(&p.v[3 * i]);
  const Vec moves = target_rate(t);
  const double s = strength(t);
  return s * (s_.damping * dot(moves - v, v) + dot(attraction(d), moves)) +
         strength_rate(t) * energy(d);
}

}  // namespace tress::models
