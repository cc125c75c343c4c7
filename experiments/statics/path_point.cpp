#include "experiments/statics/path_point.h"

#include <fmt/format.h>

#include <cmath>

namespace tress::experiments::statics {
namespace {

constexpr double verified = 1e-7;  // largest residual and gap of an equilibrium

/// Also takes what is not a number.
void take_larger(double x, double& most) {
  if (!(x <= most)) most = x;
}

}  // namespace

std::string_view name(Event event) {
  switch (event) {
    case Event::start:
      return "start";
    case Event::limit_point:
      return "limit_point";
    case Event::bifurcation:
      return "bifurcation";
    case Event::branch:
      return "branch";
    case Event::closed:
      return "closed";
    case Event::end:
      return "end";
    default:
      return "";
  }
}

PathPoint measured_point(StaticStrand& strand, const Balance& at, const Newton& newton,
                         int neutral_modes) {
  PathPoint point;
  point.at = at;
  point.stability = stability(strand, at, neutral_modes);
  point.iterations = newton.iterations;
  point.correction = newton.last;
  const Eigen::VectorXd r = strand.residual(at);
  const Eigen::Index n = at.q.size();
  for (Eigen::Index i = 0; i < n; ++i) {
    take_larger(std::abs(r[i]) / strand.units()[i], point.residual);
  }
  for (Eigen::Index k = n; k < r.size(); ++k) {
    take_larger(std::abs(r[k]) / strand.length(), point.gap);
  }
  point.x = strand.points(at);
  point.energy = strand.energy(at);
  for (std::size_t i = 0; i < strand.supports().size(); ++i) {
    point.forces.push_back(strand.support_force(at, i));
  }
  if (!(point.residual <= verified && point.gap <= verified)) {
    point.failure = fmt::format("not in balance: residual {:.2g}, gap {:.2g}",
                                point.residual, point.gap);
  }
  return point;
}

}  // namespace tress::experiments::statics
