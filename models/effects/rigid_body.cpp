#include "models/effects/rigid_body.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>

#include "contract/input_error.h"
#include "models/effects/body.h"

namespace tress::models {
namespace {

constexpr Parameter parameters_of_body[] = {
    {.name = "shape",
     .help = "plane: z < 0 of its frame is inside; capsule: along its z; sdf: a signed "
             "distance grid; mesh: a closed surface, as such a grid",
     .choices = "plane|sphere|capsule|ellipsoid|sdf|mesh"},
    {.name = "centre_m",
     .help = "origin x, y, z of the frame of the body; for a plane any of "
             "its points (m)",
     .min = -1e6,
     .max = 1e6,
     .components = 3,
     .fallback = "0,0,0"},
    {.name = "rotation_rad",
     .help = "rotation of its frame: axis times angle (rad)",
     .min = -1e3,
     .max = 1e3,
     .components = 3,
     .fallback = "0,0,0"},
    {.name = "radius_m",
     .help = "shape = sphere, capsule: radius (m)",
     .number = 0.1,
     .min = 1e-9,
     .max = 1e6},
    {.name = "length_m",
     .help = "shape = capsule: length without the caps (m)",
     .number = 0.2,
     .min = 0,
     .max = 1e6},
    {.name = "half_axes_m",
     .help = "shape = ellipsoid: half axes x, y, z (m)",
     .min = 1e-9,
     .max = 1e6,
     .components = 3,
     .fallback = "0.08,0.1,0.12"},
    {.name = "sdf_file",
     .help = "shape = sdf: text file with nx ny nz, origin, spacing and the distances, x "
             "fastest, < 0 inside (m)",
     .text = true},
    {.name = "mesh_file",
     .help = "shape = mesh: OBJ, PLY or STL file of a closed surface",
     .text = true},
    {.name = "mesh_scale",
     .help = "shape = mesh: metres per unit of the file",
     .number = 1,
     .min = 1e-9,
     .max = 1e9},
    {.name = "mesh_spacing_m",
     .help = "shape = mesh: distance between points of the grid (m); 0: a 64th of the "
             "largest extent. Edges and details are true to about this distance, and "
             "the program prints the error",
     .min = 0,
     .max = 1e6},
    {.name = "moves",
     .help = "motion of the body: none, that of the head, or that of its own rows. "
             "`turns`: strands and torque_n_m turn it about `axis`. `free`: strands and "
             "[effects.gravity] move it",
     .choices = "fixed|head|keyframes|poses|turns|free"},
    {.name = "keyframes",
     .help = "moves = keyframes: rows of t, x, y, z, angle (s, m, rad) relative to its "
             "place, as those of [root]. The angle is about `axis` through centre_m",
     .min = -1e6,
     .max = 1e6,
     .components = 5,
     .rows = true,
     .fallback = "0,0,0,0,0;1,0,0,0.1,0"},
    {.name = "poses",
     .help =
         "moves = poses: rows of t, x, y, z and three angles (s, m, rad) relative to its "
         "place, as those of [root]. It turns about x, y and z through centre_m",
     .min = -1e6,
     .max = 1e6,
     .components = 7,
     .rows = true,
     .fallback = "0,0,0,0,0,0,0;1,0,0,0.1,0,0,0"},
    {.name = "axis",
     .help = "moves = keyframes, turns: direction of the axis of the angle; any length",
     .min = -1e6,
     .max = 1e6,
     .components = 3,
     .fallback = "0,0,1"},
    {.name = "pivot_m",
     .help = "moves = turns: a point of the axis relative to centre_m (m)",
     .min = -1e6,
     .max = 1e6,
     .components = 3,
     .fallback = "0,0,0"},
    {.name = "inertia_kg_m2",
     .help = "moves = turns: moment of inertia about the axis (kg m^2)",
     .number = 1e-6,
     .min = 1e-30,
     .max = 1e12},
    {.name = "bearing_damping_n_m_s",
     .help = "moves = turns: moment of the bearing per angular velocity (N m s)",
     .min = 0,
     .max = 1e12},
    {.name = "torque_n_m",
     .help = "moves = turns: prescribed moment about the axis (N m)",
     .min = -1e12,
     .max = 1e12},
    {.name = "angular_velocity_rad_per_s",
     .help = "moves = turns: angular velocity at the start (rad/s)",
     .min = -1e6,
     .max = 1e6},
    {.name = "mass_kg",
     .help = "moves = free: mass (kg); its centre is centre_m",
     .number = 1e-3,
     .min = 1e-30,
     .max = 1e12},
    {.name = "principal_inertias_kg_m2",
     .help =
         "moves = free: moments of inertia about the axes of the body (kg m^2), which "
         "rotation_rad turns. 0, 0, 0: of a sphere, capsule or ellipsoid with "
         "constant density",
     .min = 0,
     .max = 1e12,
     .components = 3,
     .fallback = "0,0,0"},
    {.name = "velocity_m_per_s",
     .help = "moves = free: velocity of the centre at the start (m/s)",
     .min = -1e6,
     .max = 1e6,
     .components = 3,
     .fallback = "0,0,0"},
    {.name = "spin_rad_per_s",
     .help = "moves = free: angular velocity at the start, in the world (rad/s)",
     .min = -1e6,
     .max = 1e6,
     .components = 3,
     .fallback = "0,0,0"},
    {.name = "stiffness_n_m2",
     .help = "contact force per length and depth (N/m^2). At 10 a hair at rest sinks by "
             "6 um, and fixed steps of 1 ms allow little more",
     .number = 10,
     .min = 0,
     .max = 1e12},
    {.name = "damping_s_m",
     .help = "relative increase of the contact force per approach speed "
             "(s/m)",
     .number = 1,
     .min = 0,
     .max = 1e9},
    {.name = "friction",
     .help = "Coulomb's coefficient",
     .number = 0.3,
     .min = 0,
     .max = 1e3},
    {.name = "friction_law",
     .help =
         "law of friction. `regularised`: sticking contacts creep below "
         "slip_speed_m_s. `exact` (Signorini-Coulomb): they keep their "
         "place on the body to the contact tolerance. `exact` needs a "
         "method that solves at the end of a step. With "
         "[effects.strand_friction], rigid contacts are solved together with those of "
         "strands",
     .choices = "regularised|exact"},
    {.name = "normal",
     .help = "friction_law = exact: surface that gives way with stiffness_n_m2, "
             "or a rigid one",
     .choices = "compliant|rigid"},
    {.name = "restitution",
     .help = "normal = rigid: speed after an impact over that before, for backward_euler",
     .min = 0,
     .max = 1},
    {.name = "slip_speed_m_s",
     .help = "friction_law = regularised: speed below which friction "
             "fades, and largest creep of a sticking contact (m/s)",
     .number = 1e-3,
     .min = 1e-12,
     .max = 1e3},
    {.name = "strand_radius_m",
     .help =
         "distance from the surface at which contact begins, usually the radius of the "
         "strand; not taken from [material] (m)",
     .number = 40e-6,
     .min = 0,
     .max = 1e3}};

constexpr EffectUse uses_of_body[] = {
    {"shape", "sphere", "radius_m"},
    {"shape", "capsule", "radius_m|length_m"},
    {"shape", "ellipsoid", "half_axes_m"},
    {"shape", "sdf", "sdf_file"},
    {"shape", "mesh", "mesh_file|mesh_scale|mesh_spacing_m"},
    {"moves", "keyframes", "keyframes|axis"},
    {"moves", "poses", "poses"},
    {"moves", "turns",
     "axis|pivot_m|inertia_kg_m2|bearing_damping_n_m_s|torque_n_m|"
     "angular_velocity_rad_per_s"},
    {"moves", "free", "mass_kg|principal_inertias_kg_m2|velocity_m_per_s|spin_rad_per_s"},
    {"friction_law", "exact", "normal|restitution"},
    {"friction_law", "regularised", "slip_speed_m_s"},
    {"normal", "compliant", "stiffness_n_m2|damping_s_m"},
    {"normal", "rigid", "restitution"}};

bool positive(double x) { return std::isfinite(x) && x > 0; }
bool not_negative(double x) { return std::isfinite(x) && x >= 0; }

bool has_size(const Plane&) { return true; }
bool has_size(const Sphere& s) { return positive(s.radius); }
bool has_size(const Capsule& c) {
  return positive(c.radius) && not_negative(c.half_length);
}
bool has_size(const Ellipsoid& e) {
  const Vec& a = e.half_axes();
  return positive(a.x) && positive(a.y) && positive(a.z);
}
bool has_size(const DistanceGrid&) { return true; }

double least_radius_of(const Plane&) { return std::numeric_limits<double>::infinity(); }
double least_radius_of(const Sphere& s) { return s.radius; }
double least_radius_of(const Capsule& c) { return c.radius; }
double least_radius_of(const Ellipsoid& e) {
  const Vec& a = e.half_axes();
  const double least = std::min({a.x, a.y, a.z}), most = std::max({a.x, a.y, a.z});
  return least * least / most;
}
// What is smaller than some cells is not in the grid.
double least_radius_of(const DistanceGrid& g) { return 4 * g.samples().spacing; }

/// The part of an outline that does not depend on the pose.
struct Drawn {
  std::string_view shape;
  Vec half_axes;
};
Drawn drawn(const Plane&) { return {"plane", {}}; }
Drawn drawn(const Sphere& s) { return {"sphere", {s.radius, s.radius, s.radius}}; }
Drawn drawn(const Capsule& c) { return {"capsule", {c.radius, c.radius, c.half_length}}; }
Drawn drawn(const Ellipsoid& e) { return {"ellipsoid", e.half_axes()}; }
Drawn drawn(const DistanceGrid&) { return {}; }

}  // namespace

std::span<const Parameter> body_parameters() { return parameters_of_body; }
std::span<const EffectUse> body_uses() { return uses_of_body; }

RigidBody::RigidBody(BodyShape shape, const StrandPlace& place, double offset,
                     std::optional<RootMotion> motion)
    : shape_(std::move(shape)),
      place_(place),
      offset_(offset),
      motion_(std::move(motion)) {
  if (!std::visit([](const auto& one) { return has_size(one); }, shape_)) {
    throw InputError("its size is not positive or not finite", "effect body",
                     "give radius and half axes > 0, length >= 0 in m");
  }
  if (!not_negative(offset)) {
    throw InputError("the strand's radius is negative or not finite", "effect body",
                     "give a radius >= 0");
  }
  if (!is_rotation(place.frame) || !is_finite(place.x)) {
    throw InputError("its place is not finite or its frame no rotation", "effect body",
                     "give a finite place and orthogonal axes of length 1");
  }
  if (motion_) check(*motion_, "effect body");
  if (const auto* grid = std::get_if<DistanceGrid>(&shape_)) {
    // Between points the interpolant may lie 1.2 spacings below the least value: the
    // negative weights of two directions sum to 0.28, the values differ by 3 sqrt(2).
    const double needed = offset + 2 * grid->samples().spacing;
    if (grid->clearance() < needed) {
      throw InputError("the surface comes too near to the end of the grid", "effect body",
                       "let the two outermost layers be " + std::to_string(needed) +
                           " m and more from it");
    }
  }
}

BodyPose RigidBody::pose(double t, double since) const {
  if (!motion_) return {place_.x, place_.frame, {}, {}};
  const RootPose now = motion_->at(t, since);
  const auto carry = [&](const Vec& a) { return now.frame * motion_->frame.back(a); };
  const Vec arm = carry(place_.x - motion_->position);
  const Frame& f = place_.frame;
  return {now.x + arm,
          {carry(f.e0), carry(f.e1), carry(f.e2)},
          now.v + cross(now.omega, arm),
          now.omega};
}

std::optional<Outline> RigidBody::outline(double t) const {
  const Drawn of = std::visit([](const auto& shape) { return drawn(shape); }, shape_);
  if (of.shape.empty()) return {};
  const BodyPose now = pose(t);
  return Outline{of.shape, of.half_axes, now.x, now.frame};
}

double RigidBody::least_radius() const {
  return std::visit([](const auto& shape) { return least_radius_of(shape); }, shape_);
}

std::optional<Distance> RigidBody::distance(const Vec& x, double reach) const {
  NearestOf<double> at;
  const auto look = [&](const auto& shape) { return nearest(shape, x, reach, at); };
  if (!std::visit(look, shape_)) return {};
  return at.to;
}

bool RigidBody::reaches(const BodyPose& now, const Ball& ball) const {
  const Vec centre = now.frame.back(ball.centre - now.x);
  return std::visit(
      [&](const auto& shape) {
        return below(shape, centre).value - ball.radius < offset_;
      },
      shape_);
}

/// Calls see(place, distance) for the points at x whose distance is below `reach`.
template <class See>
void RigidBody::for_within(double reach, const BodyPose& now, In x, See see) const {
  const auto look = [&](const auto& shape) {
    for (std::size_t i = 0; i + 2 < x.size(); i += 3) {
      const Vec place = load3(&x[i]);
      NearestOf<double> at;
      if (nearest(shape, now.frame.back(place - now.x), reach, at)) {
        see(place, at.to.value);
      }
    }
  };
  std::visit(look, shape_);
}

double RigidBody::penetration(double t, In x) const {
  double deepest = 0;
  for_within(offset_, pose(t), x, [&](const Vec&, double distance) {
    deepest = std::max(deepest, offset_ - distance);
  });
  return deepest;
}

double RigidBody::surface_speed(double t, In x, double near) const {
  if (!motion_) return 0;
  const BodyPose now = pose(t);
  double fastest = 0;
  for_within(offset_ + near, now, x, [&](const Vec& place, double) {
    fastest = std::max(fastest, norm(now.surface_velocity(place)));
  });
  return fastest;
}

}  // namespace tress::models
