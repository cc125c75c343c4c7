#include "models/supports/supported_compliance.h"

#include <algorithm>

namespace tress::models {

bool SupportedCompliance::available(System& strand, const AddedForces& forces) {
  if (forces.joints() > 0 || strand.compliance_form() == nullptr) return false;
  return std::ranges::all_of(forces.springs(), [&](const auto& of) {
    const auto mean = strand.material_points()->mean(of.second.point());
    return mean && mean->count == 1;
  });
}

SupportedCompliance::SupportedCompliance(System& strand, AddedForces& forces,
                                         NaturalMotion& natural)
    : form_(*strand.compliance_form()),
      strains_(natural_strains(strand)),
      forces_(forces),
      natural_(natural),
      own_(form_.blocks().size()),
      blocks_(form_.blocks()),
      w_(static_cast<std::size_t>(strand.layout().coordinates)),
      moments_(w_.size()) {
  form_.inverse_mass(w_);
  for (const auto& [support, spring] : forces_.springs()) {
    const auto mean = *strand.material_points()->mean(spring.point());
    Block block;
    for (int c = 0; c < 3; ++c) block.coordinates.push_back(mean.coordinate[0] + c);
    block.rows = static_cast<int>(spring.axes().size());
    for (std::size_t r = 0; r < spring.axes().size(); ++r) {
      block.alpha[r] = 1 / spring.stiffness();
      block.friction[r] = spring.damping();
    }
    blocks_.push_back(std::move(block));
    weight_.push_back(mean.weight[0]);
  }
}

Status SupportedCompliance::rest(double t, In q, In v, Out a) noexcept {
  prepare(t);
  const Status s = form_.rest(t, q, v, a);
  if (s != Status::ok || !forces_.has_moments()) return s;
  std::ranges::fill(moments_, 0.0);
  forces_.add_moments(t, q, moments_);
  for (std::size_t i = 0; i < a.size(); ++i) a[i] -= w_[i] * moments_[i];
  return Status::ok;
}

void SupportedCompliance::evaluate(double t, std::size_t k, In x, Value& value) noexcept {
  prepare(t);
  if (k < own_) return form_.evaluate(t, k, x, value);
  const PointSpring& spring = forces_.springs()[k - own_].second;
  const double weight = weight_[k - own_];
  const RootPose pose = spring.path().at(t);
  const Vec gap = weight * load3(x.data()) - pose.x;
  for (std::size_t r = 0; r < spring.axes().size(); ++r) {
    const Vec& axis = spring.axes()[r];
    value.c[r] = dot(axis, gap);
    value.drift[r] = -dot(axis, pose.v);
    store3(weight * axis, value.gradient[r]);
  }
}

bool SupportedCompliance::add_second(double t, std::size_t k, In x, In stress,
                                     Second& h) noexcept {
  prepare(t);
  return k >= own_ || form_.add_second(t, k, x, stress, h);
}

void SupportedCompliance::orient(double t, double h, std::size_t k, In origin,
                                 InOut x) noexcept {
  prepare(t);
  form_.orient(t, h, k, origin, x);
}

}  // namespace tress::models
