// The ComplianceForm of maximal_system.h.
#include <algorithm>

#include "linear/finite.h"
#include "models/maximal/maximal_system.h"

namespace tress::models {

/// Every mass point is a node of its own.
bool MaximalSystem::diagonal_mass() const {
  return regular_mass_ && std::ranges::all_of(strand_.mass, [](const auto& point) {
           return point.at.nodes == 1;
         });
}

ComplianceForm* MaximalSystem::compliance_form() {
  StrainForm* strains = strand_.elasticity->strain_form();
  if (strains == nullptr || strand_.constraints || !diagonal_mass()) return nullptr;
  if (!compliant_.empty()) return this;
  compliant_ = strains->strain_blocks();
  for (Block& block : compliant_) {  // from places in z to places in q
    const auto moving =
        std::ranges::lower_bound(block.coordinates, static_cast<int>(held()));
    prescribed_.push_back(static_cast<std::size_t>(moving - block.coordinates.begin()));
    block.coordinates.erase(block.coordinates.begin(), moving);
    for (int& coordinate : block.coordinates) coordinate -= static_cast<int>(held());
  }
  return this;
}

void MaximalSystem::inverse_mass(Out w) const {
  for (const auto& point : strand_.mass) {
    const std::size_t at = 3 * static_cast<std::size_t>(point.at.first);
    if (at < held()) continue;
    std::ranges::fill(w.subspan(at - held(), 3), 1 / point.mass);
  }
  const std::size_t others = w.size() - strand_.inertia.size();
  std::ranges::transform(strand_.inertia, w.subspan(others).begin(),
                         [](double inertia) { return 1 / inertia; });
}

Status MaximalSystem::rest(double t, In q, In v, Out a) noexcept {
  place(t, q, v);
  loads(t);
  std::ranges::fill(a, 0.0);
  for (std::size_t i = 0; i < strand_.mass.size(); ++i) {
    const std::size_t at = 3 * static_cast<std::size_t>(strand_.mass[i].at.first);
    if (at >= held()) store3(1 / mass_[i] * load3(&load_[3 * i]), &a[at - held()]);
  }
  return all_finite(a) ? Status::ok : Status::retry;
}

void MaximalSystem::evaluate(double t, std::size_t k, In x, Value& value) noexcept {
  look_at(t);
  const std::size_t prescribed = prescribed_[k];
  const auto rows = static_cast<std::size_t>(compliant_[k].rows);
  double z[most_coordinates];
  if (prescribed > 0) store3(pose_.x, z);
  std::ranges::copy(x, z + prescribed);
  strand_.elasticity->strain_form()->strain(k, pose_, z, value);
  if (prescribed == 0) return;
  for (std::size_t row = 0; row < rows; ++row) {  // what the root moves is drift
    double* slope = value.gradient[row];
    value.drift[row] += dot(load3(slope), pose_.v);
    std::copy_n(slope + prescribed, x.size(), slope);
  }
}

}  // namespace tress::models
