#include "experiments/harness/tip_track.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "experiments/harness/simulation.h"
#include "experiments/harness/timing.h"
#include "integrators/catalogue.h"

namespace tress {
namespace {

/// Keeps q at equal times while a run passes them.
class Samples {
 public:
  Samples(double t_end, int count, std::size_t n) : t_end_(t_end), count_(count) {
    q_.reserve(n * static_cast<std::size_t>(count));
  }

  double time(int k) const { return t_end_ * k / count_; }
  int taken() const { return taken_; }
  In q(int k) const {
    const std::size_t n = before_.q.size();
    return In(q_).subspan(static_cast<std::size_t>(k - 1) * n, n);
  }

  void start(const State& state) {
    q_.clear();
    taken_ = 0;
    t_before_ = 0;
    before_ = state;
  }

  void step_to(double t, In q, In v) {
    while (taken_ < count_ && time(taken_ + 1) <= t) interpolate(time(++taken_), t, q, v);
    t_before_ = t;
    std::ranges::copy(q, before_.q.begin());
    std::ranges::copy(v, before_.v.begin());
  }

 private:
  void interpolate(double at, double t, In q, In v) {
    const double h = t - t_before_, x = (at - t_before_) / h, y = 1 - x;
    for (std::size_t i = 0; i < q.size(); ++i) {
      q_.push_back(y * y * (1 + 2 * x) * before_.q[i] + x * x * (1 + 2 * y) * q[i] +
                   h * x * y * (y * before_.v[i] - x * v[i]));
    }
  }

  double t_end_;
  int count_;
  int taken_ = 0;
  double t_before_ = 0;
  State before_;
  std::vector<double> q_;
};

}  // namespace

TipRun run_tip(std::string_view integrator, System& system, const Options& options,
               double t_end, int samples, int repeat) {
  const auto method = make_integrator(integrator, system, options);
  const State start = initial_state(system);
  Samples seen(t_end, samples, start.q.size());
  Status status = Status::ok;
  const auto once = [&] {
    seen.start(start);
    status = method->start(0, start.q, start.v);
    if (status != Status::ok) return;
    status = method->advance(t_end, [&seen](double t, In q, In v) {
      seen.step_to(t, q, v);
      return true;
    });
  };
  double wall = 0;
  if (repeat > 0) {
    wall = time_run(repeat, once);
  } else {
    once();
  }
  TipRun run{status, method->failure(), method->stats(), wall, {}};
  MaterialPoints& points = *system.material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(points.count()));
  for (int k = 1; k <= seen.taken(); ++k) {
    points.positions(seen.time(k), seen.q(k), x);
    run.tip.insert(run.tip.end(), x.end() - 3, x.end());
  }
  return run;
}

double tip_error(In tip, In reference, double length) {
  if (tip.size() != reference.size()) return std::numeric_limits<double>::infinity();
  double sum = 0;
  for (std::size_t i = 0; i < tip.size(); ++i) {
    sum += (tip[i] - reference[i]) * (tip[i] - reference[i]);
  }
  const double error = std::sqrt(3 * sum / static_cast<double>(tip.size())) / length;
  return std::isfinite(error) ? error : std::numeric_limits<double>::infinity();
}

}  // namespace tress
