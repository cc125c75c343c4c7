#include "experiments/validation/rods/signals.h"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>
#include <numeric>
#include <stdexcept>

namespace tress::experiments::validation {
namespace {

/// The vertex of the parabola through three samples, in steps from the middle one.
struct Vertex {
  double at, value;
};
Vertex vertex(double before, double middle, double after) {
  const double slope = (after - before) / 2, bend = before - 2 * middle + after;
  if (bend == 0) return {0, middle};
  return {-slope / bend, middle - slope * slope / (2 * bend)};
}

}  // namespace

std::vector<double> zeros(const Track& track) {
  std::vector<double> all;
  for (std::size_t i = 1; i < track.t.size(); ++i) {
    const double before = track.value[i - 1], now = track.value[i];
    if ((before < 0) == (now < 0)) continue;
    const double share = before / (before - now);
    all.push_back(track.t[i - 1] + share * (track.t[i] - track.t[i - 1]));
  }
  return all;
}

double period(const Track& track) {
  const std::vector<double> all = zeros(track);
  if (all.size() < 3) throw std::runtime_error("it does not swing");
  const std::size_t periods = (all.size() - 1) / 2;
  return (all[2 * periods] - all.front()) / static_cast<double>(periods);
}

double time_of_peak(const Track& track) {
  const auto largest = std::ranges::max_element(track.value) - track.value.begin();
  const auto i = static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(largest, 1, std::ssize(track.value) - 2));
  const Vertex top = vertex(track.value[i - 1], track.value[i], track.value[i + 1]);
  return track.t[i] + top.at * (track.t[i + 1] - track.t[i]);
}

double strongest_rate(const Track& track, double from, double to) {
  const std::size_t n = track.t.size();
  const double mean = std::accumulate(track.value.begin(), track.value.end(), 0.0) /
                      static_cast<double>(n);
  const double duration = track.t.back() - track.t.front();
  const auto strength = [&](double rate) {
    std::complex<double> sum = 0;
    for (std::size_t i = 0; i < n; ++i) {
      const double s = (track.t[i] - track.t.front()) / duration;
      const double window = 1 - std::cos(2 * std::numbers::pi * s);
      sum += std::polar(window * (track.value[i] - mean), rate * track.t[i]);
    }
    return std::abs(sum);
  };
  // A peak is 4 pi/duration wide to either side: eighths of that locate it, and near its
  // top it is a parabola.
  const double step = std::numbers::pi / (2 * duration);
  double best = from, most = strength(from);
  for (double rate = from + step; rate <= to; rate += step) {
    const double here = strength(rate);
    if (here > most) most = here, best = rate;
  }
  for (double width = step / 2; width > 1e-6 * best; width /= 4) {
    best += width *
            std::clamp(
                vertex(strength(best - width), strength(best), strength(best + width)).at,
                -2.0, 2.0);
  }
  return best;
}

double decay_rate(const Track& track) {
  // Turning points; half swings between neighbours, midway.
  std::vector<double> t, x;
  for (std::size_t i = 1; i + 1 < track.t.size(); ++i) {
    const double before = track.value[i - 1], here = track.value[i],
                 after = track.value[i + 1];
    if ((here - before) * (after - here) > 0 || here == before) continue;
    const Vertex turn = vertex(before, here, after);
    t.push_back(track.t[i] + turn.at * (track.t[i + 1] - track.t[i]));
    x.push_back(turn.value);
  }
  if (t.size() < 4) throw std::runtime_error("it does not swing");
  const auto n = static_cast<double>(t.size() - 1);
  double st = 0, sy = 0, stt = 0, sty = 0;
  for (std::size_t i = 1; i < t.size(); ++i) {
    const double at = (t[i - 1] + t[i]) / 2;
    const double y = std::log(std::abs(x[i] - x[i - 1]) / 2);
    st += at, sy += y, stt += at * at, sty += at * y;
  }
  return -(n * sty - st * sy) / (n * stt - st * st);
}

}  // namespace tress::experiments::validation
