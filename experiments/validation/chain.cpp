// A strand that behaves as a chain: one metre long, with negligible bending stiffness
// (EI/(rho g S L^3) = 1e-7) and stretched by its weight by 1e-5.
//
// whip: a pulse of the clamp, amplitude sin^4(pi t/D), runs down the hanging chain at
//   c = sqrt(g s), s from the free end. In u = 2 sqrt(s/g) small motions obey the
//   radial wave equation y_tt = y_uu + y_u/u; to the next order a pulse F changes its
//   shape by F + (1/(8 u)) int F, which moves its peak by (1/u_2 - 1/u_1)/8 |F/F''| =
//   0.1 ms, 5e-4 of the travel.
//
// falling_chain: released horizontally from a clamp, the tip falls freely,
//   z = -g t^2/2, until the wave of the constraint arrives.
//
// folded_chain: hangs folded in two, its ends side by side, and one is released. By
//   conservation of energy v^2 = g x (2 L - x)/(L - x) after a fall by x, which is
//   faster than free fall [Calkin & March 1989, Am. J. Phys. 57, 154; Tomaszewski,
//   Pieranski & Geminard 2006, Am. J. Phys. 74, 776]. A fold of finite length, a half
//   circle, changes neither energy at the same x as long as it falls upright.
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string>

#include "contract/input_error.h"
#include "experiments/validation/rods/motion.h"
#include "experiments/validation/rods/rod.h"
#include "experiments/validation/rods/signals.h"
#include "experiments/validation/test.h"

namespace tress::experiments::validation {
namespace {

using std::numbers::pi;

constexpr double length = 1, radius = 2e-6;  // m
constexpr Material material{
    .density = 1000, .youngs_modulus = 1e9, .shear_modulus = 3.4e8};

// bdf2, since the weight is applied to an unstretched chain: the resulting ringing is
// irrelevant and makes the tension oscillate.
constexpr std::string_view integrator = "bdf2";

Strand chain(int elements, const Frame& frame, const Shape& initial = {}) {
  Strand strand =
      make_strand(material, {radius, radius}, {.elements = elements, .length = length},
                  uniform_shape({}), initial);
  strand.root.frame = frame;
  return strand;
}

/// amplitude sin^4(pi t/duration) until t = duration, then 0: C^3.
Signal pulse(double amplitude, double duration) {
  return [=](double t) -> SignalValue {
    if (t <= 0 || t >= duration) return {};
    const double w = pi / duration, s = std::sin(w * t), c = std::cos(w * t);
    return {amplitude * s * s * s * s, amplitude * 4 * w * s * s * s * c,
            amplitude * 4 * w * w * s * s * (3 * c * c - s * s)};
  };
}

constexpr double upper = 0.9;  // L from the tip, where the pulse is first observed

double travel(double lower) {
  return 2 * (std::sqrt(upper) - std::sqrt(lower)) * std::sqrt(length / earth_gravity);
}

/// The node at a position `from_tip` (over L), which has to exist.
int node_at(double from_tip, int elements) {
  const double node = (1 - from_tip) * elements;
  if (std::abs(node - std::round(node)) > 1e-9) {
    throw InputError("no node at a station", "whip", "give a multiple of 10 elements");
  }
  return static_cast<int>(std::lround(node));
}

double measured_travel(const ModelTrial& trial) {
  constexpr double duration = 0.2, step = 5e-4;  // s
  Strand strand = chain(trial.elements, hanging_clamp());
  strand.root.translations.push_back({{1, 0, 0}, pulse(1e-3 * length, duration)});
  const auto system = on_strand(trial.variant, strand, weight());
  const Look at_upper = place(*system, node_at(upper, trial.elements), 0);
  Track first;
  const Look at_lower = place(*system, node_at(trial.parameter, trial.elements), 0);
  const double passed =
      2 * (1 - std::sqrt(trial.parameter)) * std::sqrt(length / earth_gravity);
  const Track second =
      track(integrator, *system, step, passed + duration, [&](double t, In q, In v) {
        first.t.push_back(t);
        first.value.push_back(at_upper(t, q, v));
        return at_lower(t, q, v);
      });
  return time_of_peak(second) - time_of_peak(first);
}

double measured_fall(const ModelTrial& trial) {
  const auto system =
      on_strand(trial.variant, chain(trial.elements, horizontal_clamp()), weight());
  const double t_end = trial.parameter * std::sqrt(length / earth_gravity);
  const Track z = track(integrator, *system, t_end / 200, t_end, place(*system, -1, 2));
  return -z.value.back() / length;
}

double folded_speed(double fallen) {
  return std::sqrt(fallen * (2 - fallen) / (1 - fallen));
}

double measured_speed(const ModelTrial& trial) {
  // The fold takes at least two segments.
  const double fold = std::max(0.04, 2.0 / trial.elements) * length;
  const Shape folded = [fold](double s) {
    return Vec{0, std::abs(s - length / 2) < fold / 2 ? pi / fold : 0, 0};
  };
  const auto system =
      on_strand(trial.variant, chain(trial.elements, hanging_clamp(), folded), weight());
  // Until a freely falling tip arrives there.
  const double fallen = trial.parameter * length;
  const double t_end = std::sqrt(2 * fallen / earth_gravity);
  const Track z = track(integrator, *system, 5e-4, t_end, place(*system, -1, 2));
  for (std::size_t i = 1; i + 1 < z.t.size(); ++i) {
    if (z.value.front() - z.value[i] < fallen) continue;
    // The speed at the midpoints of two steps, one before and one after.
    const auto speed = [&](std::size_t k) {
      return (z.value[k - 1] - z.value[k]) / (z.t[k] - z.t[k - 1]);
    };
    const double before = z.value.front() - (z.value[i - 1] + z.value[i - 2]) / 2;
    const double after = z.value.front() - (z.value[i] + z.value[i - 1]) / 2;
    const double share = (fallen - before) / (after - before);
    const double found = speed(i - 1) + share * (speed(i) - speed(i - 1));
    return found / std::sqrt(earth_gravity * length);
  }
  throw std::runtime_error("the end falls no faster than freely");
}

}  // namespace

std::vector<ValidationTest> chain_tests() {
  const std::vector<std::string_view> all{
      "super_helix",     "super_clothoid",     "articulated_chain", "der",
      "corde",           "xpbd_cosserat",      "dynamic_spline",    "mass_spring",
      "kirchhoff_nodal", "inextensible_strand"};
  return {
      {
          .name = "whip",
          .what = "a transverse pulse runs down a hanging chain",
          .source = "c = sqrt(g s), s from the free end: time of travel 2 (sqrt s1 - "
                    "sqrt s2)/sqrt g",
          .parameter = "lower station, distance from the tip over L",
          .quantity = "time of travel from 0.9 L (s)",
          .range = {0.1, 0.85},
          .quick = {{0.4}, {40}},
          .usual = {{0.7, 0.4, 0.2}, {20, 40, 80}},
          .full = {{0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2}, {20, 40, 80, 160}},
          .tolerance = 0.02,
          .why = "waves of wave number k on masses h apart are (k h)^2/8 slow in "
                 "their groups: 1.3 % at h = L/40 for k = 13/m, the pulse's at 0.4 L",
          .judged_from = 40,
          .claimed = all,
          .reference = travel,
          .measure = measured_travel,
      },
      {
          .name = "falling_chain",
          .what = "let go horizontally from a clamp, the tip falls freely at first",
          .source = "z = -g t^2/2, exact for chains of links until the wave of the "
                    "constraint arrives (t = 0.8 sqrt(L/g) for 20 links)",
          .parameter = "time over sqrt(L/g)",
          .quantity = "fall of the tip over L",
          .range = {0.1, 0.8},
          .quick = {{0.6}, {20}},
          .usual = {{0.3, 0.6}, {10, 20, 40}},
          .full = {{0.2, 0.4, 0.6, 0.7}, {10, 20, 40, 80}},
          .tolerance = 1e-3,
          .why = "no matter of discretisation: only stretch (1e-5) and bending may "
                 "tell the tip of the clamp; 100 times the first",
          .judged_from = 10,
          .claimed = all,
          .reference = [](double t) { return t * t / 2; },
          .measure = measured_fall,
      },
      {
          .name = "folded_chain",
          .what = "a chain folded in two falls faster than freely",
          .source = "Calkin & March 1989; Tomaszewski et al. 2006: v^2 = g x (2 L - "
                    "x)/(L - x)",
          .parameter = "fall of the free end x over L",
          .quantity = "its speed over sqrt(g L)",
          .range = {0.1, 0.8},
          .quick = {{0.5}, {50}},
          .usual = {{0.3, 0.5, 0.6}, {50}},
          .full = {{0.2, 0.3, 0.4, 0.5, 0.6, 0.7}, {50, 100}},
          .tolerance = 0.05,
          .why = "free fall is 18 % slower at x = L/2; the fold swings aside as it "
                 "runs down, and one of 50 segments turning over in it is 8 % of what "
                 "still moves at L/2, 4 % of its speed",
          .judged_from = 50,
          .claimed = all,
          .reference = folded_speed,
          .measure = measured_speed,
      }};
}

}  // namespace tress::experiments::validation
