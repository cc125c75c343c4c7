#include "simulation/scene/joined_start.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "contract/input_error.h"
#include "integrators/formulation/dynamics.h"
#include "integrators/formulation/projection.h"
#include "models/joints/joined_system.h"

namespace tress::simulation {
namespace {

/// Gap of a joint, over the length, up to which strands are projected onto it, and at
/// which its points count as coincident.
constexpr double near_joint = 1e-6, on_joint = 64 * 2.2e-16;

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
