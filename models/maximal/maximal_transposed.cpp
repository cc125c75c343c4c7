// The TransposedForm of maximal_system.h.
#include <algorithm>
#include <cmath>

#include "linear/finite.h"
#include "linear/vector_ops.h"
#include "models/maximal/maximal_system.h"
#include "models/maximal/strand_elimination.h"

namespace tress::models {

bool MaximalSystem::factor_transposed(double t, In q, In v, In a, Weights w) noexcept {
  if (elimination_ == nullptr || elimination_->transposed() == nullptr) return false;
  if (coupled_solver_ || w.pos == 0) return false;
  place(t, q, v);
  eliminated_ = eliminate(t, w);
  if (!eliminated_) return false;
  eliminated_weights_ = w;
  a_transposed_.assign(a.begin(), a.end());
  if (needs_.derivatives) find_blocks(t, {0, 1, 0}, false);  // for solve_transposed()
  return true;
}

/// dr/dq follows from S, the constant mass and dr/dv.
Status MaximalSystem::solve_transposed(In b, Out mu, Out by_q, Out by_v) noexcept {
  const Weights w = eliminated_weights_;
  TransposedElimination& transposed = *elimination_->transposed();
  transposed.solve_transposed(b, mu);
  mu_.assign(mu.begin(), mu.end());
  std::ranges::fill(force_, 0.0);
  transposed.add_by_rates(force_);
  std::ranges::copy(In(force_).subspan(held()), by_v.begin());
  for (std::size_t k = 0; k + held() < 3 * mass_.size(); ++k) {
    const std::size_t point = (k + held()) / 3, axis = (k + held()) % 3;
    if (needs_.derivatives) {
      const double* block = &blocks_[9 * point + axis];
      const double* of_point = &mu[3 * point - held()];
      by_v[k] += block[0] * of_point[0] + block[3] * of_point[1] + block[6] * of_point[2];
    }
    by_q[k] = (b[k] - w.vel * by_v[k] - w.acc * mass_[point] * mu[k]) / w.pos;
  }
  const std::size_t others = 3 * mass_.size() - held();
  for (std::size_t i = 0; i < strand_.inertia.size(); ++i) {
    const std::size_t k = others + i;
    by_q[k] = (b[k] - w.vel * by_v[k] - w.acc * strand_.inertia[i] * mu[k]) / w.pos;
  }
  return all_finite(mu) ? Status::ok : Status::retry;
}

std::vector<double> MaximalSystem::constants() const {
  if (elimination_ == nullptr || elimination_->transposed() == nullptr) return {};
  std::vector<double> all(mass_);
  all.insert(all.end(), strand_.inertia.begin(), strand_.inertia.end());
  const std::vector<double> elastic = elimination_->transposed()->constants();
  all.insert(all.end(), elastic.begin(), elastic.end());
  return all;
}

void MaximalSystem::place_transposed(double t, In q, In v, In a, In mu) noexcept {
  place(t, q, v);
  a_transposed_.assign(a.begin(), a.end());
  mu_.assign(mu.begin(), mu.end());
  elimination_->transposed()->place_transposed(placement(), mu);
}

/// Uniform accelerations load masses.
void MaximalSystem::add_by_constants(InOut by) noexcept {
  const Vec uniform = uniform_acceleration(strand_.effects);
  for (std::size_t point = 1; point < mass_.size(); ++point) {
    const std::size_t k = 3 * point - held();
    by[point] += dot(load3(&a_transposed_[k]) - uniform, load3(&mu_[k]));
  }
  const std::size_t others = 3 * mass_.size() - held();
  for (std::size_t i = 0; i < strand_.inertia.size(); ++i) {
    by[mass_.size() + i] += a_transposed_[others + i] * mu_[others + i];
  }
  elimination_->transposed()->add_by_constants(
      by.subspan(mass_.size() + strand_.inertia.size()));
}

double MaximalSystem::power_of_loads(System& other) noexcept {
  auto* const of = dynamic_cast<MaximalSystem*>(&other);
  if (of == nullptr || of->mass_.size() != mass_.size()) return std::nan("");
  const Points p = points(needs_ | of->needs_);
  std::ranges::fill(load_, 0.0);
  for (const auto& effect : of->strand_.effects) effect->add_load(pose_time_, p, load_);
  const std::size_t moving = 3 * (mass_.size() - 1);  // node 0 is clamped
  return scalar_product(In(mu_).first(moving), In(load_).subspan(3, moving));
}

}  // namespace tress::models
