// Bodies that strands drive.
#include "models/effects/driven_body.h"

#include <algorithm>
#include <cmath>

#include "contract/input_error.h"

namespace tress::models {

namespace {

bool positive(double x) { return std::isfinite(x) && x > 0; }

/// Returns the motion at the start.
DrivenBodies::Motion begin(Bearing& bearing, const Body&) {
  const double length = norm(bearing.axis);
  refuse_if(!positive(length) || !is_finite(bearing.pivot),
            "its axis has no direction or is not finite", "effect body",
            "give axis a direction, such as [0, 1, 0]");
  refuse_if(!positive(bearing.inertia),
            "its moment of inertia is not positive or not finite", "effect body",
            "give inertia_kg_m2 > 0");
  refuse_if(!(std::isfinite(bearing.damping) && bearing.damping >= 0) ||
                !std::isfinite(bearing.moment) || !std::isfinite(bearing.speed),
            "its bearing has a negative damping or a number that is not finite",
            "effect body", "give bearing_damping_n_m_s >= 0 and finite numbers");
  bearing.axis = (1 / length) * bearing.axis;
  DrivenBodies::Motion start;
  start.x = bearing.pivot;
  start.omega = bearing.speed * bearing.axis;
  start.speed = bearing.speed;
  return start;
}

DrivenBodies::Motion begin(FreeBody& body, const Body& shape) {
  refuse_if(!positive(body.mass), "its mass is not positive or not finite", "effect body",
            "give mass_kg > 0");
  const Vec& i = body.inertia;
  refuse_if(!positive(i.x) || !positive(i.y) || !positive(i.z),
            "its principal moments of inertia are not all positive", "effect body",
            "give principal_inertias_kg_m2 with three numbers > 0");
  // Of a flat body the largest is the sum of the others, up to rounding.
  const double most = std::max({i.x, i.y, i.z}), sum = i.x + i.y + i.z;
  refuse_if(2 * most > sum * (1 + 1e-12),
            "its principal moments of inertia violate the triangle inequality: the "
            "largest exceeds the sum of the others",
            "effect body", "change principal_inertias_kg_m2");
  refuse_if(!is_finite(body.velocity) || !is_finite(body.spin),
            "its velocity at the start is not finite", "effect body",
            "give finite numbers");
  DrivenBodies::Motion start;
  start.x = shape.pose(0).x;
  start.v = body.velocity;
  start.omega = body.spin;
  return start;
}

}  // namespace

DrivenBody::DrivenBody(Body body, const BodyDrive& drive)
    : body_(std::move(body)),
      drive_(drive),
      start_(std::visit([this](auto& of) { return begin(of, body_); }, drive_)),
      now_(start_) {}

void DrivenBody::place_in_frame(In x) const {
  x_.resize(x.size());
  for (std::size_t i = 0; i + 2 < x.size(); i += 3) {
    store3(start_.x + now_.turn.back(load3(&x[i]) - now_.x), &x_[i]);
  }
}

Points DrivenBody::in_frame(const Points& p) const {
  place_in_frame(p.x);
  v_.resize(p.v.size());
  for (std::size_t i = 0; i + 2 < p.v.size(); i += 3) {
    store3(now_.turn.back(load3(&p.v[i]) - surface_velocity(load3(&p.x[i]))), &v_[i]);
  }
  Points seen = p;
  seen.x = x_;
  seen.v = v_;
  return seen;
}

/// Sets f.
void DrivenBody::law(double t, const Points& p, InOut f) const {
  std::ranges::fill(f, 0.0);
  body_.add_load(t, in_frame(p), f);
  for (std::size_t i = 0; i + 2 < f.size(); i += 3) {
    store3(now_.turn * load3(&f[i]), &f[i]);
  }
}

void DrivenBody::add_load(double t, const Points& p, InOut f) const noexcept {
  const std::size_t count = 3 * p.length.size();
  if (mode_ == Mode::replaced) {
    for (std::size_t i = 0; i < count && next_ + i < given_.size(); ++i) {
      f[i] += factor_ * given_[next_ + i];
    }
    next_ += count;
    return;
  }
  load_.resize(count);
  law(t, p, load_);
  for (std::size_t i = 0; i < count; ++i) f[i] += load_[i];
  if (mode_ != Mode::records) return;
  if (read_) record();
  places_.insert(places_.end(), p.x.begin(), p.x.begin() + std::ptrdiff_t(count));
  velocities_.insert(velocities_.end(), p.v.begin(), p.v.begin() + std::ptrdiff_t(count));
  lengths_.insert(lengths_.end(), p.length.begin(), p.length.end());
  loads_.insert(loads_.end(), load_.begin(), load_.end());
}

/// The surface moves faster further out: the velocity relative to it falls by omega e x
/// dx.
void DrivenBody::law_slopes(double t, const Points& p, double pos, double vel,
                            InOut blocks) const {
  const Points seen = in_frame(p);
  block_.assign(blocks.size(), 0.0);
  body_.add_derivatives(t, seen, pos, 0, blocks);
  body_.add_derivatives(t, seen, 0, 1, block_);
  const Mat3 spin = cross_matrix(now_.omega);
  const auto world = [&](In of, std::size_t i) {
    return turned(now_.turn, {load3(&of[i]), load3(&of[i + 3]), load3(&of[i + 6])});
  };
  for (std::size_t i = 0; i + 8 < blocks.size(); i += 9) {
    const Mat3 by_u = world(block_, i);
    const Mat3 all = world(blocks, i) - pos * (by_u * spin) + vel * by_u;
    store3(all.r0, &blocks[i]);
    store3(all.r1, &blocks[i + 3]);
    store3(all.r2, &blocks[i + 6]);
  }
}

void DrivenBody::add_derivatives(double t, const Points& p, double pos, double vel,
                                 InOut blocks) const noexcept {
  blocks_.assign(blocks.size(), 0.0);
  law_slopes(t, p, pos, vel, blocks_);
  for (std::size_t i = 0; i < blocks.size(); ++i) blocks[i] += blocks_[i];
}

double DrivenBody::potential(double t, const Points& p) const noexcept {
  return body_.potential(t, in_frame(p));
}

double DrivenBody::power(double t, const Points& p) const noexcept {
  return body_.power(t, in_frame(p));
}

std::optional<double> DrivenBody::penetration(double t, In x) const {
  place_in_frame(x);
  return body_.penetration(t, x_);
}

double DrivenBody::surface_speed(double /*t*/, In x, double near) const {
  place_in_frame(x);
  const RigidBody& body = body_.contact_on_points().body;
  const auto pose = body_.pose(0);
  double fastest = 0;
  for (std::size_t i = 0; i + 2 < x.size(); i += 3) {
    const Vec at = pose.frame.back(load3(&x_[i]) - pose.x);
    if (!body.distance(at, body.offset() + near)) continue;
    fastest = std::max(fastest, norm(surface_velocity(load3(&x[i]))));
  }
  return fastest;
}

std::optional<Outline> DrivenBody::outline(double t) const {
  std::optional<Outline> drawn = body_.outline(t);
  if (!drawn) return drawn;
  drawn->x = now_.x + now_.turn * (drawn->x - start_.x);
  drawn->frame = now_.turn * drawn->frame;
  return drawn;
}

void DrivenBody::record() const {
  mode_ = Mode::records;
  read_ = false;
  for (auto* all : {&places_, &velocities_, &lengths_, &loads_}) all->clear();
}

BodyWrench DrivenBody::wrench() const {
  if (mode_ != Mode::records) return {};
  read_ = true;
  return recorded();
}

BodyWrench DrivenBody::recorded() const {
  BodyWrench sum;
  for (std::size_t i = 0; i < loads_.size(); i += 3) {
    const Vec f = load3(&loads_[i]);
    sum.force = sum.force - f;
    sum.moment = sum.moment - cross(load3(&places_[i]) - now_.x, f);
  }
  return sum;
}

bool DrivenBody::touched() const {
  return std::ranges::any_of(loads_, [](double f) { return f != 0; });
}

void DrivenBody::slopes(double t, Weights w, std::span<const Screw> screws,
                        Slopes& to) const {
  const Points p{.count = static_cast<int>(lengths_.size()),
                 .x = places_,
                 .v = velocities_,
                 .tangent = {},
                 .mass = {},
                 .length = lengths_};
  const std::size_t points = lengths_.size(), count = screws.size();
  blocks_.assign(9 * points, 0.0);
  law_slopes(t, p, 1, 0, blocks_);
  by_velocity_.assign(9 * points, 0.0);
  law_slopes(t, p, 0, 1, by_velocity_);
  to.of.resize(count);
  for (auto& of : to.of) {
    for (auto* all : {&of.by_motion, &of.load, &of.rate}) all->assign(3 * points, 0.0);
  }
  to.own.assign(count * count, 0.0);
  for (std::size_t i = 0; i < points; ++i) {
    const auto block = [i](const std::vector<double>& of) {
      const double* b = &of[9 * i];
      return Mat3{load3(b), load3(b + 3), load3(b + 6)};
    };
    const Mat3 dx = block(blocks_), du = block(by_velocity_);
    const Vec f = load3(&loads_[3 * i]), x = load3(&places_[3 * i]), r = x - now_.x;
    const Vec relative = load3(&velocities_[3 * i]) - surface_velocity(x);
    for (std::size_t j = 0; j < count; ++j) {
      const auto& [e, shift, spin] = screws[j];
      const Vec turned = cross(e, r), s = shift + turned;
      const Vec swept = cross(now_.omega, turned) + cross(e, relative) + cross(spin, r);
      const Vec by_place = cross(e, f) - dx * s - du * swept;
      store3(w.pos * by_place - w.vel * (du * s), &to.of[j].by_motion[3 * i]);
      const Vec by_velocity = s * du;
      store3(w.pos * (cross(f, e) + s * dx) + w.vel * by_velocity, &to.of[j].load[3 * i]);
      store3(w.pos * by_velocity, &to.of[j].rate[3 * i]);
    }
    for (std::size_t j = 0; j < count; ++j) {
      const Vec s = screws[j].shift + cross(screws[j].turn, r);
      for (std::size_t l = 0; l < count; ++l) {
        to.own[l * count + j] += dot(s, load3(&to.of[l].by_motion[3 * i]));
      }
    }
  }
}

void DrivenBody::replace(In loads, double factor) const {
  mode_ = Mode::replaced;
  given_ = loads;
  factor_ = factor;
  next_ = 0;
}

std::vector<const DrivenBody*> driven_bodies(const Effects& effects) {
  std::vector<const DrivenBody*> all;
  for (const auto& effect : effects) {
    if (const auto* body = dynamic_cast<const DrivenBody*>(effect.get())) {
      all.push_back(body);
    }
  }
  return all;
}

}  // namespace tress::models
