#include "simulation/scene/joined_start.h"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <optional>

#include "contract/input_error.h"
#include "integrators/formulation/dynamics.h"
#include "integrators/formulation/projection.h"
#include "linear/dense_algebra.h"
#include "models/joints/joined_system.h"

namespace tress::simulation {
namespace {

/// Gap of a joint, over the length, up to which strands are projected onto it, and at
/// which its points count as coincident.
constexpr double near_joint = 1e-6, on_joint = 64 * 2.2e-16;

/// Gradients of the constraints of these rows, over the length for changes of typical
/// size. One column for each row.
Eigen::MatrixXd gradients(models::JoinedSystem& system, In q, In q_typ,
                          const std::vector<int>& rows) {
  const Pattern& pattern = system.rows().pattern();
  std::vector<double> values(static_cast<std::size_t>(pattern.nonzeros()));
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(std::ssize(q), std::ssize(rows));
  if (system.rows().gradient(0, q, values) != Status::ok) return all;
  for (Eigen::Index k = 0; k < all.cols(); ++k) {
    const auto column = static_cast<std::size_t>(rows[static_cast<std::size_t>(k)]);
    for (int p = pattern.start[column]; p < pattern.start[column + 1]; ++p) {
      const auto entry = static_cast<std::size_t>(p);
      const auto row = static_cast<std::size_t>(pattern.row[entry]);
      all(pattern.row[entry], k) += values[entry] * q_typ[row];
    }
  }
  return all / system.rows().length();
}

/// The joint whose points the strands cannot keep together in a motion of first order,
/// although they could if they were bent; none: there is no such joint. Strands that do
/// not stretch are so between points as far apart as they are long. A redundant joint
/// remains redundant where they bend.
std::optional<std::size_t> taut_joint(models::JoinedSystem& system, In q) {
  constexpr double singular = 1e-7;  // of the largest pivot
  constexpr double bent = 1e-2;      // of the typical sizes
  std::vector<double> q_typ(q.size()), v_typ(q.size()), moved(q.begin(), q.end());
  system.scale(q_typ, v_typ);
  for (std::size_t i = 0; i < q.size(); ++i) {
    moved[i] += bent * q_typ[i] * std::sin(1.0 + 7 * static_cast<double>(i));
  }
  std::vector<int> rows;
  for (int k = 0; k < system.rows().rows(); ++k) {
    if (!system.rows().turns(k)) rows.push_back(k);
  }
  if (rows.empty()) return {};
  // The multipliers that pull at no coordinate.
  const auto idle = [&](In at) {
    return null_space(gradients(system, at, q_typ, rows), singular);
  };
  const Eigen::MatrixXd here = idle(q);
  if (here.cols() <= idle(moved).cols()) return {};
  std::vector<double> kept(static_cast<std::size_t>(system.rows().rows()));
  for (std::size_t k = 0; k < rows.size(); ++k) {
    kept[static_cast<std::size_t>(rows[k])] =
        here(static_cast<Eigen::Index>(k), here.cols() - 1);
  }
  std::size_t most = 0;
  double share = -1;
  for (std::size_t j = 0; j < system.joints(); ++j) {
    const In own = system.rows().of_joint(kept, j);
    double sum = 0;
    for (const double x : own) sum += x * x;
    if (sum > share) most = j;
    share = std::max(share, sum);
  }
  return most;
}

}  // namespace

void begin_on_joints(System& of, const std::vector<std::string>& places) {
  auto& system = dynamic_cast<models::JoinedSystem&>(of);
  const Layout layout = system.layout();
  if (layout.constraints == 0) return;
  const auto n = static_cast<std::size_t>(layout.coordinates);
  std::vector<double> q(n), v(n), zero(n),
      g(static_cast<std::size_t>(layout.constraints));
  system.initial_state(q, v);
  const double length = system.rows().length();
  double largest = 0;
  refuse_if(system.rows().value(0, q, g) != Status::ok, "a start that is not finite",
            places.front(), "change the shapes of the strands");
  for (std::size_t j = 0; j < system.joints(); ++j) {
    const In own = system.rows().of_joint(g, j);
    if (own.empty()) continue;
    const Vec gap = load3(own.data());
    largest = std::max(largest, norm(gap));
    refuse_if(norm(gap) > near_joint * length,
              fmt::format("the points of a joint begin {:.3g} m apart", norm(gap)),
              places[j],
              fmt::format("move the strand of b by [{:.9g}, {:.9g}, {:.9g}], or give "
                          "shapes that meet",
                          0 - gap.x, 0 - gap.y, 0 - gap.z));
  }
  if (const auto joint = taut_joint(system, q)) {
    throw InputError(
        "joined strands that are taut: as long as the way between the points "
        "that hold them, they cannot move without a stretch",
        places[*joint],
        "give them slack or a shape that is bent, or use a model that "
        "stretches, such as \"der\"");
  }
  integrators::Dynamics dynamics(system, {.formulation = Formulation::index3, .own = {}});
  integrators::Projection projection(dynamics);
  Status s = Status::ok;
  if (largest > on_joint * length) {
    s = projection.project(0, q, v);
  } else {
    s = dynamics.linearize(0, q, v, zero, g, {1, 0, 0});
    if (s == Status::ok) s = projection.velocities(0, q, v);
  }
  refuse_if(s != Status::ok, "no start that the joints admit", places.front(),
            "give strands that begin at rest, or leave out a joint");
  system.begin_at(q, v);
}

}  // namespace tress::simulation
