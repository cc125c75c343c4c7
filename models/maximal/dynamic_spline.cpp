#include "models/maximal/dynamic_spline.h"

#include "models/constrained/joints.h"
#include "models/input_error.h"
#include "models/math/gauss_legendre.h"
#include "models/maximal/cubic_spline.h"
#include "models/maximal/nodal_strand.h"
#include "models/maximal/spline_elasticity.h"
#include "models/strand/strand_parameters.h"

namespace tress {
namespace {

constexpr int mass_points = 4, bend_points = 2;

/// n + 2 over all n spans, one for each motion along a straight strand that stretches it.
int stretch_points(std::size_t span, std::size_t spans) {
  if (spans == 1) return 3;
  return span == 0 || span + 1 == spans ? 2 : 1;
}

void check_describable(const Strand& strand) {
  const auto refuse = [](bool wrong, const std::string& what, const std::string& remedy) {
    if (wrong) throw InputError(what, "dynamic_spline", remedy);
  };
  check_unbranched(strand, "dynamic_spline");
  refuse(strand.material.internal_friction != 0,
         "friction of bending needs a material frame, which a spline has not",
         "set internal_friction_kg_m3_s = 0; drag and mass damping are there");
  for (const Segment& segment : strand.segments) {
    refuse(dot(segment.natural, segment.natural) != 0,
           "a natural curvature or twist needs a material frame, which a spline has not",
           "use a naturally straight strand, or der, corde or super_helix");
    refuse(segment.section.a1 != segment.section.a2,
           "an elliptic section needs a material frame, which a spline has not",
           "set ellipticity = 1");
  }
}

NodeMean node_mean(std::size_t span, const CubicSpline::Basis& basis) {
  return {static_cast<int>(span), 4, basis.value};
}

/// r = root and r' . e1 = r' . e2 = 0; r' at the root is along the first two controls.
std::unique_ptr<ConstraintSet> clamp(const Strand& strand, std::size_t controls) {
  const double l = strand.segments.front().length;
  std::vector<Anchor> anchors;
  for (const Vec& offset : {Vec{}, Vec{0, l, 0}, Vec{0, 0, l}}) {
    anchors.push_back(root_anchor(strand.root, offset));
  }
  const auto anchor = [](int i) { return Node{Node::Kind::anchor, i}; };
  const auto control = [](int i) { return Node{Node::Kind::particle, i}; };
  Constraints constraints;
  constraints.push_back(fixed_point(control(0), anchor(0)));
  for (const int axis : {1, 2}) {
    constraints.push_back(across(control(1), anchor(0), anchor(axis), l));
  }
  return std::make_unique<ConstraintSet>(std::move(constraints), std::move(anchors),
                                         static_cast<int>(controls), 0, strand.length());
}

}  // namespace

std::unique_ptr<System> dynamic_spline(const Strand& strand,
                                       const DynamicSplineOptions& options,
                                       Effects effects) {
  check_describable(strand);
  std::vector<double> lengths;
  for (const Segment& segment : strand.segments) lengths.push_back(segment.length);
  const CubicSpline spline(lengths);
  const bool clamped = !strand.free_root.has_value();
  MaximalStrand parts;
  parts.clamped = false;  // by multipliers
  parts.nodes = static_cast<int>(spline.controls());
  parts.root = strand.root;
  // Starts as a rigid body; the control points move with it.
  const RootStart root = root_start(strand);
  for (const Vec& x : spline.through(joints(strand, ShapeOf::initial, root.place))) {
    const Vec v = root.velocity_of(x);
    parts.z.insert(parts.z.end(), {x.x, x.y, x.z});
    parts.rate.insert(parts.rate.end(), {v.x, v.y, v.z});
  }
  parts.z_typ.assign(parts.z.size(),
                     strand.length() / static_cast<double>(spline.spans()));
  parts.z_rate.assign(parts.z.size(), parts.z_typ.front() * typical_rate(strand));

  std::vector<SplineElasticity::Point> points;
  for (std::size_t i = 0; i < spline.spans(); ++i) {
    const CrossSection& section = strand.segments[i].section;
    const double modulus = strand.material.youngs_modulus, l = lengths[i];
    for (const auto& [along, weight] : gauss_legendre(mass_points, l)) {
      parts.mass.push_back({node_mean(i, spline.at(i, along)),
                            strand.material.density * section.area() * weight, weight});
    }
    for (const auto& [along, weight] : gauss_legendre(bend_points, l)) {
      const CubicSpline::Basis basis = spline.at(i, along);
      points.push_back(
          {i, basis.first, basis.second, 0, modulus * section.inertia1() * weight});
    }
    for (const auto& [along, weight] :
         gauss_legendre(stretch_points(i, spline.spans()), l)) {
      const CubicSpline::Basis basis = spline.at(i, along);
      points.push_back(
          {i, basis.first, basis.second, modulus * section.area() * weight, 0});
    }
    parts.shown.push_back(node_mean(i, spline.at(i, 0)));
    if (i + 1 == spline.spans()) parts.shown.push_back(node_mean(i, spline.at(i, l)));
  }
  parts.elasticity =
      std::make_unique<SplineElasticity>(spline.spans(), std::move(points));
  if (clamped) parts.constraints = clamp(strand, spline.controls());
  parts.effects = std::move(effects);
  parts.solver = options.solver;
  return std::make_unique<MaximalSystem>(std::move(parts));
}

std::span<const Parameter> dynamic_spline_parameters() {
  static const std::vector<Parameter> all =
      with_strand_parameters(std::array{maximal_solver_parameter});
  return all;
}

std::unique_ptr<System> make_dynamic_spline(const Strand& strand,
                                            const Parameters& parameters,
                                            Effects effects) {
  return dynamic_spline(strand, {.solver = maximal_solver(parameters)},
                        std::move(effects));
}

}  // namespace tress
