#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <utility>

#include "contract/input_error.h"
#include "contract/parameters.h"
#include "models/motion/root_motion.h"
#include "models/motion/signals.h"
#include "models/motion/teleport.h"

namespace tress::models {
namespace {

/// Times, values and second derivatives at the knots of a cubic spline.
struct Knots {
  std::vector<double> t, x, bend;
  bool rests_before = true, rests_behind = true;  // at rest beyond the ends
};

[[noreturn]] void refuse(const std::string& problem) {
  throw InputError(problem, "signal of a root motion",
                   "give at least two, finite, each later than the one before; two of "
                   "the same time are a teleport");
}

void check(const std::vector<double>& times, const std::vector<double>& values,
           std::size_t least = 2, bool jumps = false) {
  if (times.size() < least) refuse("fewer than two keyframes");
  if (times.size() != values.size()) refuse("the numbers of times and values differ");
  const auto row = [&](std::size_t i) { return "keyframe " + std::to_string(i + 1); };
  const auto at = [&](std::size_t i) { return " at " + number_text(times[i]) + " s"; };
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!std::isfinite(times[i]) || !std::isfinite(values[i])) {
      refuse(row(i) + " has a number that is not finite");
    }
    if (i == 0 || times[i] > times[i - 1]) continue;
    if (!jumps || times[i] < times[i - 1]) {
      refuse(row(i) + at(i) + " is not later than " + row(i - 1) + at(i - 1));
    }
    if (i > 1 && times[i - 1] == times[i - 2]) {
      refuse(row(i) + " is the third" + at(i));
    }
  }
}

/// Adds a knot next to each end that rests, whose x is unknown and set to 0.
void add_knots(Knots& k) {
  const std::size_t last = k.t.size() - 1;
  const double part = last == 1 && k.rests_before && k.rests_behind ? 1.0 / 3 : 0.5;
  const double first = k.t[0] + part * (k.t[1] - k.t[0]);
  const double second = k.t[last] - part * (k.t[last] - k.t[last - 1]);
  if (k.rests_behind) {
    k.t.insert(k.t.end() - 1, second);
    k.x.insert(k.x.end() - 1, 0);
  }
  if (k.rests_before) {
    k.t.insert(k.t.begin() + 1, first);
    k.x.insert(k.x.begin() + 1, 0);
  }
}

/// x' is continuous at knot i where
///
///     a M_{i-1}/6 + (a + b) M_i/3 + b M_{i+1}/6 = (x_{i+1} - x_i)/b - (x_i - x_{i-1})/a
///
/// for second derivatives M and intervals a before and b after it. M = 0 at both ends.
/// Where an end rests, x' = 0 is x_1 = x_0 + a^2 M_1/6 for the first interval a, the same
/// for the last.
void bend(Knots& k) {
  if (k.t.size() > 1) add_knots(k);
  k.bend.resize(k.t.size());
  if (k.t.size() < 3) return;
  const std::size_t unknowns = k.t.size() - 2;
  std::vector<double> diagonal(unknowns), above(unknowns - 1), below(unknowns - 1),
      right(unknowns), bend(unknowns);
  const double start = k.t[1] - k.t[0], end = k.t[unknowns + 1] - k.t[unknowns];
  if (k.rests_before) k.x[1] = k.x[0];
  if (k.rests_behind) k.x[unknowns] = k.x[unknowns + 1];
  for (std::size_t i = 1; i <= unknowns; ++i) {
    const double a = k.t[i] - k.t[i - 1], b = k.t[i + 1] - k.t[i];
    diagonal[i - 1] = (a + b) / 3;
    if (i > 1) below[i - 2] = a / 6;
    if (i < unknowns) above[i - 1] = b / 6;
    right[i - 1] = (k.x[i + 1] - k.x[i]) / b - (k.x[i] - k.x[i - 1]) / a;
  }
  // What M_1 and M_unknowns add to x_1 and x_unknowns.
  const auto move = [&](std::size_t knot, double factor) {
    const double a = k.t[knot] - k.t[knot - 1], b = k.t[knot + 1] - k.t[knot];
    diagonal[knot - 1] += factor * (1 / a + 1 / b);
    if (knot > 1) above[knot - 2] -= factor / a;
    if (knot < unknowns) below[knot - 1] -= factor / b;
  };
  if (k.rests_before) move(1, start * start / 6);
  if (k.rests_behind) move(unknowns, end * end / 6);
  for (std::size_t i = 1; i < unknowns; ++i) {  // rows are diagonally dominant
    const double factor = below[i - 1] / diagonal[i - 1];
    diagonal[i] -= factor * above[i - 1];
    right[i] -= factor * right[i - 1];
  }
  for (std::size_t i = unknowns; i-- > 0;) {
    if (i + 1 < unknowns) right[i] -= above[i] * bend[i + 1];
    bend[i] = right[i] / diagonal[i];
    if (!std::isfinite(bend[i])) refuse("keyframes are too close for their distance");
  }
  std::ranges::copy(bend, k.bend.begin() + 1);
  if (k.rests_before) k.x[1] += start * start / 6 * bend.front();
  if (k.rests_behind) k.x[unknowns] += end * end / 6 * bend.back();
}

SignalValue value_of(const Knots& k, double t) {
  const bool before = t <= k.t.front(), behind = t >= k.t.back();
  if (before && (k.rests_before || k.t.size() == 1)) return {k.x.front(), 0, 0};
  if (behind && (k.rests_behind || k.t.size() == 1)) return {k.x.back(), 0, 0};
  // An end at a teleport has no curvature, so that a straight line continues it.
  const double beyond = t - std::clamp(t, k.t.front(), k.t.back());
  t -= beyond;
  const auto after = std::ranges::upper_bound(k.t, t);
  const std::size_t j = std::min(static_cast<std::size_t>(after - k.t.begin()),
                                 k.t.size() - 1),
                    i = j - 1;
  const double h = k.t[j] - k.t[i];
  const double u = (k.t[j] - t) / h, w = (t - k.t[i]) / h;
  const double m = k.bend[i], n = k.bend[j];
  const double rate =
      (k.x[j] - k.x[i]) / h + h / 6 * ((3 * w * w - 1) * n - (3 * u * u - 1) * m);
  return {u * k.x[i] + w * k.x[j] +
              h * h / 6 * ((u * u * u - u) * m + (w * w * w - w) * n) + beyond * rate,
          rate, u * m + w * n};
}

/// Splines one after the other, and the teleports between them.
struct Pieces {
  std::vector<Knots> each;
  std::vector<double> jumps;
};

/// Returns the teleports of rows with these times.
std::vector<double> jumps_of(const std::vector<double>& times) {
  std::vector<double> jumps;
  for (std::size_t i = 1; i < times.size(); ++i) {
    if (times[i] == times[i - 1]) jumps.push_back(teleport_time(times[i]));
  }
  return jumps;
}

}  // namespace

Signal keyframes(const std::vector<double>& times, const std::vector<double>& values) {
  check(times, values, 2, true);
  const auto pieces = std::make_shared<Pieces>();
  pieces->jumps = jumps_of(times);
  std::vector<double> breakpoints;
  for (std::size_t first = 0, i = 1; i <= times.size(); ++i) {
    if (i < times.size() && times[i] > times[i - 1]) continue;
    const auto part = [&](const std::vector<double>& all) {
      return std::vector(all.begin() + static_cast<std::ptrdiff_t>(first),
                         all.begin() + static_cast<std::ptrdiff_t>(i));
    };
    Knots& knots = pieces->each.emplace_back(
        Knots{part(times), part(values), {}, first == 0, i == times.size()});
    bend(knots);
    breakpoints.insert(breakpoints.end(), knots.t.begin(), knots.t.end());
    first = i;
  }
  const auto value = [pieces = std::shared_ptr<const Pieces>(pieces)](double t,
                                                                      double since) {
    const auto piece =
        std::ranges::upper_bound(pieces->jumps, since) - pieces->jumps.begin();
    return value_of(pieces->each[static_cast<std::size_t>(piece)], t);
  };
  return {value, breakpoints};
}

Signal rests(const std::vector<double>& times, const std::vector<double>& values) {
  check(times, values, 1);
  std::vector<Signal> steps;
  for (std::size_t i = 1; i < times.size(); ++i) {
    steps.push_back(
        smooth_step(values[i] - values[i - 1], times[i - 1], times[i] - times[i - 1]));
  }
  const auto value = [times, values, steps = std::move(steps)](double t) -> SignalValue {
    if (t <= times.front()) return {values.front(), 0, 0};
    if (t >= times.back()) return {values.back(), 0, 0};
    const auto after = std::ranges::upper_bound(times, t);
    const auto before = static_cast<std::size_t>(after - times.begin()) - 1;
    SignalValue moved = steps[before](t);
    moved.value += values[before];
    return moved;
  };
  return {value, times};
}

RootMotion keyframe_motion(std::span<const double> rows, std::span<const Vec> axes,
                           const Vec& centre) {
  std::vector<std::vector<double>> all(4 + axes.size());
  for (std::size_t i = 0; i < rows.size(); ++i) all[i % all.size()].push_back(rows[i]);
  RootMotion motion;
  motion.teleports = jumps_of(all[0]);
  motion.position = centre;
  motion.centre = centre;
  for (std::size_t k = 0; k < std::size(world_axes); ++k) {
    motion.translations.push_back({world_axes[k], keyframes(all[0], all[1 + k])});
  }
  for (std::size_t k = 0; k < axes.size(); ++k) {
    motion.rotations.push_back({axes[k], keyframes(all[0], all[4 + k])});
  }
  return motion;
}

}  // namespace tress::models
