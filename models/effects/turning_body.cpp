// Bodies that strands turn.
#include <algorithm>
#include <cmath>

#include "contract/input_error.h"
#include "models/effects/body.h"

namespace tress::models {

TurningBody::TurningBody(Body body, const Bearing& bearing)
    : body_(std::move(body)), bearing_(bearing), speed_(bearing.speed) {
  const double length = norm(bearing.axis);
  refuse_if(!std::isfinite(length) || length == 0 || !is_finite(bearing.pivot),
            "its axis has no direction or is not finite", "effect body",
            "give axis a direction, such as [0, 1, 0]");
  refuse_if(!(std::isfinite(bearing.inertia) && bearing.inertia > 0),
            "its moment of inertia is not positive or not finite", "effect body",
            "give inertia_kg_m2 > 0");
  refuse_if(!(std::isfinite(bearing.damping) && bearing.damping >= 0) ||
                !std::isfinite(bearing.moment) || !std::isfinite(bearing.speed),
            "its bearing has a negative damping or a number that is not finite",
            "effect body", "give bearing_damping_n_m_s >= 0 and finite numbers");
  bearing_.axis = (1 / length) * bearing.axis;
}

void TurningBody::turn_to(double angle, double speed) const {
  turn_ = rotation(bearing_.axis, angle);
  angle_ = angle;
  speed_ = speed;
}

void TurningBody::place_in_frame(In x) const {
  x_.resize(x.size());
  for (std::size_t i = 0; i + 2 < x.size(); i += 3) {
    store3(bearing_.pivot + turn_.back(load3(&x[i]) - bearing_.pivot), &x_[i]);
  }
}

Points TurningBody::in_frame(const Points& p) const {
  place_in_frame(p.x);
  v_.resize(p.v.size());
  for (std::size_t i = 0; i + 2 < p.v.size(); i += 3) {
    store3(turn_.back(load3(&p.v[i]) - speed_ * lever(load3(&p.x[i]))), &v_[i]);
  }
  Points seen = p;
  seen.x = x_;
  seen.v = v_;
  return seen;
}

/// Sets f.
void TurningBody::law(double t, const Points& p, InOut f) const {
  std::ranges::fill(f, 0.0);
  body_.add_load(t, in_frame(p), f);
  for (std::size_t i = 0; i + 2 < f.size(); i += 3) {
    store3(turn_ * load3(&f[i]), &f[i]);
  }
}

void TurningBody::add_load(double t, const Points& p, InOut f) const noexcept {
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
  places_.insert(places_.end(), p.x.begin(), p.x.begin() + std::ptrdiff_t(count));
  velocities_.insert(velocities_.end(), p.v.begin(), p.v.begin() + std::ptrdiff_t(count));
  lengths_.insert(lengths_.end(), p.length.begin(), p.length.end());
  loads_.insert(loads_.end(), load_.begin(), load_.end());
}

/// The surface moves faster further out: the velocity relative to it falls by omega e x
/// dx.
void TurningBody::law_slopes(double t, const Points& p, double pos, double vel,
                             InOut blocks) const {
  const Points seen = in_frame(p);
  block_.assign(blocks.size(), 0.0);
  body_.add_derivatives(t, seen, pos, 0, blocks);
  body_.add_derivatives(t, seen, 0, 1, block_);
  const Mat3 spin = speed_ * cross_matrix(bearing_.axis);
  const auto world = [&](In of, std::size_t i) {
    return turned(turn_, {load3(&of[i]), load3(&of[i + 3]), load3(&of[i + 6])});
  };
  for (std::size_t i = 0; i + 8 < blocks.size(); i += 9) {
    const Mat3 by_u = world(block_, i);
    const Mat3 all = world(blocks, i) - pos * (by_u * spin) + vel * by_u;
    store3(all.r0, &blocks[i]);
    store3(all.r1, &blocks[i + 3]);
    store3(all.r2, &blocks[i + 6]);
  }
}

void TurningBody::add_derivatives(double t, const Points& p, double pos, double vel,
                                  InOut blocks) const noexcept {
  blocks_.assign(blocks.size(), 0.0);
  law_slopes(t, p, pos, vel, blocks_);
  for (std::size_t i = 0; i < blocks.size(); ++i) blocks[i] += blocks_[i];
}

double TurningBody::potential(double t, const Points& p) const noexcept {
  return body_.potential(t, in_frame(p));
}

double TurningBody::power(double t, const Points& p) const noexcept {
  return body_.power(t, in_frame(p));
}

std::optional<double> TurningBody::penetration(double t, In x) const {
  place_in_frame(x);
  return body_.penetration(t, x_);
}

double TurningBody::surface_speed(double /*t*/, In x, double near) const {
  place_in_frame(x);
  const RigidBody& body = body_.contact_on_points().body;
  const auto pose = body_.pose(0);
  double fastest = 0;
  for (std::size_t i = 0; i + 2 < x.size(); i += 3) {
    const Vec at = pose.frame.back(load3(&x_[i]) - pose.x);
    if (!body.distance(at, body.offset() + near)) continue;
    fastest = std::max(fastest, std::abs(speed_) * norm(lever(load3(&x[i]))));
  }
  return fastest;
}

std::optional<Outline> TurningBody::outline(double t) const {
  std::optional<Outline> drawn = body_.outline(t);
  if (!drawn) return drawn;
  drawn->x = bearing_.pivot + turn_ * (drawn->x - bearing_.pivot);
  drawn->frame = turn_ * drawn->frame;
  return drawn;
}

void TurningBody::record() const {
  mode_ = Mode::records;
  for (auto* all : {&places_, &velocities_, &lengths_, &loads_}) all->clear();
}

double TurningBody::moment() const {
  double sum = 0;
  for (std::size_t i = 0; i < loads_.size(); i += 3) {
    sum -= dot(lever(load3(&places_[i])), load3(&loads_[i]));
  }
  return sum;
}

bool TurningBody::touched() const {
  return std::ranges::any_of(loads_, [](double f) { return f != 0; });
}

void TurningBody::slopes(double t, Weights w, Slopes& to) const {
  const Points p{.count = static_cast<int>(lengths_.size()),
                 .x = places_,
                 .v = velocities_,
                 .tangent = {},
                 .mass = {},
                 .length = lengths_};
  const std::size_t points = lengths_.size();
  std::vector<double>&by_x = blocks_, &by_u = to.rate;
  by_x.assign(9 * points, 0.0);
  law_slopes(t, p, 1, 0, by_x);
  by_u.assign(9 * points, 0.0);
  law_slopes(t, p, 0, 1, by_u);
  to.by_turn.assign(3 * points, 0.0);
  to.moment = to.by_turn;
  to.own = 0;
  const Vec& e = bearing_.axis;
  for (std::size_t i = 0; i < points; ++i) {
    const auto block = [i](const std::vector<double>& of) {
      const double* b = &of[9 * i];
      return Mat3{load3(b), load3(b + 3), load3(b + 6)};
    };
    const Mat3 dx = block(by_x), du = block(by_u);
    const Vec f = load3(&loads_[3 * i]), u = load3(&velocities_[3 * i]);
    const Vec s = lever(load3(&places_[3 * i]));
    const Vec by_angle = cross(e, f) - dx * s - du * cross(e, u);
    const Vec by_turn = w.pos * by_angle - w.vel * (du * s);
    const Vec by_place = cross(f, e) + s * dx, by_velocity = s * du;
    store3(by_turn, &to.by_turn[3 * i]);
    store3(w.pos * by_place + w.vel * by_velocity, &to.moment[3 * i]);
    // Block i is read, and earlier ones are no longer needed.
    store3(w.pos * by_velocity, &to.rate[3 * i]);
    to.own += dot(s, by_turn);
  }
  to.rate.resize(3 * points);
}

void TurningBody::replace(In loads, double factor) const {
  mode_ = Mode::replaced;
  given_ = loads;
  factor_ = factor;
  next_ = 0;
}

std::vector<const TurningBody*> turning_bodies(const Effects& effects) {
  std::vector<const TurningBody*> all;
  for (const auto& effect : effects) {
    if (const auto* body = dynamic_cast<const TurningBody*>(effect.get())) {
      all.push_back(body);
    }
  }
  return all;
}

}  // namespace tress::models
