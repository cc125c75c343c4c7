#include "models/constrained/particles.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "contract/input_error.h"
#include "contract/system.h"
#include "linear/finite.h"
#include "linear/sparse_pattern.h"
#include "models/strand/not_finite.h"

namespace tress::models {
namespace {

constexpr double consistency = 1e-9;  // relative error allowed in an initial state

/// Largest distance from the first particle, 1 m for a lone one.
double extent_of(const ParticleScene& scene) {
  if (scene.particles.empty()) {
    throw InputError("a scene has no particles", "particle system",
                     "add at least one particle");
  }
  const Vec first = scene.particles.front().x;
  double extent = 0;
  for (const auto& p : scene.particles) extent = std::max(extent, norm(p.x - first));
  for (const Anchor& a : scene.anchors) {
    const Vec x = a.motion ? a.motion->at(0).c : a.x;
    extent = std::max(extent, norm(x - first));
  }
  return extent > 0 ? extent : 1;
}

double speed_of(const ParticleScene& scene, double extent) {
  double speed = scene.typical_speed;
  for (const auto& p : scene.particles) speed = std::max(speed, norm(p.v));
  return speed > 0 ? speed : extent;  // per second
}

/// False when the 3x3 matrix m is singular.
bool invert(const double* m, double* inverse) {
  const Vec a = load3(m);
  const Vec b = load3(m + 3);
  const Vec c = load3(m + 6);
  const Vec bc = cross(b, c);
  const double det = dot(a, bc);
  if (det == 0 || !std::isfinite(det)) return false;
  const Vec columns[] = {bc, cross(c, a), cross(a, b)};
  for (int j = 0; j < 3; ++j) {
    inverse[j] = columns[j].x / det;
    inverse[3 + j] = columns[j].y / det;
    inverse[6 + j] = columns[j].z / det;
  }
  return true;
}

}  // namespace

Node ParticleScene::add_particle(double mass, Vec x, Vec v, double length) {
  particles.push_back({mass, x, v, length});
  return {Node::Kind::particle, static_cast<int>(particles.size()) - 1};
}

Node ParticleScene::add_parameter(double s, double rate) {
  parameters.push_back({s, rate});
  return {Node::Kind::parameter, static_cast<int>(parameters.size()) - 1};
}

Node ParticleScene::add_anchor(Vec x) {
  anchors.push_back({x, nullptr});
  return {Node::Kind::anchor, static_cast<int>(anchors.size()) - 1};
}

Node ParticleScene::add_anchor(std::shared_ptr<const Curve> motion) {
  anchors.push_back({{}, std::move(motion)});
  return {Node::Kind::anchor, static_cast<int>(anchors.size()) - 1};
}

ParticleSystem::ParticleSystem(ParticleScene scene)
    : scene_(std::move(scene)),
      held_contacts_(scene_.effects, scene_.particles.size(),
                     [this](double, In q, In v) { return points(q, v); }),
      particles_(static_cast<int>(scene_.particles.size())),
      coordinates_(3 * particles_ + static_cast<int>(scene_.parameters.size())),
      extent_(extent_of(scene_)),
      speed_(speed_of(scene_, extent_)),
      needs_(needs(scene_.effects)),
      constraints_(std::move(scene_.constraints), std::move(scene_.anchors), particles_,
                   static_cast<int>(scene_.parameters.size()), extent_) {
  validate();
  for (const auto& p : scene_.particles) {
    mass_.push_back(p.mass);
    length_.push_back(p.length);
  }
  load_.resize(3 * mass_.size());
  blocks_.resize(9 * mass_.size());
  inverse_.resize(9 * mass_.size());
  build_pattern();
  constraints_.bind(pattern_);
  check_initial_state();
}

void ParticleSystem::validate() const {
  for (std::size_t i = 0; i < scene_.particles.size(); ++i) {
    const auto& p = scene_.particles[i];
    const bool finite = std::isfinite(p.mass + p.length + dot(p.x, p.x) + dot(p.v, p.v));
    if (!finite || p.mass <= 0 || p.length < 0) {
      throw InputError("mass, length, position or velocity is out of range",
                       "particle " + std::to_string(i),
                       "give mass > 0, length >= 0 and finite vectors");
    }
  }
  if (needs_.tangent) {
    throw InputError("an effect needs tangents, which loose particles do not have",
                     "particle system", "use a strand model for this effect");
  }
}

void ParticleSystem::build_pattern() {
  std::vector<std::vector<int>> columns(static_cast<std::size_t>(coordinates_));
  for (int j = 0; j < 3 * particles_; ++j) {
    for (int k = 0; k < 3; ++k) {
      columns[static_cast<std::size_t>(j)].push_back(j - j % 3 + k);
    }
  }
  constraints_.couple(columns);
  pattern_ = pattern_of(coordinates_, std::move(columns));
  for (int i = 0; i < 3 * particles_; ++i) {
    for (int j = i - i % 3; j < i - i % 3 + 3; ++j) {
      block_.push_back(place_of(pattern_, i, j));
    }
  }
}

void ParticleSystem::check_initial_state() {
  const auto n = static_cast<std::size_t>(coordinates_);
  const auto m = static_cast<std::size_t>(constraints_.rows());
  std::vector<double> q(n), v(n), g(m), g_dot(m), g_typ(m);
  initial_state(q, v);
  constraints_.scale(g_typ);
  if (constraints_.value(0, q, g) != Status::ok ||
      constraints_.rate(0, q, v, g_dot) != Status::ok) {
    throw InputError("constraints cannot be evaluated", "particle system",
                     "check the initial positions");
  }
  for (std::size_t k = 0; k < m; ++k) {
    const double rate_typ = speed_ * std::max(1.0, g_typ[k] / extent_);
    if (!(std::abs(g[k]) <= consistency * g_typ[k]) ||
        !(std::abs(g_dot[k]) <= consistency * rate_typ)) {
      throw InputError("the initial state violates constraint row " + std::to_string(k),
                       "particle system",
                       "give positions and velocities that satisfy g = 0 and g' = 0");
    }
  }
}

Layout ParticleSystem::layout() const { return {coordinates_, constraints_.rows()}; }

Traits ParticleSystem::traits() const {
  return {.constant_mass = true, .regular_mass = scene_.parameters.empty()};
}

void ParticleSystem::initial_state(Out q, Out v) const {
  std::size_t i = 0;
  for (const auto& p : scene_.particles) {
    store3(p.x, &q[i]);
    store3(p.v, &v[i]);
    i += 3;
  }
  for (const auto& p : scene_.parameters) {
    q[i] = p.s;
    v[i++] = p.rate;
  }
}

void ParticleSystem::scale(Out q_typ, Out v_typ) const {
  const int positions = 3 * particles_;
  std::fill_n(q_typ.begin(), positions, extent_);
  std::fill_n(v_typ.begin(), positions, speed_);
  std::fill(q_typ.begin() + positions, q_typ.end(), 1.0);
  std::fill(v_typ.begin() + positions, v_typ.end(), speed_ / extent_);
}

Points ParticleSystem::points(In q, In v) const {
  const auto size = 3 * static_cast<std::size_t>(particles_);
  Points p;
  p.count = particles_;
  p.x = q.first(size);
  if (needs_.velocity) p.v = v.first(size);
  p.mass = mass_;
  p.length = length_;
  return p;
}

void ParticleSystem::load(double t, In q, In v) noexcept {
  std::fill(load_.begin(), load_.end(), 0.0);
  const Points p = points(q, v);
  for (const auto& effect : scene_.effects) effect->add_load(t, p, load_);
}

Status ParticleSystem::residual(double t, In q, In v, In a, Out r) noexcept {
  for (std::size_t i = 0; i < mass_.size(); ++i) {
    store3(mass_[i] * load3(&a[3 * i]), &r[3 * i]);
  }
  std::fill(r.begin() + 3 * particles_, r.end(), 0.0);
  if (!scene_.effects.empty()) {
    load(t, q, v);
    for (std::size_t i = 0; i < load_.size(); ++i) r[i] -= load_[i];
  }
  return all_finite(r) ? Status::ok : Status::retry;
}

/// blocks_ = w.acc m I - w.pos df/dx - w.vel df/dv per particle.
void ParticleSystem::blocks(double t, In q, In v, Weights w) noexcept {
  std::fill(blocks_.begin(), blocks_.end(), 0.0);
  if (needs_.derivatives) {
    const Points p = points(q, v);
    for (const auto& effect : scene_.effects) {
      if (effect->needs().derivatives) {
        effect->add_derivatives(t, p, -w.pos, -w.vel, blocks_);
      }
    }
  }
  for (std::size_t i = 0; i < mass_.size(); ++i) {
    for (const std::size_t k : {0, 4, 8}) blocks_[9 * i + k] += w.acc * mass_[i];
  }
}

Status ParticleSystem::linearize(double t, In q, In v, In, Weights w) noexcept {
  if (!scene_.parameters.empty()) return Status::fatal;
  blocks(t, q, v, w);
  for (std::size_t i = 0; i < mass_.size(); ++i) {
    if (!invert(&blocks_[9 * i], &inverse_[9 * i])) return Status::retry;
  }
  return Status::ok;
}

Status ParticleSystem::solve(In b, Out x) noexcept {
  for (std::size_t i = 0; i < mass_.size(); ++i) {
    const double* inverse = &inverse_[9 * i];
    const Vec rhs = load3(&b[3 * i]);
    store3(Vec{dot(load3(inverse), rhs), dot(load3(inverse + 3), rhs),
               dot(load3(inverse + 6), rhs)},
           &x[3 * i]);
  }
  return Status::ok;
}

Status ParticleSystem::values(double t, In q, In v, In, Weights w, Out s) noexcept {
  blocks(t, q, v, w);
  std::fill(s.begin(), s.end(), 0.0);
  for (std::size_t i = 0; i < blocks_.size(); ++i) {
    s[static_cast<std::size_t>(block_[i])] = blocks_[i];
  }
  return Status::ok;
}

ExplicitForm* ParticleSystem::explicit_form() {
  return constraints_.rows() == 0 && scene_.parameters.empty() ? this : nullptr;
}

ConstraintForm* ParticleSystem::constraint_form() {
  return constraints_.rows() > 0 ? &constraints_ : nullptr;
}

Status ParticleSystem::acceleration(double t, In q, In v, Out a) noexcept {
  load(t, q, v);
  for (std::size_t i = 0; i < mass_.size(); ++i) {
    store3((1 / mass_[i]) * load3(&load_[3 * i]), &a[3 * i]);
  }
  return all_finite(a) ? Status::ok : Status::retry;
}

std::string ParticleSystem::not_finite(double t, In q, In v) {
  const auto particles = 3 * static_cast<std::size_t>(particles_);
  const auto of_coordinates = [particles](In x, const std::string& what) {
    return first_words(
        [&] { return not_finite_place(x.first(particles), 3, what + " of particle"); },
        [&] {
          return not_finite_place(x.subspan(particles), 1, what + " of parameter");
        });
  };
  return first_words([&] { return of_coordinates(q, "coordinates"); },
                     [&] { return of_coordinates(v, "rates"); },
                     [&] { return not_finite_load(scene_.effects, t, points(q, v)); });
}

Energy ParticleSystem::energy(double t, In q, In v) {
  Energy energy;
  for (std::size_t i = 0; i < mass_.size(); ++i) {
    const Vec u = load3(&v[3 * i]);
    energy.kinetic += mass_[i] / 2 * dot(u, u);
  }
  const Points p = points(q, v);
  for (const auto& effect : scene_.effects) energy.potential += effect->potential(t, p);
  return energy;
}

double ParticleSystem::power(double t, In q, In v) {
  double sum = 0;
  const Points p = points(q, v);
  for (const auto& effect : scene_.effects) sum += effect->power(t, p);
  return sum;
}

void ParticleSystem::positions(double, In q, Out x) {
  std::copy_n(q.begin(), 3 * particles_, x.begin());
}

void ParticleSystem::velocities(double, In, In v, Out u) {
  std::copy_n(v.begin(), 3 * particles_, u.begin());
}

}  // namespace tress::models
