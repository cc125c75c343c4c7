#include <algorithm>

#include "contract/input_error.h"
#include "math/gauss_legendre.h"
#include "models/constrained/joints.h"
#include "models/entry.h"
#include "models/maximal/maximal_system.h"
#include "models/maximal/nodal_strand.h"
#include "models/splines/cubic_spline.h"
#include "models/splines/framed_spline.h"

namespace tress::models {
namespace {

/// Dynamic spline [Lenoir et al. 2004; Theetten et al. 2008]: the centreline is a cubic
/// B-spline (cubic_spline.h) whose control points are coordinates. Knots are the joints
/// of segments; each has an angle theta for the material frame. With s the arc length at
/// rest, t = r'/|r'| and `rest` in the natural shape,
///
///     E = int EA (|r'| - |r'|_rest)^2/2 + EI1 (kappa_1 - kappa_1rest)^2/2
///         + EI2 (kappa_2 - kappa_2rest)^2/2 ds + sum_spans GJ (phi - phi_rest)^2/(2 h),
///     friction = gamma on the rates of kappa_1, kappa_2 and phi/h,
///
/// where kappa = t x t' = r' x r''/|r'|^2 is the geometrically exact curvature per length
/// at rest. It is taken along the axes of the section (SplineBend). phi is the twist of a
/// span of length h between the frames at its ends (SplineTwist, whole turns counted).
/// Rest strains are those of the spline through the natural shape.
///
/// Mass rho A int N_k N_l ds is consistent (four Gauss points per span, exact). Bending
/// is summed over two points per span, stretching over n + 2 in all: one per span and
/// another in the first and the last. A straight strand has n + 2 stretching modes. With
/// two or three points in every span, the unavoidable stretch of a bent cubic, about EA
/// h^6, costs a hair of ten spans two digits (EA L^2/EI = 4e6). The inertia rho (I1 + I2)
/// is lumped at the angles, with theta' for the section's spin as in der.cpp. A free
/// strand conserves momentum and energy up to the share of this term, about (r/L)^2.
///
/// Plane bending is of order 4: statics, and frequencies, which are (beta h)^4/1440 too
/// high. Twisting is of order 2: torsional frequencies are (beta h)^2/24 too low. The
/// initial shape is interpolated: its length is off by O(h^4).
///
/// Clamped by multipliers: r = r_0(t) (3 rows) and r' orthogonal to e1 and e2 of the
/// clamp (2 rows), whose frame is that of the first knot. Frames at the other knots are
/// functions of q relative to reference frames, like those of edges in der.cpp.
///
/// Without twist there are neither angles nor frames, and bending is EI |kappa|^2/2. This
/// is exact for a naturally straight rod of circular section with a free tip, up to the
/// omitted rotational inertia of the section. The twisting moment of such a rod is 0
/// everywhere. Natural curvature or twist, other sections and internal friction are then
/// InputErrors.
struct DynamicSplineOptions {
  bool twist = true;  // angles and frames
  LinearKind solver = LinearKind::automatic;
};

constexpr int mass_points = 4, bend_points = 2;

/// n + 2 over all n spans, one per stretching mode of a straight strand.
int stretch_points(std::size_t span, std::size_t spans) {
  if (spans == 1) return 3;
  return span == 0 || span + 1 == spans ? 2 : 1;
}

/// Rejects strands that need the terms omitted without twist.
void check_frameless(const Strand& strand) {
  const auto refuse = [](bool wrong, const std::string& what, const std::string& remedy) {
    if (wrong) throw InputError(what, "dynamic_spline", remedy);
  };
  refuse(strand.material.internal_friction != 0,
         "friction of bending needs a material frame, which twist = none leaves out",
         "set twist = dynamic, or internal_friction_kg_m3_s = 0");
  for (const Segment& segment : strand.segments) {
    refuse(dot(segment.natural, segment.natural) != 0,
           "a natural curvature or twist needs a material frame, which twist = none "
           "leaves out",
           "set twist = dynamic, or use a naturally straight strand");
    refuse(segment.section.a1 != segment.section.a2,
           "an elliptic section needs a material frame, which twist = none leaves out",
           "set twist = dynamic, or ellipticity = 1");
  }
}

NodeMean node_mean(std::size_t span, const CubicSpline::Basis& basis) {
  return {static_cast<int>(span), 4, basis.value};
}

/// A shape as control points, with the material frames at the knots turned on the
/// shortest way onto r'.
FramedSpline::Shape shape_of(const Strand& strand, const CubicSpline& spline, ShapeOf of,
                             const StrandPlace& root) {
  const std::vector<StrandPlace> places = joints(strand, of, root);
  FramedSpline::Shape shape;
  for (const Vec& x : spline.through(places)) {
    shape.controls.insert(shape.controls.end(), {x.x, x.y, x.z});
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const std::size_t span = i > 0 ? i - 1 : 0;
    const auto basis = spline.at(span, i > 0 ? spline.length(span) : 0);
    shape.frames.push_back(edge_frame(
        places[i].frame, of_controls(basis.first, &shape.controls[3 * span]), 0.0));
  }
  return shape;
}

/// Points of stretching; `natural` are control points.
std::vector<SplineElasticity::Point> stretching(const Strand& strand,
                                                const CubicSpline& spline, In natural) {
  std::vector<SplineElasticity::Point> points;
  for (std::size_t i = 0; i < spline.spans(); ++i) {
    const double stiffness = strand.material_of(strand.segments[i]).youngs_modulus *
                             strand.segments[i].section.area();
    for (const auto& [along, weight] :
         gauss_legendre(stretch_points(i, spline.spans()), spline.length(i))) {
      const CubicSpline::Basis basis = spline.at(i, along);
      const Vec first = of_controls(basis.first, &natural[3 * i]);
      points.push_back(
          {i, basis.first, basis.second, stiffness * weight, 0, norm(first)});
    }
  }
  return points;
}

/// Points of bending without frames, among those of stretching.
std::vector<SplineElasticity::Point> with_bending(
    const Strand& strand, const CubicSpline& spline,
    std::vector<SplineElasticity::Point> points) {
  for (std::size_t i = 0; i < spline.spans(); ++i) {
    const double bending = strand.material_of(strand.segments[i]).youngs_modulus *
                           strand.segments[i].section.inertia1();
    for (const auto& [along, weight] : gauss_legendre(bend_points, spline.length(i))) {
      const CubicSpline::Basis basis = spline.at(i, along);
      points.push_back({i, basis.first, basis.second, 0, bending * weight});
    }
  }
  std::ranges::stable_sort(points, {}, &SplineElasticity::Point::span);
  return points;
}

/// Bending and twisting with frames.
std::vector<FramedSpline::Span> framed_spans(const Strand& strand,
                                             const CubicSpline& spline) {
  std::vector<FramedSpline::Span> spans;
  for (std::size_t i = 0; i < spline.spans(); ++i) {
    const Segment& segment = strand.segments[i];
    const Vec moment = stiffness(strand, segment);
    const double friction = strand.material_of(segment).internal_friction;
    const double h = spline.length(i);
    FramedSpline::Span span{};
    span.start = spline.at(i, 0).first;
    span.end = spline.at(i, h).first;
    span.twist = {.stiffness = {moment.x / h}, .friction = {friction / h}};
    for (std::size_t k = 0;
         const auto& [along, weight] : gauss_legendre(bend_points, h)) {
      const CubicSpline::Basis basis = spline.at(i, along);
      span.points[k++] = {basis.first,
                          basis.second,
                          {.part = along / h,
                           .stiffness = {moment.y * weight, moment.z * weight},
                           .friction = {friction * weight, friction * weight}}};
    }
    spans.push_back(span);
  }
  return spans;
}

/// theta at the knots: their frames turn as the rigid strand does.
void add_angles(const Strand& strand, const RootStart& root,
                const std::vector<Frame>& frames, MaximalStrand& parts) {
  const std::size_t n = strand.segments.size();
  for (std::size_t knot = strand.free_root ? 0 : 1; knot <= n; ++knot) {
    double inertia = 0;
    for (const std::size_t k : {knot, knot + 1}) {  // segments on either side
      if (k == 0 || k > n) continue;
      const Segment& segment = strand.segments[k - 1];
      inertia += strand.material_of(segment).density * segment.section.polar() *
                 segment.length / 2;
    }
    parts.z.push_back(0);
    parts.rate.push_back(dot(root.spin, frames[knot].e0));
    parts.z_typ.push_back(1);
    parts.inertia.push_back(inertia);
  }
}

/// r = root and r' . e1 = r' . e2 = 0; r' at the root is along the first two controls.
std::unique_ptr<ConstraintSet> clamp(const Strand& strand, std::size_t controls,
                                     std::size_t angles) {
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
                                         static_cast<int>(controls),
                                         static_cast<int>(angles), strand.length());
}

/// Throws InputError unless the strand is a chain that the equations above describe.
std::unique_ptr<System> dynamic_spline(const Strand& strand,
                                       const DynamicSplineOptions& options,
                                       Effects effects) {
  check_unbranched(strand, "dynamic_spline");
  if (!options.twist) check_frameless(strand);
  std::vector<double> lengths;
  for (const Segment& segment : strand.segments) lengths.push_back(segment.length);
  const CubicSpline spline(lengths);
  const bool clamped = !strand.free_root.has_value();
  const RootStart root = root_start(strand);
  const FramedSpline::Shape initial =
      shape_of(strand, spline, ShapeOf::initial, root.place);
  const FramedSpline::Shape natural =
      shape_of(strand, spline, ShapeOf::natural, root.place);
  MaximalStrand parts;
  parts.clamped = false;  // by multipliers
  parts.nodes = static_cast<int>(spline.controls());
  parts.root = strand.root;
  // Starts as a rigid body; the control points move with it.
  parts.z = initial.controls;
  for (std::size_t k = 0; k < parts.z.size(); k += 3) {
    const Vec v = root.velocity_of(load3(&parts.z[k]));
    parts.rate.insert(parts.rate.end(), {v.x, v.y, v.z});
  }
  parts.z_typ.assign(parts.z.size(),
                     strand.length() / static_cast<double>(spline.spans()));
  std::vector<SplineElasticity::Point> points =
      stretching(strand, spline, natural.controls);
  if (options.twist) {
    add_angles(strand, root, initial.frames, parts);
    parts.elasticity =
        std::make_unique<FramedSpline>(framed_spans(strand, spline), std::move(points),
                                       natural, initial.frames, clamped);
  } else {
    parts.elasticity = std::make_unique<SplineElasticity>(
        spline.spans(), with_bending(strand, spline, std::move(points)));
  }
  parts.z_rate = parts.z_typ;
  for (double& rate : parts.z_rate) rate *= typical_rate(strand);
  for (std::size_t i = 0; i < spline.spans(); ++i) {
    const Segment& segment = strand.segments[i];
    const double line = strand.material_of(segment).density * segment.section.area();
    for (const auto& [along, weight] : gauss_legendre(mass_points, lengths[i])) {
      parts.mass.push_back({node_mean(i, spline.at(i, along)), line * weight, weight,
                            parts.length + along});
    }
    parts.length += lengths[i];
    parts.shown.push_back(node_mean(i, spline.at(i, 0)));
    if (i + 1 == spline.spans()) {
      parts.shown.push_back(node_mean(i, spline.at(i, lengths[i])));
    }
  }
  if (clamped) parts.constraints = clamp(strand, spline.controls(), parts.inertia.size());
  parts.effects = std::move(effects);
  parts.solver = options.solver;
  return std::make_unique<MaximalSystem>(std::move(parts));
}

std::span<const Parameter> dynamic_spline_parameters() {
  static constexpr std::array all{
      Parameter{.name = "twist",
                .help = "angles with the section's inertia, or no material "
                        "frame at all",
                .choices = "dynamic|none"},
      maximal_solver_parameter};
  return all;
}

std::unique_ptr<System> make_dynamic_spline(const Strand& strand,
                                            const Parameters& parameters,
                                            Effects effects) {
  DynamicSplineOptions options;
  options.twist = parameters.word("twist") != "none";
  options.solver = maximal_solver(parameters);
  return dynamic_spline(strand, options, std::move(effects));
}

}  // namespace

ModelEntry dynamic_spline_entry() {
  return {.id = "dynamic_spline",
          .summary =
              "cubic B-spline of n spans with material angles at its knots; 3(n + 3) "
              "control points, clamped by 5 multipliers",
          .source = "Lenoir 2004; Theetten 2008",
          .parameters = dynamic_spline_parameters(),
          .make = on_described_strand<make_dynamic_spline>,
          .on_strand = make_dynamic_spline};
}

}  // namespace tress::models
