#include "experiments/statics/path_rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "models/strand/arc_lengths.h"

namespace tress::experiments::statics {
namespace {

using simulation::Column;
using simulation::Row;

constexpr Column columns_of_paths[] = {
    {"scene", "name of the scene"},
    {"model", "model of the strand"},
    {"strand", "number of the strand in the scene, from 1"},
    {"elements", "number of elements of the strand"},
    {"over", "parameter of the path: gravity, a point force, the supports, or a number"},
    {"point", "number of the point along the path, from 0"},
    {"event",
     "start; limit_point: the parameter turns back; bifurcation: another eigenvalue "
     "crosses 0; branch: the path leaves a bifurcation; end. closed: the path is back at "
     "the first point of its branch. Empty: none"},
    {"parameter", "value of the parameter"},
    {"unit",
     "unit of the parameter. 1: a factor on the load of the scene; s: time of the "
     "keyframes of supports"},
    {"displacement_m",
     "displacement since the start along the load: of the place of the point force, of "
     "the support that moves, or of the tip. Over a number: distance of the tip"},
    {"force_n",
     "point force, or force of the support that moves on the strand, along its way. "
     "Empty: neither"},
    {"tip_x_m", "tip, x"},
    {"tip_y_m", "tip, y"},
    {"tip_z_m", "tip, z"},
    {"energy_j", "elastic energy and potential of the loads"},
    {"stability",
     "stable; unstable; critical at a limit point or bifurcation. Small motions with all "
     "supports"},
    {"eigenvalue_least",
     "least eigenvalue of the stiffness over EI/L, in typical sizes of the coordinates, "
     "on the displacements that constraints allow. At critical points it is the one "
     "nearest to 0. Where symmetric is false it is the least real part of omega^2 over "
     "EI/(rho A L^4)"},
    {"negative_eigenvalues", "number of eigenvalues below 0"},
    {"crossing", "number of eigenvalues that cross 0 at a limit point or bifurcation"},
    {"neutral_modes",
     "number of displacements without energy, such as the spin of a straight strand "
     "about itself"},
    {"symmetric", "false: loads follow the strand, and the stiffness is unsymmetric"},
    {"residual_rel",
     "largest |residual| times the typical size of its coordinate, over EI/L"},
    {"gap_rel", "largest violation of a constraint, over the length"},
    {"correction_rel", "last correction of Newton's method, over typical sizes"},
    {"newton_iterations", "iterations of Newton's method"},
    {"arclength", "length along the path from the start, in the metric of the steps"},
};

Vec point_of(const PathPoint& at, std::size_t i) { return load3(&at.x[3 * i]); }

Vec unit_or_zero(const Vec& x) { return norm(x) > 0 ? (1 / norm(x)) * x : Vec{}; }

/// Ends of the elements around an arc length.
void place_at(StaticStrand& strand, double share, Gauge& gauge) {
  const std::vector<double> s = models::arc_lengths(strand.strand());
  const double arc = share * s.back();
  const auto after = std::upper_bound(s.begin(), s.end() - 1, arc * (1 + 1e-12));
  const auto i = static_cast<std::size_t>(after - s.begin()) - 1;
  gauge.point = i;
  gauge.part = std::clamp((arc - s[i]) / (s[i + 1] - s[i]), 0.0, 1.0);
  if (gauge.part < 1e-9) gauge.part = 0;
}

void gauge_point_force(StaticStrand& strand, Gauge& gauge) {
  const Parameters& load = strand.scene().effects[strand.varied().effect].parameters;
  const double at = load.number("at");
  place_at(strand, at, gauge);
  gauge.place = fmt::format("the place of the force (at {:g})", at);
  const Vec force = load.vec("force_n");
  if (norm(force) > 0) {
    gauge.direction = unit_or_zero(force);
    gauge.force = norm(force);
    return;
  }
  gauge.force = load.number("follower_n");
}

void gauge_supports(StaticStrand& strand, Gauge& gauge) {
  constexpr int samples = 32;
  double farthest = 0;
  for (std::size_t i = 0; i < strand.supports().size(); ++i) {
    const models::Support& support = strand.supports()[i];
    const Vec begin = support.path.at(0).x;
    for (int k = 1; k <= samples; ++k) {
      const Vec way = support.path.at(strand.varied().to * k / samples).x - begin;
      if (support.axes.empty() || norm(way) <= farthest * (1 + 1e-9)) continue;
      farthest = norm(way);
      gauge.direction = unit_or_zero(way);
      gauge.support = i;
      gauge.path = support.path;
      gauge.point = static_cast<std::size_t>(support.point);
      gauge.part = 0;
      gauge.place = "the support that moves";
    }
  }
}

}  // namespace

std::span<const Column> path_columns() { return columns_of_paths; }

double Gauge::displacement(const PathPoint& first, const PathPoint& at) const {
  if (support) {  // a compliant one moves further than the strand
    return dot(path.at(at.at.value).x - path.at(first.at.value).x, direction);
  }
  Vec moved = point_of(at, point) - point_of(first, point);
  if (part > 0) {
    moved = (1 - part) * moved +
            part * (point_of(at, point + 1) - point_of(first, point + 1));
  }
  return norm(direction) > 0 ? dot(moved, direction) : norm(moved);
}

double Gauge::force_at(const PathPoint& at) const {
  if (support) return dot(at.forces[*support], direction);
  return force != 0 ? force * at.at.value : std::nan("");
}

Gauge gauge(StaticStrand& strand) {
  Gauge of;
  of.point = strand.strand().segments.size();
  of.place = "the tip";
  const Varied& varied = strand.varied();
  if (varied.kind == Varied::Kind::point_force) gauge_point_force(strand, of);
  if (varied.kind == Varied::Kind::supports) gauge_supports(strand, of);
  if (varied.kind == Varied::Kind::gravity) {
    of.direction = unit_or_zero(
        strand.scene().effects[varied.effect].parameters.vec("gravity_m_s2"));
  }
  return of;
}

std::vector<Row> path_rows(const std::vector<PathPoint>& path, const Gauge& gauge,
                           const Varied& varied, const Row& identity) {
  std::vector<Row> rows;
  for (const PathPoint& point : path) {
    Row& row = rows.emplace_back(identity);
    row.set("point", rows.size() - 1).set("event", name(point.event));
    row.set("parameter", point.at.value).set("unit", varied.unit);
    if (!point.failure.empty()) {
      row.failed(point.x.empty() ? "diverged" : "unverified", point.failure);
    }
    if (point.x.empty()) continue;
    row.set("displacement_m", gauge.displacement(path.front(), point));
    row.set("force_n", gauge.force_at(point));
    const Vec tip = load3(&point.x[point.x.size() - 3]);
    row.set("tip_x_m", tip.x).set("tip_y_m", tip.y).set("tip_z_m", tip.z);
    row.set("energy_j", point.energy);
    const Stability& of = point.stability;
    const bool critical =
        point.event == Event::limit_point || point.event == Event::bifurcation;
    const bool stable = of.negative == 0 && !of.oscillates;
    row.set("stability", critical ? "critical" : stable ? "stable" : "unstable");
    if (of.values.size() > 0) {
      Eigen::Index least = 0;
      if (critical) of.values.cwiseAbs().minCoeff(&least);
      row.set("eigenvalue_least", of.values[least]);
    }
    row.set("negative_eigenvalues", of.negative);
    if (critical) row.set("crossing", point.crossing);
    row.set("neutral_modes", of.neutral.cols()).set("symmetric", of.symmetric);
    row.set("residual_rel", point.residual).set("gap_rel", point.gap);
    row.set("correction_rel", point.correction);
    row.set("newton_iterations", point.iterations);
    row.set("arclength", point.arclength);
  }
  return rows;
}

std::string shapes_csv(const std::vector<PathPoint>& path) {
  std::string text = "point,event,parameter,node,x_m,y_m,z_m\n";
  for (std::size_t k = 0; k < path.size(); ++k) {
    const PathPoint& point = path[k];
    for (std::size_t i = 0; i < point.x.size(); i += 3) {
      text += fmt::format("{},{},{},{},{},{},{}\n", k, name(point.event),
                          number_text(point.at.value), i / 3, number_text(point.x[i]),
                          number_text(point.x[i + 1]), number_text(point.x[i + 2]));
    }
  }
  return text;
}

}  // namespace tress::experiments::statics
