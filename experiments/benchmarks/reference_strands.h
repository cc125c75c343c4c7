#pragma once

#include <cmath>
#include <cstddef>
#include <vector>

#include "experiments/benchmarks/reference_kernel.h"
#include "models/strand/strand.h"

/// The strands that the reference kernel advances, so that every program measures with
/// the same stick: hairs of 10 elements that fall from rest.
namespace tress::experiments::benchmarks {

constexpr int reference_elements = 10;
constexpr double reference_length = 0.2, reference_step = 1e-3;  // m, s

/// Curls that differ a little from strand to strand.
inline double curl(std::size_t k) {  // 1/m
  return 20 * (1 + 0.3 * std::sin(0.37 * static_cast<double>(k % 97)));
}

inline models::Strand reference_hair(std::size_t k) {
  models::Material material;
  material.youngs_modulus = 1e9;
  material.shear_modulus = models::Material::shear_modulus_of(1e9, 0.48);
  material.internal_friction = 1e-10;
  return make_strand(material, {},
                     {.elements = reference_elements, .length = reference_length},
                     models::uniform_shape({0, curl(k), 0}));
}

class ReferenceStrands {
 public:
  explicit ReferenceStrands(std::size_t strands);
  void step();
  /// Returns the curvature, 1/m.
  double curvature(std::size_t strand, std::size_t element) const {
    return state_[strand / reference::lanes * reference_elements + element]
               .k.y[static_cast<int>(strand % reference::lanes)] /
           reference_length;
  }

 private:
  std::size_t blocks_;
  reference::Strand strand_{};
  std::vector<reference::State> state_;
  std::vector<reference::Record> scratch_;
};

/// Time of an element's step of the reference kernel, s.
double reference_time();

}  // namespace tress::experiments::benchmarks
