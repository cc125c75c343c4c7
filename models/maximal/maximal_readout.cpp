// Readouts of a strand of redundant coordinates: energy, momentum, positions, and the
// location of numbers that are not finite.
#include <algorithm>
#include <cmath>

#include "linear/vector_ops.h"
#include "models/maximal/maximal_system.h"
#include "models/strand/not_finite.h"

namespace tress::models {

Energy MaximalSystem::energy(double t, In q, In v) {
  place(t, q, v);
  const Points p = points({.position = true, .velocity = true});
  Energy e;
  for (std::size_t i = 0; i < mass_.size(); ++i) {
    const Vec u = load3(&v_[3 * i]);
    e.kinetic += mass_[i] / 2 * dot(u, u);
  }
  const std::size_t others = z_.size() - strand_.inertia.size();
  for (std::size_t i = 0; i < strand_.inertia.size(); ++i) {
    e.kinetic += strand_.inertia[i] / 2 * rate_[others + i] * rate_[others + i];
  }
  e.potential = strand_.elasticity->energy(placement());
  for (const auto& effect : strand_.effects) e.potential += effect->potential(t, p);
  return e;
}

double MaximalSystem::power(double t, In q, In v) {
  place(t, q, v);
  const Points p =
      points({.position = true, .velocity = true, .tangent = needs_.tangent});
  double sum = strand_.elasticity->power(placement());
  for (const auto& effect : strand_.effects) sum += effect->power(t, p);
  return sum + root_power(t, q, v);
}

/// r = G^T lambda with g'' = 0.
Status MaximalSystem::constrained_acceleration(double t, In q, In v, Out a) noexcept {
  ConstraintSet& constraints = *strand_.constraints;
  const Pattern& gradient = constraints.pattern();
  std::vector<double> g(static_cast<std::size_t>(gradient.nonzeros()));
  std::vector<double> lambda(static_cast<std::size_t>(gradient.cols));
  if (!kkt_) kkt_ = std::make_unique<Kkt>(strand_.solver, pattern_, gradient);
  std::ranges::fill(a, 0.0);
  for (const Status s :
       {values(t, q, v, a, {1, 0, 0}, values_), constraints.gradient(t, q, g),
        kkt_->factor(values_, g, g), residual(t, q, v, a, scratch_),
        constraints.bias(t, q, v, lambda)}) {
    if (s != Status::ok) return s;
  }
  for (std::size_t i = 0; i < a.size(); ++i) a[i] = -scratch_[i];
  for (double& bias : lambda) bias = -bias;
  return kkt_->solve(a, lambda);
}

/// Power of the clamp: on node 0, to hold it on its path, and through constraints.
double MaximalSystem::root_power(double t, In q, In v) {
  if (strand_.root.fixed() || !regular_mass_) return 0;
  if (!strand_.clamped && !strand_.constraints) return 0;
  std::vector<double> a(q.size());
  const Status s = strand_.constraints ? constrained_acceleration(t, q, v, a)
                                       : acceleration(t, q, v, a);
  if (s != Status::ok) return std::nan("");
  place(t, q, v);
  forces(t, a);
  return scalar_product(force_, rate_);
}

std::optional<Momentum> MaximalSystem::momentum(double t, In q, In v) {
  place(t, q, v);
  points({.position = true, .velocity = true});
  Vec linear, angular = strand_.elasticity->spin(placement(), strand_.inertia);
  for (std::size_t i = 0; i < mass_.size(); ++i) {
    const Vec p = mass_[i] * load3(&v_[3 * i]);
    linear = linear + p;
    angular = angular + cross(load3(&x_[3 * i]), p);
  }
  return Momentum{{linear.x, linear.y, linear.z}, {angular.x, angular.y, angular.z}};
}

void MaximalSystem::positions(double t, In q, Out x) {
  place(t, q);
  for (std::size_t i = 0; i < strand_.shown.size(); ++i) {
    store3(strand_.shown[i].of(z_), &x[3 * i]);
  }
}

void MaximalSystem::velocities(double t, In q, In v, Out u) {
  place(t, q, v);
  for (std::size_t i = 0; i < strand_.shown.size(); ++i) {
    store3(strand_.shown[i].of(rate_), &u[3 * i]);
  }
}

/// Points are linear in the nodes.
void MaximalSystem::accelerations(double t, In q, In v, In a, Out x) {
  place(t, q, v);
  std::ranges::copy(a, force_.begin() + static_cast<std::ptrdiff_t>(held()));
  if (strand_.clamped) store3(pose_.a, force_.data());
  for (std::size_t i = 0; i < strand_.shown.size(); ++i) {
    store3(strand_.shown[i].of(force_), &x[3 * i]);
  }
}

std::optional<std::array<double, 9>> MaximalSystem::end_frame(double t, In q) {
  place(t, q);
  const std::optional<Frame> last = strand_.elasticity->end_frame(placement());
  if (!last) return {};
  std::array<double, 9> axes;
  store9(*last * strand_.to_tip, axes.data());
  return axes;
}

MaterialPoints::Mean MaximalSystem::mean_of(const NodeMean& at) const {
  Mean mean;
  for (int k = 0; k < at.nodes; ++k) {
    const int coordinate = 3 * (at.first + k) - static_cast<int>(held());
    if (coordinate < 0) continue;  // of the clamp
    const auto entry = static_cast<std::size_t>(mean.count++);
    mean.coordinate[entry] = coordinate;
    mean.weight[entry] = at.weight[static_cast<std::size_t>(k)];
  }
  return mean;
}

std::optional<MaterialPoints::Mean> MaximalSystem::mean(int point) {
  return mean_of(strand_.shown[static_cast<std::size_t>(point)]);
}

std::optional<double> MaximalSystem::stretch(double t, In q) {
  place(t, q);
  double most = strand_.elasticity->stretch(placement());
  for (std::size_t i = 0; i < strand_.edges.size(); ++i) {
    const Vec e = load3(&z_[3 * i + 3]) - load3(&z_[3 * i]);
    most = std::max(most, std::abs(norm(e) / strand_.edges[i] - 1));
  }
  return most;
}

std::string MaximalSystem::not_finite(double t, In q, In v) {
  const std::size_t first = strand_.clamped ? 1 : 0;  // node of the first coordinates
  const std::size_t nodes = 3 * (static_cast<std::size_t>(strand_.nodes) - first);
  const auto of_coordinates = [&](In x, const std::string& what) {
    return first_words(
        [&] { return not_finite_place(x.first(nodes), 3, what + " of node", first); },
        [&] {
          return not_finite_place(x.subspan(nodes), 1,
                                  what + " beyond the nodes, number");
        });
  };
  return first_words([&] { return of_coordinates(q, "coordinates"); },
                     [&] { return of_coordinates(v, "rates"); },
                     [&] {
                       place(t, q, v);
                       return not_finite_clamp(pose_.x, pose_.v, pose_.a);
                     },
                     [&] { return not_finite_load(strand_.effects, t, points(needs_)); },
                     [&] {
                       std::ranges::fill(force_, 0.0);
                       strand_.elasticity->add_force(placement(), force_);
                       return of_coordinates(In(force_).subspan(held()), "elasticity");
                     });
}

}  // namespace tress::models
