#include "simulation/rest/body_support.h"

#include <cmath>

#include "contract/input_error.h"
#include "models/effects/body.h"
#include "simulation/rest/natural_gain.h"
#include "simulation/scene/scene_check.h"

namespace tress::simulation {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;
using models::Body;
using models::Effect;
using models::Effects;
using models::Needs;
using models::Points;

/// Given forces on the points of a strand; remembers where these were last.
class GivenForces final : public Effect {
 public:
  std::string_view name() const override { return "given_forces"; }
  Needs needs() const override { return {.position = true}; }
  void add_load(double, const Points& p, InOut f) const noexcept override {
    x.assign(p.x.begin(), p.x.end());
    length.assign(p.length.begin(), p.length.end());
    for (std::size_t i = 0; i < forces.size(); ++i) f[i] += forces[i];
  }
  void add_derivatives(double, const Points&, double, double,
                       InOut) const noexcept override {}
  double potential(double, const Points&) const noexcept override { return 0; }
  double power(double, const Points&) const noexcept override { return 0; }

  std::vector<double> forces;             // (3 points), none: 0
  mutable std::vector<double> x, length;  // (3 points), (points)
};

/// A point of the strand in a body.
struct Touch {
  std::size_t body, point;
  double depth;      // m
  double per_depth;  // N/m
  Vec normal;
};

std::vector<Touch> touches(const Effects& effects, const GivenForces& points) {
  Points p;
  p.count = static_cast<int>(points.length.size());
  p.x = points.x;
  p.length = points.length;
  std::vector<Touch> all;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const auto* body = dynamic_cast<const Body*>(effects[e].get());
    if (body == nullptr) continue;
    const models::RigidContact& contact = body->contact_on_points();
    const models::BodyPose pose = body->pose(0);
    contact.body.for_near<models::RigidBody::With::position>(
        pose, p, [&](std::size_t) { return contact.law.offset; },
        [&](const models::RigidBody::Near& at) {
          const double steepness = norm(at.to.gradient);
          const double per_depth = p.length[at.point] * contact.law.stiffness * steepness;
          if (!(per_depth > 0)) return;
          all.push_back({e, at.point, contact.law.offset - at.to.value, per_depth,
                         pose.frame * ((1 / steepness) * at.to.gradient)});
        });
  }
  return all;
}

void refuse_held_contacts(const Effects& effects, const GivenForces& points) {
  for (const auto& effect : effects) {
    if (effect->for_strand(0) == nullptr) continue;
    if (effect->penetration(0, points.x).value_or(0) <= 0) continue;
    throw InputError(
        "a strand that starts in a body with friction_law = \"exact\", whose forces are "
        "not known beforehand",
        inverse_rest, "use friction_law = \"regularised\", or start outside");
  }
}

/// The residual that a unit force on each point leaves.
MatrixXd pulls(const std::vector<Touch>& all, GivenForces& points,
               DenseStatics& statics) {
  const VectorXd load = statics.residual();
  MatrixXd pull(load.size(), std::ssize(all));
  points.forces.assign(points.x.size(), 0.0);
  for (std::size_t c = 0; c < all.size(); ++c) {
    double* const force = &points.forces[3 * all[c].point];
    store3(all[c].normal, force);
    pull.col(static_cast<Eigen::Index>(c)) = statics.residual() - load;
    store3(Vec{}, force);
  }
  return pull;
}

}  // namespace

HoldingBodies body_support(const Scene& scene, const Strand& strand,
                           const Parameters& model_options, const Effects& effects) {
  const auto points = std::make_shared<GivenForces>();
  Effects others{points};
  for (const auto& effect : effects) {
    if (dynamic_cast<const Body*>(effect.get()) == nullptr) others.push_back(effect);
  }
  if (others.size() == effects.size() + 1 && !hold_contacts(effects)) return {};
  const auto system = scene.model->on_strand(strand, model_options, others);
  NaturalStrains& strains = strains_to_hold(scene, strand, *system, inverse_rest);
  DenseStatics statics(*system, coordinates_at_start(*system));
  const VectorXd load = statics.residual();
  refuse_held_contacts(effects, *points);
  const std::vector<Touch> all = touches(effects, *points);
  if (all.empty()) return {};

  const std::vector<double> stiffness = strains.natural_stiffness();
  const VectorXd weight =
      Eigen::Map<const VectorXd>(stiffness.data(), std::ssize(stiffness)).cwiseSqrt();
  const MatrixXd energy = weight.asDiagonal() * natural_gain(statics, strains);
  constexpr double ridge = 1e-3;  // spreads forces over neighbouring points
  const VectorXd force =
      nonnegative(energy * pulls(all, *points, statics), -energy * load, ridge);

  HoldingBodies support;
  for (std::size_t c = 0; c < all.size(); ++c) {
    if (support.offsets.empty() || support.offsets.back().first != all[c].body) {
      support.offsets.push_back(
          {all[c].body, std::vector<double>(points->length.size())});
    }
    const double f = force[static_cast<Eigen::Index>(c)];
    support.offsets.back().second[all[c].point] = f / all[c].per_depth - all[c].depth;
    support.contacts += f > 0;
  }
  return support;
}

std::shared_ptr<const Effect> with_offsets(const Effect& body,
                                           const std::vector<double>& more) {
  return dynamic_cast<const Body&>(body).with_offsets(more);
}

}  // namespace tress::simulation
