#include "experiments/numerics/tip_signal.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "simulation/run/simulation.h"

namespace tress::experiments {
namespace {

/// Returns the cubic of the step that ends at `i`, at the fraction s of the step.
double on_cubic(const TipSignal& signal, std::size_t i, double s) {
  const double h = signal.t[i] - signal.t[i - 1], r = 1 - s;
  return r * r * (1 + 2 * s) * signal.x[i - 1] + s * s * (1 + 2 * r) * signal.x[i] +
         h * s * r * (r * signal.v[i - 1] - s * signal.v[i]);
}

/// The index of the step, or line segment, that ends at or after t.
std::size_t piece(In ends, double t) {
  const auto at = std::ranges::lower_bound(ends, t) - ends.begin();
  return static_cast<std::size_t>(
      std::clamp<std::ptrdiff_t>(at, 1, std::ssize(ends) - 1));
}

struct Turn {
  double t, x;
};

/// The start, and every point where the velocity changes its sign.
std::vector<Turn> turns(const TipSignal& signal) {
  std::vector<Turn> all{{signal.t.front(), signal.x.front()}};
  for (std::size_t i = 1; i < signal.t.size(); ++i) {
    const double before = signal.v[i - 1], now = signal.v[i];
    if (before * now > 0 || before == 0) continue;
    // Zero of the velocity by the chord: off by h^2, where the cubic is flat.
    const double s = before / (before - now);
    all.push_back(
        {signal.t[i - 1] + s * (signal.t[i] - signal.t[i - 1]), on_cubic(signal, i, s)});
  }
  return all;
}

double swing(const std::vector<Turn>& turns, std::size_t i) {
  return std::abs(turns[i].x - turns[i - 1].x);
}

/// Turning points without those of ripples.
std::vector<Turn> without_ripples(const std::vector<Turn>& all) {
  std::vector<Turn> kept;
  for (const Turn& turn : all) {
    kept.push_back(turn);
    while (kept.size() > 2) {
      const std::size_t last = kept.size() - 1;
      if (swing(kept, last - 1) >= swing(kept, last)) break;
      if (kept.size() == 3) {
        kept.erase(kept.begin());  // smaller than the next one
      } else if (swing(kept, last - 1) < swing(kept, last - 2)) {
        kept.erase(kept.end() - 3, kept.end() - 1);
      } else {
        break;
      }
    }
  }
  return kept;
}

}  // namespace

TipSignal run_tip_signal(std::string_view integrator, System& system,
                         const Options& options, int axis, double t_end, Guard* guard) {
  MaterialPoints& points = *system.material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(points.count()));
  const auto k = static_cast<std::size_t>(axis);
  const std::size_t tip = x.size() - 3 + k;
  TipSignal signal;
  const auto see = [&](double t, In q, In v) {
    signal.t.push_back(t);
    points.positions(t, q, x);
    signal.x.push_back(x[tip] - x[k]);
    points.velocities(t, q, v, x);
    signal.v.push_back(x[tip] - x[k]);
    return true;
  };
  const State start = initial_state(system);
  system.reset();
  see(0, start.q, start.v);
  const Simulation run =
      guard != nullptr
          ? simulate_guarded(*guard, integrator, system, options, start, t_end, see)
          : simulate(integrator, system, options, start, t_end, see);
  signal.status = run.status;
  signal.failure = run.failure;
  return signal;
}

std::vector<double> displacement(const TipSignal& signal, In times) {
  std::vector<double> x;
  x.reserve(times.size());
  for (const double t : times) {
    const std::size_t i = piece(signal.t, t);
    const double h = signal.t[i] - signal.t[i - 1];
    x.push_back(on_cubic(signal, i, (t - signal.t[i - 1]) / h));
  }
  return x;
}

Swings swings(const TipSignal& signal) {
  const std::vector<Turn> turning = without_ripples(turns(signal));
  Swings all;
  for (std::size_t i = 1; i < turning.size(); ++i) {
    all.t.push_back((turning[i - 1].t + turning[i].t) / 2);
    all.half.push_back(swing(turning, i) / 2);
  }
  return all;
}

std::vector<double> envelope(const TipSignal& signal, In times) {
  const Swings all = swings(signal);
  if (all.t.size() < 2) return {};
  std::vector<double> a;
  a.reserve(times.size());
  for (const double t : times) {
    const std::size_t i = piece(all.t, t);
    const double s = (t - all.t[i - 1]) / (all.t[i] - all.t[i - 1]);
    a.push_back(std::pow(all.half[i - 1], 1 - s) * std::pow(all.half[i], s));
  }
  return a;
}

}  // namespace tress::experiments
