#include "models/effects/body.h"

#include <cmath>
#include <sstream>
#include <string>

#include "contract/input_error.h"
#include "models/effects/driven_body.h"
#include "models/effects/exact_body.h"
#include "models/mesh/mesh_grid.h"
#include "models/motion/signals.h"

namespace tress::models {
namespace {

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

/// Principal moments of a body of constant density; none: its shape has none here.
std::optional<Vec> inertia_of(const Parameters& parameters, double mass) {
  const std::string_view word = parameters.word("shape");
  const double r = parameters.number("radius_m"), square = r * r;
  if (word == "sphere") {
    const double i = 0.4 * mass * square;
    return Vec{i, i, i};
  }
  if (word == "ellipsoid") {
    const Vec a = parameters.vec("half_axes_m");
    return mass / 5 *
           Vec{a.y * a.y + a.z * a.z, a.x * a.x + a.z * a.z, a.x * a.x + a.y * a.y};
  }
  if (word != "capsule") return {};
  // A cylinder along z and two half spheres, whose centres of mass are 3/8 r from their
  // faces.
  const double h = parameters.number("length_m"), whole = h + 4.0 / 3 * r;
  const double cylinder = mass * h / whole, spheres = mass - cylinder;
  const double across = cylinder * (h * h / 12 + square / 4) +
                        spheres * (0.4 * square + h * h / 4 + 0.375 * h * r);
  return Vec{across, across, cylinder * square / 2 + spheres * 0.4 * square};
}

FreeBody free_body(const Parameters& parameters) {
  FreeBody body{.mass = parameters.number("mass_kg"),
                .inertia = parameters.vec("principal_inertias_kg_m2"),
                .velocity = parameters.vec("velocity_m_per_s"),
                .spin = parameters.vec("spin_rad_per_s")};
  if (norm(body.inertia) > 0) return body;
  const std::optional<Vec> uniform = inertia_of(parameters, body.mass);
  refuse_if(!uniform,
            "moves = \"free\" without moments of inertia, which do not follow from this "
            "shape",
            "effect body", "give principal_inertias_kg_m2");
  body.inertia = *uniform;
  return body;
}

}  // namespace

std::optional<RootMotion> body_motion(const Parameters& parameters,
                                      const RootMotion& head) {
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
  std::optional<RootMotion> follows = body_motion(parameters, head);
  const bool rigid = parameters.word("normal") == "rigid";
  const std::string moves(parameters.word("moves"));
  const bool driven = moves == "turns" || moves == "free";
  if (parameters.word("friction_law") == "exact") {
    refuse_if(driven,
              "moves = \"" + moves +
                  "\" with friction_law = \"exact\", whose solver "
                  "takes the motion of bodies as given",
              "effect body", "use friction_law = \"regularised\"");
    return std::make_unique<ExactBody>(
        make_shape(parameters), place,
        ExactContact{law.normal(), rigid, law.friction, parameters.number("restitution")},
        std::move(follows));
  }
  if (rigid || parameters.number("restitution") > 0) {
    throw InputError("a rigid surface and restitution belong to the exact law",
                     "effect body", "set friction_law = \"exact\" or leave them out");
  }
  Body made(make_shape(parameters), place, law, std::move(follows));
  if (!driven) return std::make_unique<Body>(std::move(made));
  if (moves == "free") {
    return std::make_unique<DrivenBody>(std::move(made), free_body(parameters));
  }
  return std::make_unique<DrivenBody>(
      std::move(made), Bearing{.axis = parameters.vec("axis"),
                               .pivot = place.x + parameters.vec("pivot_m"),
                               .inertia = parameters.number("inertia_kg_m2"),
                               .damping = parameters.number("bearing_damping_n_m_s"),
                               .moment = parameters.number("torque_n_m"),
                               .speed = parameters.number("angular_velocity_rad_per_s")});
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
  const BodyPose now = contact_.body.pose(t, p.since);
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
  const BodyPose now = contact_.body.pose(t, p.since);
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
      contact_.body.pose(t, p.since), p,
      [&](std::size_t point) { return law(point).offset; },
      [&](const RigidBody::Near& at) {
        sum += p.length[at.point] * law(at.point).normal().energy(at.to);
      });
  return sum;
}

double Body::power(double t, const Points& p) const noexcept {
  const BodyPose now = contact_.body.pose(t, p.since);
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
