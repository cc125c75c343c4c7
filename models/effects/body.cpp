#include "models/effects/body.h"

#include <cmath>
#include <sstream>
#include <string>

#include "contract/input_error.h"
#include "models/effects/exact_body.h"
#include "models/mesh/mesh_grid.h"
#include "models/motion/signals.h"

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
     .help = "motion of the body: none, that of the head, or that of its own rows",
     .choices = "fixed|head|keyframes|poses"},
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
     .help = "moves = keyframes: direction of the axis of the angle; any length",
     .min = -1e6,
     .max = 1e6,
     .components = 3,
     .fallback = "0,0,1"},
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
    {"friction_law", "exact", "normal|restitution"},
    {"friction_law", "regularised", "slip_speed_m_s"},
    {"normal", "compliant", "stiffness_n_m2|damping_s_m"},
    {"normal", "rigid", "restitution"}};

MeshGrid mesh_of(const Parameters& parameters) {
  const std::string file(parameters.word("mesh_file"));
  refuse_if(file.empty(), "no mesh_file", "effect body, shape = mesh",
            "name an OBJ, PLY or STL file");
  return read_mesh_grid(file, {.scale = parameters.number("mesh_scale"),
                               .spacing = parameters.number("mesh_spacing_m"),
                               .offset = parameters.number("strand_radius_m")});
}

BodyShape make_shape(const Parameters& parameters) {
  const std::string_view word = parameters.word("shape");
  if (word == "sphere") return Sphere{parameters.number("radius_m")};
  if (word == "capsule") {
    return Capsule{parameters.number("radius_m"), parameters.number("length_m") / 2};
  }
  if (word == "ellipsoid") return Ellipsoid(parameters.vec("half_axes_m"));
  if (word == "sdf") {
    if (parameters.word("sdf_file").empty()) {
      throw InputError("no sdf_file", "effect body, shape = sdf",
                       "name a file with a signed distance grid");
    }
    return read_distance_grid(std::string(parameters.word("sdf_file")));
  }
  if (word == "mesh") return mesh_of(parameters).grid;
  return Plane{};
}

Frame turned_by(const Vec& turn) {
  const double angle = norm(turn);
  return angle > 0 ? rotation((1 / angle) * turn, angle) : Frame{};
}

/// The prescribed motion of the body; none: it is fixed.
std::optional<RootMotion> motion(const Parameters& parameters, const RootMotion& head) {
  const std::string_view moves = parameters.word("moves");
  const Vec axis = parameters.vec("axis"), centre = parameters.vec("centre_m");
  if (moves == "keyframes") {
    return keyframe_motion(parameters.numbers("keyframes"), {&axis, 1}, centre);
  }
  if (moves == "poses") {
    return keyframe_motion(parameters.numbers("poses"), world_axes, centre);
  }
  if (moves == "head") return head;
  return {};
}

}  // namespace

std::span<const Parameter> body_parameters() { return parameters_of_body; }
std::span<const EffectUse> body_uses() { return uses_of_body; }

std::string surface_in_words(const Parameters& parameters) {
  if (parameters.word("shape") != "mesh") return {};
  const MeshGrid mesh = mesh_of(parameters);
  const DistanceGrid::Samples& s = mesh.grid.samples();
  std::ostringstream words;
  words.precision(3);
  words << mesh.triangles << " triangles as a grid of " << s.nx << " x " << s.ny << " x "
        << s.nz << " distances, " << s.spacing
        << " m apart; at corners, middles of edges "
        << "and centres of triangles the distance is wrong by " << mesh.error
        << " m at most";
  return words.str();
}

std::unique_ptr<const Effect> make_body(const Parameters& parameters,
                                        const RootMotion& head) {
  const BodyContact law{.stiffness = parameters.number("stiffness_n_m2"),
                        .damping = parameters.number("damping_s_m"),
                        .friction = parameters.number("friction"),
                        .slip = parameters.number("slip_speed_m_s"),
                        .offset = parameters.number("strand_radius_m")};
  const StrandPlace place{parameters.vec("centre_m"),
                          turned_by(parameters.vec("rotation_rad"))};
  std::optional<RootMotion> follows = motion(parameters, head);
  const bool rigid = parameters.word("normal") == "rigid";
  if (parameters.word("friction_law") == "exact") {
    return std::make_unique<ExactBody>(
        make_shape(parameters), place,
        ExactContact{law.normal(), rigid, law.friction, parameters.number("restitution")},
        std::move(follows));
  }
  if (rigid || parameters.number("restitution") > 0) {
    throw InputError("a rigid surface and restitution belong to the exact law",
                     "effect body", "set friction_law = \"exact\" or leave them out");
  }
  return std::make_unique<Body>(make_shape(parameters), place, law, std::move(follows));
}

Body::Body(BodyShape shape, const StrandPlace& place, const BodyContact& law,
           std::optional<RootMotion> head)
    : contact_{RigidBody(std::move(shape), place, law.offset, std::move(head)), law} {
  check(law.normal(), law.friction);
  if (!(std::isfinite(law.slip) && law.slip > 0)) {
    throw InputError("its slip speed is not positive or not finite", "effect body",
                     "give a slip speed > 0 in m/s");
  }
}

std::shared_ptr<const Body> Body::with_offsets(std::vector<double> more) const {
  auto copy = std::make_shared<Body>(*this);
  copy->more_ = std::move(more);
  return copy;
}

void Body::add_load(double t, const Points& p, InOut f) const noexcept {
  const BodyPose now = contact_.body.pose(t);
  contact_.body.for_near<RigidBody::With::velocity>(
      now, p, [&](std::size_t point) { return law(point).offset; },
      [&](const RigidBody::Near& at) {
        double* load = &f[3 * at.point];
        store3(load3(load) +
                   p.length[at.point] * (now.frame * law(at.point).load(at.to, at.u)),
               load);
      });
}

void Body::add_derivatives(double t, const Points& p, double pos, double vel,
                           InOut blocks) const noexcept {
  const BodyPose now = contact_.body.pose(t);
  const Mat3 spin = cross_matrix(now.frame.back(now.omega));
  contact_.body.for_near<RigidBody::With::curvature>(
      now, p, [&](std::size_t point) { return law(point).offset; },
      [&](const RigidBody::Near& at) {
        const auto [by_x, by_u] = law(at.point).slopes(at.to, at.curvature, at.u);
        // The surface moves faster further out: du/dx = -omega x.
        const Mat3 block = pos * (by_x - by_u * spin) + vel * by_u;
        add9(turned(now.frame, p.length[at.point] * block), &blocks[9 * at.point]);
      });
}

double Body::potential(double t, const Points& p) const noexcept {
  double sum = 0;
  contact_.body.for_near<RigidBody::With::position>(
      contact_.body.pose(t), p, [&](std::size_t point) { return law(point).offset; },
      [&](const RigidBody::Near& at) {
        sum += p.length[at.point] * law(at.point).normal().energy(at.to);
      });
  return sum;
}

double Body::power(double t, const Points& p) const noexcept {
  const BodyPose now = contact_.body.pose(t);
  double sum = 0;
  contact_.body.for_near<RigidBody::With::velocity>(
      now, p, [&](std::size_t point) { return law(point).offset; },
      [&](const RigidBody::Near& at) {
        // f.v - f_elastic.(v - w), the second being the rate of the potential.
        const Vec v = now.frame.back(load3(&p.v[3 * at.point]));
        sum +=
            p.length[at.point] * (dot(law(at.point).load(at.to, at.u), v) -
                                  dot(law(at.point).normal().elastic_load(at.to), at.u));
      });
  return sum;
}

}  // namespace tress::models
