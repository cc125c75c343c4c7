#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include "models/quaternion_rods/rotation_vectors.h"
#include "tests/models/reduced/strand_cases.h"

namespace tress::testing_support {

inline const ModelSettings rotations = {{"coordinates", "rotation_vector"}};

/// A model in rotation vectors, and the angle at which it renews references.
struct VectorRod {
  const char* model;
  const char* renewal;
};
inline void PrintTo(const VectorRod& rod, std::ostream* out) {  // NOLINT
  *out << rod.model << " " << rod.renewal;
}

class VectorRods : public testing::TestWithParam<VectorRod> {
 protected:
  ModelSettings chosen(const ModelSettings& settings) const {
    return with(with(settings, rotations), {{"renewal_angle_rad", GetParam().renewal}});
  }
  std::unique_ptr<System> make(const ModelSettings& settings) const {
    return make_model(GetParam().model, chosen(settings));
  }
};

inline auto vector_rods() {
  return testing::Values(VectorRod{"corde", "1"}, VectorRod{"corde", "0"},
                         VectorRod{"xpbd_cosserat", "1"},
                         VectorRod{"xpbd_cosserat", "0"});
}
inline std::string name_of(const testing::TestParamInfo<VectorRod>& test) {
  return std::string(test.param.model) + "_" + test.param.renewal;
}

/// Keeps the largest distance of a rod's norms from 1 in `most`.
inline Observer norm_watcher(System& system, std::size_t edges, double& most) {
  auto* const vectors = dynamic_cast<RotationVectors*>(&system);
  const auto n = static_cast<std::size_t>(system.layout().coordinates) +
                 (vectors != nullptr ? edges : 0);
  return [=, &most, of_rod = std::vector<double>(n)](double, In q, In) mutable {
    if (vectors != nullptr) {
      vectors->rod_coordinates(q, of_rod);
    } else {
      std::ranges::copy(q, of_rod.begin());
    }
    for (std::size_t k = n - 4 * edges; k < n; k += 4) {
      const Quaternion p = load_quaternion(&of_rod[k]);
      most = std::max(most, std::abs(std::sqrt(dot(p, p)) - 1));
    }
    return true;
  };
}

}  // namespace tress::testing_support
