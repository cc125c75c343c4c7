#pragma once

#include <array>
#include <cstddef>
#include <vector>

#include "contract/system.h"
#include "models/effects/coupling.h"

namespace tress::models {

/// Numbers of the four points of a contact.
using FourPoints = std::array<std::size_t, 4>;
inline FourPoints points_of(const Coupling& contact) {
  const auto& e = contact.ends;
  return {e[0].point, e[1].point, e[2].point, e[3].point};
}

/// Pattern of the derivatives of contacts between points that are means of coordinates
/// (each P q).
class CouplingColumns {
 public:
  CouplingColumns(int coordinates, const std::vector<MaterialPoints::Mean>& means)
      : means_(means), columns_(static_cast<std::size_t>(coordinates)) {}
  void add(const FourPoints& contact);
  Pattern pattern() &&;

 private:
  const std::vector<MaterialPoints::Mean>& means_;
  std::vector<std::vector<int>> columns_;
};

/// values += P^T (pos df/dx + vel df/dv) P on that pattern.
void add_coupling(const Pattern& pattern, const std::vector<MaterialPoints::Mean>& means,
                  const Coupling& contact, double pos, double vel, InOut values) noexcept;

}  // namespace tress::models
