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
  orientations_ = strains->orientations();
  const auto to_moving = [this](std::vector<int>& coordinates) {  // from z to q
    const auto moving = std::ranges::lower_bound(coordinates, static_cast<int>(held()));
    const auto prescribed = static_cast<std::size_t>(moving - coordinates.begin());
    coordinates.erase(coordinates.begin(), moving);
    for (int& coordinate : coordinates) coordinate -= static_cast<int>(held());
    return prescribed;
  };
  for (Block& block : compliant_) prescribed_.push_back(to_moving(block.coordinates));
  for (Orientation& orientation : orientations_) {
    prescribed_of_orientation_.push_back(to_moving(orientation.coordinates));
    orientation.own -= prescribed_of_orientation_.back();
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

bool MaximalSystem::add_second(double t, std::size_t k, In x, In stress,
                               Second& h) noexcept {
  look_at(t);
  StrainForm& strains = *strand_.elasticity->strain_form();
  const std::size_t prescribed = prescribed_[k];
  if (prescribed == 0) {
    strains.add_second(k, pose_, x.data(), stress, h);
    return true;
  }
  double z[most_coordinates];
  Second of_all = {};
  store3(pose_.x, z);
  std::ranges::copy(x, z + prescribed);
  strains.add_second(k, pose_, z, stress, of_all);
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (std::size_t j = 0; j < x.size(); ++j) {
      h[i][j] += of_all[prescribed + i][prescribed + j];
    }
  }
  return true;
}

void MaximalSystem::orient(double t, double h, std::size_t k, In origin,
                           InOut x) noexcept {
  look_at(t);
  const std::size_t prescribed = prescribed_of_orientation_[k];
  double z[most_oriented] = {}, from[most_oriented] = {};
  if (prescribed > 0) store3(pose_.x, z);
  std::ranges::copy(x, z + prescribed);
  std::ranges::copy(origin, from + prescribed);
  strand_.elasticity->strain_form()->orient(k, pose_, h, from, z,
                                            &x[orientations_[k].own]);
}

}  // namespace tress::models
