#include "models/effects/body.h"

#include <algorithm>
#include <cmath>

#include "contract/input_error.h"

namespace tress::models {
namespace {

constexpr Parameter parameters_of_body[] = {
    {.name = "shape",
     .help = "plane: z < 0 of its frame is inside; sphere; capsule along z of its frame; "
             "ellipsoid; sdf: a signed distance grid",
     .choices = "plane|sphere|capsule|ellipsoid|sdf"},
    {.name = "centre_m",
     .help = "origin of its frame x, y, z, of a plane any point of it (m)",
     .min = -1e6,
     .max = 1e6,
     .components = 3,
     .fallback = "0,0,0"},
    {.name = "rotation_rad",
     .help = "how its frame is turned: axis times angle (rad)",
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
    {.name = "moves",
     .help = "it stays where it is, or follows the motion of the head",
     .choices = "fixed|head"},
    {.name = "stiffness_n_m2",
     .help =
         "contact force per length and depth; a hair at rest sinks by 6 um at 10, and "
         "fixed steps of 1 ms bear little more (N/m^2)",
     .number = 10,
     .min = 0,
     .max = 1e12},
    {.name = "damping_s_m",
     .help = "part by which the contact force grows per approaching speed (s/m)",
     .number = 1,
     .min = 0,
     .max = 1e9},
    {.name = "friction",
     .help = "Coulomb's coefficient",
     .number = 0.3,
     .min = 0,
     .max = 1e3},
    {.name = "slip_speed_m_s",
     .help = "speed below which friction fades: the most that sticking creeps (m/s)",
     .number = 1e-3,
     .min = 1e-12,
     .max = 1e3},
    {.name = "strand_radius_m",
     .help = "distance from the surface at which contact begins (m)",
     .number = 40e-6,
     .min = 0,
     .max = 1e3}};

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
  return Plane{};
}

Frame turned_by(const Vec& turn) {
  const double angle = norm(turn);
  return angle > 0 ? rotation((1 / angle) * turn, angle) : Frame{};
}

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

/// A point of the strand in the frame of a body.
struct Seen {
  Vec x, u;  // u: velocity relative to the surface
};

Vec place_in(const BodyPose& pose, const double* x) {
  return pose.frame.back(load3(x) - pose.x);
}

/// The distance from a shape for points nearer than `reach`; most others are excluded
/// without a search.
template <class Shape>
std::optional<Distance> near(const Shape& shape, const Vec& x, double reach) {
  if constexpr (requires { shape.at_least(x); }) {
    if (shape.at_least(x) >= reach) return {};
  }
  const Distance to = shape.distance(x);
  if (to.value >= reach) return {};
  return to;
}

Seen see(const BodyPose& pose, const Points& p, std::size_t i) {
  const Vec x = load3(&p.x[3 * i]), v = load3(&p.v[3 * i]);
  return {place_in(pose, &p.x[3 * i]), pose.frame.back(v - pose.surface_velocity(x))};
}

}  // namespace

std::span<const Parameter> body_parameters() { return parameters_of_body; }

std::unique_ptr<const Effect> make_body(const Parameters& parameters,
                                        const RootMotion& head) {
  const BodyContact law{.stiffness = parameters.number("stiffness_n_m2"),
                        .damping = parameters.number("damping_s_m"),
                        .friction = parameters.number("friction"),
                        .slip = parameters.number("slip_speed_m_s"),
                        .offset = parameters.number("strand_radius_m")};
  const StrandPlace place{parameters.vec("centre_m"),
                          turned_by(parameters.vec("rotation_rad"))};
  std::optional<RootMotion> follows;
  if (parameters.word("moves") == "head") follows = head;
  return std::make_unique<Body>(make_shape(parameters), place, law, std::move(follows));
}

Body::Body(BodyShape shape, const StrandPlace& place, const BodyContact& law,
           std::optional<RootMotion> head)
    : shape_(std::move(shape)), place_(place), law_(law), head_(std::move(head)) {
  if (!std::visit([](const auto& one) { return has_size(one); }, shape_)) {
    throw InputError("its size is not positive or not finite", "effect body",
                     "give radius and half axes > 0, length >= 0 in m");
  }
  if (!not_negative(law.stiffness) || !not_negative(law.damping) ||
      !not_negative(law.friction) || !not_negative(law.offset) || !positive(law.slip)) {
    throw InputError(
        "a number of the contact is negative or not finite", "effect body",
        "give stiffness, damping, friction and strand radius >= 0, slip > 0");
  }
  if (!is_rotation(place.frame) || !is_finite(place.x)) {
    throw InputError("its place is not finite or its frame no rotation", "effect body",
                     "give a finite place and orthogonal axes of length 1");
  }
  if (head_) check(*head_, "effect body");
  if (const auto* grid = std::get_if<DistanceGrid>(&shape_)) {
    // Between points the interpolant may lie 1.2 spacings below the least value: the
    // negative weights of two directions sum to 0.28, the values differ by 3 sqrt(2).
    const double needed = law.offset + 2 * grid->samples().spacing;
    if (grid->clearance() < needed) {
      throw InputError("the surface comes too near to the end of the grid", "effect body",
                       "let the two outermost layers be " + std::to_string(needed) +
                           " m and more from it");
    }
  }
}

std::optional<Outline> Body::outline(double t) const {
  const Drawn of = std::visit([](const auto& shape) { return drawn(shape); }, shape_);
  if (of.shape.empty()) return {};
  const BodyPose now = pose(t);
  return Outline{of.shape, of.half_axes, now.x, now.frame};
}

BodyPose Body::pose(double t) const {
  if (!head_) return {place_.x, place_.frame, {}, {}};
  const RootPose head = head_->at(t);
  const auto carry = [&](const Vec& a) { return head.frame * head_->frame.back(a); };
  const Vec arm = carry(place_.x - head_->position);
  const Frame& f = place_.frame;
  return {head.x + arm,
          {carry(f.e0), carry(f.e1), carry(f.e2)},
          head.v + cross(head.omega, arm),
          head.omega};
}

void Body::add_load(double t, const Points& p, InOut f) const noexcept {
  const BodyPose now = pose(t);
  const auto add = [&](const auto& shape) {
    for (std::size_t i = 0; i < p.length.size(); ++i) {
      const Seen at = see(now, p, i);
      const auto to = near(shape, at.x, law_.offset);
      if (!to) continue;
      double* load = &f[3 * i];
      store3(load3(load) + p.length[i] * (now.frame * law_.load(*to, at.u)), load);
    }
  };
  std::visit(add, shape_);
}

void Body::add_derivatives(double t, const Points& p, double pos, double vel,
                           InOut blocks) const noexcept {
  const BodyPose now = pose(t);
  const Mat3 spin = cross_matrix(now.frame.back(now.omega));
  const auto add = [&](const auto& shape) {
    for (std::size_t i = 0; i < p.length.size(); ++i) {
      const Seen at = see(now, p, i);
      const auto to = near(shape, at.x, law_.offset);
      if (!to) continue;
      const auto [by_x, by_u] = law_.slopes(*to, shape.curvature(at.x), at.u);
      // The surface moves faster further out: du/dx = -omega x.
      const Mat3 block = pos * (by_x - by_u * spin) + vel * by_u;
      add9(turned(now.frame, p.length[i] * block), &blocks[9 * i]);
    }
  };
  std::visit(add, shape_);
}

double Body::potential(double t, const Points& p) const noexcept {
  const BodyPose now = pose(t);
  double sum = 0;
  const auto add = [&](const auto& shape) {
    for (std::size_t i = 0; i < p.length.size(); ++i) {
      const auto to = near(shape, place_in(now, &p.x[3 * i]), law_.offset);
      if (to) sum += p.length[i] * law_.energy(*to);
    }
  };
  std::visit(add, shape_);
  return sum;
}

double Body::power(double t, const Points& p) const noexcept {
  const BodyPose now = pose(t);
  double sum = 0;
  const auto add = [&](const auto& shape) {
    for (std::size_t i = 0; i < p.length.size(); ++i) {
      const Seen at = see(now, p, i);
      const auto to = near(shape, at.x, law_.offset);
      if (!to) continue;
      // f.v - f_elastic.(v - w), the second being the rate of the potential.
      const Vec v = now.frame.back(load3(&p.v[3 * i]));
      sum += p.length[i] *
             (dot(law_.load(*to, at.u), v) - dot(law_.elastic_load(*to), at.u));
    }
  };
  std::visit(add, shape_);
  return sum;
}

std::optional<double> Body::penetration(double t, In x) const {
  const BodyPose now = pose(t);
  double deepest = 0;
  const auto look = [&](const auto& shape) {
    for (std::size_t i = 0; i + 2 < x.size(); i += 3) {
      const auto to = near(shape, place_in(now, &x[i]), law_.offset);
      if (to) deepest = std::max(deepest, law_.depth(*to));
    }
  };
  std::visit(look, shape_);
  return deepest;
}

}  // namespace tress::models
