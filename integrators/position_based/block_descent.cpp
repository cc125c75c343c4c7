#include "integrators/position_based/block_descent.h"

#include <algorithm>
#include <cmath>

#include "integrators/position_based/position_sweeps.h"

namespace tress::integrators {
namespace {

constexpr int most_halvings = 8;
/// Penalty times the square of the step where the experiment block_descent finds the
/// middle of its window.
constexpr double usual_penalty = 5;

/// Indices of the coordinates that orient() moves.
std::vector<int> oriented(ComplianceForm& form) {
  std::vector<int> all;
  for (const ComplianceForm::Orientation& orientation : form.orientations()) {
    for (std::size_t k = 0; k < 4; ++k) {
      all.push_back(orientation.coordinates[orientation.own + k]);
    }
  }
  return all;
}

}  // namespace

BlockDescent::BlockDescent(System& system, const DescentChoice& choice)
    : choice_(choice),
      form_(*system.compliance_form()),
      blocks_(form_.blocks()),
      nodes_(nodes_of(form_, system.layout().coordinates,
                      choice.oriented ? oriented(form_) : std::vector<int>{})),
      w_(static_cast<std::size_t>(system.layout().coordinates)),
      stiffness_(blocks_.size()),
      lambda_(blocks_.size()),
      last_(w_.size()),
      before_last_(w_.size()),
      force_(w_.size()),
      move_(w_.size()),
      bound_(w_.size()),
      from_(w_.size()) {
  form_.inverse_mass(w_);
  std::vector<double> masses = w_;
  for (double& entry : masses) entry = 1 / entry;
  mixing_ = AndersonMixing(choice.anderson, w_.size(), std::move(masses));
  const std::size_t size =
      choice.block == 0 ? nodes_.size() : static_cast<std::size_t>(choice.block);
  const std::size_t half =
      std::max<std::size_t>(1, size < nodes_.size() ? size / 2 : size);
  map_ = half == size ? 1 : 2;
  for (std::size_t k = 0; k < 2; ++k) {
    windows_[k] = windows_of(form_, system.layout().coordinates, nodes_,
                             k == 0 ? size : half, size);
    order_[k] = sweep_indices(choice.sweep_order, windows_[k].size());
  }
  if (choice.oriented) {
    order_of_orientations_ =
        sweep_indices(choice.sweep_order, form_.orientations().size());
  }
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    for (std::size_t r = 0; r < most_rows; ++r)
      stiffness_[k][r] = 1 / blocks_[k].alpha[r];
  }
}

/// at_, value_ <- block k at x.
void BlockDescent::look(double t, std::size_t k, In x) {
  const std::vector<int>& coordinates = blocks_[k].coordinates;
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    at_[i] = x[static_cast<std::size_t>(coordinates[i])];
  }
  form_.evaluate(t, k, {at_, coordinates.size()}, value_);
}

BlockDescent::Strained BlockDescent::strained(const Step& step, std::size_t k, In x) {
  const Block& block = blocks_[k];
  look(step.t, k, x);
  Strained now;
  for (std::size_t r = 0; r < static_cast<std::size_t>(block.rows); ++r) {
    double moved = step.h * value_.drift[r];
    for (std::size_t i = 0; i < block.coordinates.size(); ++i) {
      const auto from = static_cast<std::size_t>(block.coordinates[i]);
      moved += value_.gradient[r][i] * (at_[i] - step.origin[from]);
    }
    const double gamma = block.alpha[r] * block.friction[r] / step.h;
    const double hidden = 1 - stiffness_[k][r] * block.alpha[r];
    now.strain[r] = value_.c[r] + gamma * moved;
    now.stress[r] = stiffness_[k][r] * now.strain[r] + hidden * lambda_[k][r];
    now.stiffness[r] = stiffness_[k][r] * (1 + gamma);
  }
  return now;
}

void BlockDescent::begin(double t, In q) {
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    look(t, k, q);
    for (std::size_t r = 0; r < static_cast<std::size_t>(blocks_[k].rows); ++r) {
      lambda_[k][r] = blocks_[k].alpha[r] > 0 ? value_.c[r] / blocks_[k].alpha[r] : 0;
    }
  }
}

/// The stiffness of every row, by the size of its gradient at x.
void BlockDescent::limit(const Step& step, In x) {
  const double chosen = choice_.augmentation->penalty;
  const double penalty = chosen > 0 ? chosen : usual_penalty / (step.h * step.h);
  for (std::size_t k = 0; k < blocks_.size(); ++k) {
    const Block& block = blocks_[k];
    look(step.t, k, x);
    for (std::size_t r = 0; r < static_cast<std::size_t>(block.rows); ++r) {
      double softness = 0;  // G W G^T
      for (std::size_t i = 0; i < block.coordinates.size(); ++i) {
        const double slope = value_.gradient[r][i];
        softness += slope * slope * w_[static_cast<std::size_t>(block.coordinates[i])];
      }
      stiffness_[k][r] = std::min(1 / block.alpha[r], penalty / softness);
    }
  }
}

void BlockDescent::improve(const Step& step, In x) {
  for (std::size_t k = 0; k < blocks_.size(); ++k)
    lambda_[k] = strained(step, k, x).stress;
}

void BlockDescent::run(double t, double h, In origin, In target, InOut x, Stats& stats) {
  const Step step{t, h, origin, target};
  if (choice_.augmentation) {
    for (Rows& rows : lambda_) {
      for (double& lambda : rows) lambda *= choice_.augmentation->kept;
    }
    limit(step, x);
  }
  const int period = choice_.augmentation ? choice_.augmentation->sweeps : choice_.sweeps;
  for (int done = 0; done < choice_.sweeps; ++done) {
    const int number = done % period;
    if (number == 0) std::ranges::copy(x, last_.begin());
    if (number == 0) mixing_.restart();
    if (number % map_ == 0) std::ranges::copy(x, from_.begin());
    sweep(step, done, x);
    if (choice_.chebyshev > 0) accelerate(number, x);
    if ((number + 1) % map_ == 0) mixing_.mix(from_, x);
    if (choice_.augmentation && (done + 1) % period == 0) improve(step, x);
    ++stats.sweeps;
  }
}

void BlockDescent::sweep(const Step& step, int number, InOut x) {
  const auto parity = static_cast<std::size_t>(number % 2);
  for (const std::size_t k : order_[parity]) descend(step, windows_[parity][k], x);
  if (choice_.oriented) orient(step, x);
}

void BlockDescent::orient(const Step& step, InOut x) {
  double now[ComplianceForm::most_oriented], origin[ComplianceForm::most_oriented];
  for (const std::size_t k : order_of_orientations_) {
    const auto& [coordinates, own] = form_.orientations()[k];
    const std::size_t size = coordinates.size();
    for (std::size_t i = 0; i < size; ++i) {
      now[i] = x[static_cast<std::size_t>(coordinates[i])];
      origin[i] = step.origin[static_cast<std::size_t>(coordinates[i])];
    }
    form_.orient(step.t, step.h, k, {origin, size}, {now, size});
    for (std::size_t i = own; i < own + 4; ++i) {
      x[static_cast<std::size_t>(coordinates[i])] = now[i];
    }
  }
}

void BlockDescent::descend(const Step& step, Window& window, InOut x) {
  gather(step, window, x);
  const Skyline* matrix = factored(window);
  if (matrix == nullptr) return;
  const std::size_t size = window.coordinates.size();
  std::copy_n(force_.begin(), size, move_.begin());
  matrix->solve(InOut(move_).first(size));
  double drive = 0;
  for (std::size_t i = 0; i < size; ++i) {
    drive += force_[i] * move_[i];
    x[window.coordinates[i]] += move_[i];
  }
  if (choice_.curvature == Curvature::majorised) return;
  for (int halved = 0; halved < most_halvings && push(step, window, x) < -drive;
       ++halved) {
    for (std::size_t i = 0; i < size; ++i) {
      move_[i] /= 2;
      x[window.coordinates[i]] -= move_[i];
    }
    drive /= 2;
  }
}

/// Work of the forces at x along move_.
double BlockDescent::push(const Step& step, const Window& window, In x) {
  double sum = 0;
  for (std::size_t i = 0; i < window.coordinates.size(); ++i) {
    const std::size_t at = window.coordinates[i];
    sum += (step.target[at] - x[at]) / (w_[at] * step.h * step.h) * move_[i];
  }
  for (const Window::Part& part : window.parts) {
    const Strained now = strained(step, part.block, x);
    for (std::size_t i = 0; i < part.at.size(); ++i) {
      if (part.at[i] < 0) continue;
      const double along = move_[static_cast<std::size_t>(part.at[i])];
      for (std::size_t r = 0; r < static_cast<std::size_t>(blocks_[part.block].rows);
           ++r) {
        sum -= now.stress[r] * value_.gradient[r][i] * along;
      }
    }
  }
  return sum;
}

/// force_ <- minus the slope of the action, and H in its two parts.
void BlockDescent::gather(const Step& step, Window& window, In x) {
  window.matrix.clear();
  window.exact.clear();
  for (std::size_t i = 0; i < window.coordinates.size(); ++i) {
    const std::size_t at = window.coordinates[i];
    const double inertia = 1 / (w_[at] * step.h * step.h);
    window.matrix.at(i, i) = inertia;
    force_[i] = inertia * (step.target[at] - x[at]);
    bound_[i] = 0;
  }
  for (const Window::Part& part : window.parts) {
    const Strained now = strained(step, part.block, x);
    add(part, now, window);
    if (choice_.curvature != Curvature::none) add_second(step, part, now, window);
  }
}

void BlockDescent::add(const Window::Part& part, const Strained& now, Window& window) {
  const auto rows = static_cast<std::size_t>(blocks_[part.block].rows);
  for (std::size_t i = 0; i < part.at.size(); ++i) {
    if (part.at[i] < 0) continue;
    const auto row = static_cast<std::size_t>(part.at[i]);
    double weighted[most_rows];
    for (std::size_t r = 0; r < rows; ++r) {
      force_[row] -= value_.gradient[r][i] * now.stress[r];
      weighted[r] = now.stiffness[r] * value_.gradient[r][i];
    }
    for (std::size_t j = 0; j < part.at.size(); ++j) {
      if (part.at[j] < 0 || part.at[j] > part.at[i]) continue;
      double& entry = window.matrix.at(row, static_cast<std::size_t>(part.at[j]));
      for (std::size_t r = 0; r < rows; ++r) entry += weighted[r] * value_.gradient[r][j];
    }
  }
}

void BlockDescent::add_second(const Step& step, const Window::Part& part,
                              const Strained& now, Window& window) {
  ComplianceForm::Second second = {};
  if (!form_.add_second(step.t, part.block, {at_, part.at.size()}, now.stress, second)) {
    return;
  }
  for (std::size_t i = 0; i < part.at.size(); ++i) {
    if (part.at[i] < 0) continue;
    const auto row = static_cast<std::size_t>(part.at[i]);
    for (std::size_t j = 0; j < part.at.size(); ++j) {
      if (part.at[j] < 0) continue;
      bound_[row] += std::abs(second[i][j]);
      if (part.at[j] > part.at[i]) continue;
      window.exact.at(row, static_cast<std::size_t>(part.at[j])) += second[i][j];
    }
  }
}

/// The factor of H, or of its majoriser. Null: the state is not finite.
const Skyline* BlockDescent::factored(Window& window) {
  if (choice_.curvature == Curvature::exact) {
    window.exact.add(window.matrix);
    if (window.exact.factor()) return &window.exact;
  }
  if (choice_.curvature != Curvature::none) {
    for (std::size_t i = 0; i < window.matrix.size(); ++i) {
      window.matrix.at(i, i) += bound_[i];
    }
  }
  return window.matrix.factor() ? &window.matrix : nullptr;
}

/// After sweep `number`, of those whose limit is one.
void BlockDescent::accelerate(int number, InOut x) {
  const double square = choice_.chebyshev * choice_.chebyshev;
  if (number == 0) omega_ = 1;
  if (number == 1) omega_ = 2 / (2 - square);
  if (number > 1) omega_ = 4 / (4 - square * omega_);
  if (number > 0) {
    for (std::size_t i = 0; i < x.size(); ++i) {
      x[i] = omega_ * (x[i] - before_last_[i]) + before_last_[i];
    }
  }
  before_last_.swap(last_);
  std::ranges::copy(x, last_.begin());
}

}  // namespace tress::integrators
