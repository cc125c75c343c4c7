#include "integrators/esdirk.h"

#include <algorithm>
#include <numeric>

#include "integrators/fixed_step.h"
#include "integrators/vector_ops.h"

namespace tress::integrators {
namespace {

/// Accelerations of this many stages before give the guess of the next: a parabola.
/// Higher polynomials amplify what the fast modes left in them.
constexpr std::size_t guessed_from = 3;

class FixedEsdirk final : public FixedStep {
 public:
  FixedEsdirk(System& system, const Options& options, const EsdirkTable& table)
      : FixedStep(system, options), stages_(dynamics_, options, table) {}

 private:
  Status reset(double t) override { return dynamics_.accelerate(t, q_, v_, a_, lambda_); }

  Status step(double t, double h) override {
    const Status s = stages_.step(t, h, q_, v_, a_, lambda_);
    take(stages_.q(), stages_.v());
    std::ranges::copy(stages_.a(), a_.begin());
    std::ranges::copy(stages_.lambda(), lambda_.begin());
    return s;
  }

  EsdirkStages stages_;
};

}  // namespace

double EsdirkTable::c(std::size_t i) const {
  return std::accumulate(a[i].begin(), a[i].end(), 0.0);
}

EsdirkStages::EsdirkStages(Dynamics& dynamics, const Options& options,
                           const EsdirkTable& table)
    : table_(table),
      stage_(dynamics, options),
      v_(table.stages, std::vector<double>(static_cast<std::size_t>(dynamics.n()))),
      a_(v_),
      q_bar_(v_.front()),
      v_bar_(q_bar_),
      lambda_(static_cast<std::size_t>(dynamics.m())) {}

/// By the polynomial through the last stages before.
void EsdirkStages::guess(std::size_t i) noexcept {
  const std::size_t first = i > guessed_from ? i - guessed_from : 0;
  std::ranges::fill(a_[i], 0.0);
  for (std::size_t j = first; j < i; ++j) {
    double weight = 1;
    for (std::size_t k = first; k < i; ++k) {
      if (k == j) continue;
      weight *= (table_.c(i) - table_.c(k)) / (table_.c(j) - table_.c(k));
    }
    add(a_[i], weight, a_[j]);
  }
}

Status EsdirkStages::step(double t, double h, In q, In v, In a, In lambda) noexcept {
  std::ranges::copy(v, v_[0].begin());
  std::ranges::copy(a, a_[0].begin());
  std::ranges::copy(lambda, lambda_.begin());
  const double hg = h * table_.gamma();
  for (std::size_t i = 1; i < table_.stages; ++i) {
    std::ranges::copy(v, v_bar_.begin());
    std::ranges::copy(q, q_bar_.begin());
    for (std::size_t j = 0; j < i; ++j) {
      add(v_bar_, h * table_.a[i][j], a_[j]);
      add(q_bar_, h * table_.a[i][j], v_[j]);
    }
    add(q_bar_, hg, v_bar_);
    guess(i);
    const Status s =
        stage_.solve(t + h * table_.c(i), q_bar_, v_bar_, {1, hg, hg * hg}, a_[i],
                     lambda_, i == 1 ? Stage::Matrix::own : Stage::Matrix::shared);
    if (s != Status::ok) return s;
    std::ranges::copy(stage_.v(), v_[i].begin());
  }
  return Status::ok;
}

void EsdirkStages::difference(double h, Out dq, Out dv) const noexcept {
  std::ranges::fill(dq, 0.0);
  std::ranges::fill(dv, 0.0);
  for (std::size_t i = 0; i < table_.stages; ++i) {
    const double weight = h * (table_.a[last()][i] - table_.embedded[i]);
    add(dq, weight, v_[i]);
    add(dv, weight, a_[i]);
  }
}

std::unique_ptr<Integrator> make_esdirk(const EsdirkTable& table, System& system,
                                        const Options& options) {
  return std::make_unique<FixedEsdirk>(system, options, table);
}

}  // namespace tress::integrators
