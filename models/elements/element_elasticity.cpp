#include "models/elements/element_elasticity.h"

#include <algorithm>
#include <numeric>

namespace tress::models {
namespace {

using Placed = ElementElasticity::Placed;

int led(const Placed& at) { return at.first < 0 ? 3 : 0; }
int size(const Placed& at) { return 3 * at.element->nodes(); }
/// Of the coordinates of nodes that are not the clamp's.
std::size_t start(const Placed& at) {
  return 3 * static_cast<std::size_t>(std::max(at.first, 0));
}

}  // namespace

ElementElasticity::ElementElasticity(std::vector<Placed> elements, double behind)
    : elements_(std::move(elements)), behind_(behind) {
  std::ranges::stable_sort(elements_, {}, [](const Placed& at) {
    return 2 * at.first + at.element->nodes();  // the middle, in half edges
  });
}

ElementElasticity::Local ElementElasticity::local(const Placed& at, const RootPose& root,
                                                  const double* z,
                                                  const double* rate) const noexcept {
  Local local;
  if (led(at) > 0) {
    const Vec arm = -behind_ * root.frame.e0;
    store3(root.x + arm, local.x);
    store3(root.v + cross(root.omega, arm), local.rate);
  }
  std::copy_n(z, size(at) - led(at), local.x + led(at));
  std::copy_n(rate, size(at) - led(at), local.rate + led(at));
  return local;
}

ElementElasticity::Local ElementElasticity::local(const Placed& at, const RootPose& root,
                                                  In z, In rate) const noexcept {
  return local(at, root, &z[start(at)], &rate[start(at)]);
}

std::vector<std::vector<int>> ElementElasticity::groups() const {
  std::vector<std::vector<int>> all;
  for (const Placed& at : elements_) {
    std::vector<int> group(static_cast<std::size_t>(size(at) - led(at)));
    std::iota(group.begin(), group.end(), static_cast<int>(start(at)));
    all.push_back(std::move(group));
  }
  return all;
}

void ElementElasticity::add_force(const Placement& p, InOut f) noexcept {
  for (const Placed& at : elements_) {
    const Local now = local(at, p.root, p.z, p.rate);
    double force[RodElement::most_coordinates] = {};
    at.element->add_force(now.x, now.rate, force);
    double* to = &f[start(at)];
    for (int i = led(at); i < size(at); ++i) *to++ += force[i];
  }
}

void ElementElasticity::add_tangent(const Placement& p, double pos, double vel,
                                    GroupSum& s) noexcept {
  constexpr int most = RodElement::most_coordinates;
  for (std::size_t k = 0; k < elements_.size(); ++k) {
    const Placed& at = elements_[k];
    const Local now = local(at, p.root, p.z, p.rate);
    Local origin;
    // Edges are the stiffest: what turns them must not seem to stretch them.
    const bool take = p.origin != nullptr && at.element->nodes() == 2;
    if (take) origin = local(at, p.origin->root, p.origin->z, p.rate);
    double h[most * most];
    at.element->tangent(now.x, now.rate, pos, vel, p.origin, take ? origin.x : nullptr,
                        h);
    double* kept = h;
    for (int i = led(at); i < size(at); ++i) {
      for (int j = led(at); j < size(at); ++j) *kept++ = h[size(at) * i + j];
    }
    s.add(k, h);
  }
}

double ElementElasticity::energy(const Placement& p) noexcept {
  double sum = 0;
  for (const Placed& at : elements_) {
    sum += at.element->energy(local(at, p.root, p.z, p.rate).x);
  }
  return sum;
}

double ElementElasticity::power(const Placement& p) noexcept {
  double sum = 0;
  for (const Placed& at : elements_) {
    const Local now = local(at, p.root, p.z, p.rate);
    sum += at.element->power(now.x, now.rate, led(at));
  }
  return sum;
}

std::vector<ComplianceForm::Block> ElementElasticity::strain_blocks() const {
  const std::vector<std::vector<int>> coordinates = groups();
  std::vector<ComplianceForm::Block> blocks;
  for (std::size_t k = 0; k < elements_.size(); ++k) {
    blocks.push_back(elements_[k].element->block(coordinates[k]));
  }
  return blocks;
}

void ElementElasticity::strain(std::size_t k, const RootPose& root, const double* z,
                               ComplianceForm::Value& value) noexcept {
  const Placed& at = elements_[k];
  const Local now = local(at, root, z, z);
  at.element->strain(now.x, now.rate, led(at), value);
}

void ElementElasticity::add_second(std::size_t k, const RootPose& root, const double* z,
                                   In stress, ComplianceForm::Second& h) noexcept {
  const Placed& at = elements_[k];
  at.element->add_second(local(at, root, z, z).x, stress.data(), led(at), h);
}

}  // namespace tress::models
