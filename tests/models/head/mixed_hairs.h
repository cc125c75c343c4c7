#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "contract/constants.h"
#include "models/effects/body.h"
#include "simulation/head/make_head.h"

namespace tress::testing_support {

/// Makes a head of one of the models that have tr_bdf2.
struct HeadMaker {
  const char *name, *model;
  std::unique_ptr<models::Head> (*make)(const simulation::HeadOptions&,
                                        const models::HeadPack&);
  bool stretches, narrow;  // elements; whether numbers may have 32 bits
};
inline void PrintTo(const HeadMaker& m, std::ostream* out) { *out << m.name; }  // NOLINT
inline constexpr HeadMaker helix_hairs{"Helices", "super_helix", simulation::helix_head,
                                       false, true},
    clothoid_hairs{"Clothoids", "super_clothoid", simulation::clothoid_head, false, true},
    linked_hairs{"Chains", "articulated_chain", simulation::chain_head, false, true},
    rods{"Rods", "der", simulation::der_head, true, true},
    spring_masses{"Springs", "mass_spring", simulation::spring_head, true, false},
    quaternion_rods{"Quaternions", "corde", simulation::corde_head, true, true};
inline constexpr HeadMaker controlled_heads[] = {
    helix_hairs, clothoid_hairs, linked_hairs, rods, spring_masses, quaternion_rods};

/// Straight, wavy and curled hairs, of each a soft one, one that is 8 times as stiff to
/// bend, and two between them.
inline constexpr std::size_t mixed = 12;
inline constexpr int mixed_elements = 5;
inline models::Strand mixed_hair(std::size_t k) {
  const auto kind = static_cast<double>(k % 3), size = static_cast<double>(k / 3 % 4);
  models::Material material;
  material.density = 1300;
  material.youngs_modulus = 1e9 * (1 + size);
  material.shear_modulus =
      models::Material::shear_modulus_of(material.youngs_modulus, 0.4);
  material.internal_friction = 2e-10;
  const double radius = 3e-5 * (1 + size / 4), curl = 2 + 13 * kind;
  models::Strand made = models::make_strand(
      material, {1.2 * radius, radius},
      {.elements = mixed_elements, .length = 0.15 + 0.02 * size, .grading = 1},
      models::uniform_shape({kind, curl, 0.2 * curl}));
  made.root.position = {0.02 * kind, 0.08, 0.01 * size};
  made.root.frame = rotation({0, 0.6, -0.8}, 0.3 * static_cast<double>(k));
  return made;
}

/// A soft, straight one; and a short, stiff, curled one, let go in another shape than
/// that at rest.
inline models::Strand calm_hair() { return mixed_hair(0); }
inline models::Strand lively_hair() {
  models::Material material;
  material.density = 1300;
  material.youngs_modulus = 4e9;
  material.shear_modulus = models::Material::shear_modulus_of(4e9, 0.4);
  material.internal_friction = 1e-10;
  models::Strand made = models::make_strand(
      material, {7e-5, 6e-5}, {.elements = mixed_elements, .length = 0.06, .grading = 1},
      models::uniform_shape({0, 40, 8}), models::uniform_shape({0, 36, 8}));
  made.root.position = {0, 0.08, 0};
  return made;
}

/// By equal steps, if the tolerance is 0.
inline simulation::HeadOptions mixed_options(double tolerance) {
  simulation::HeadOptions o{{.elements = mixed_elements,
                             .points = 4,
                             .drag = 2e-5,
                             .mass_damping = 0.5,
                             .longest = 0.25,
                             .line_density = 5e-6,
                             .motion = {},
                             .effects = {}}};
  o.method = integrators::HeadMethod::tr_bdf2;
  o.newton_tolerance = 1e-13;
  o.tolerance = tolerance;
  o.motion.rotations = {{{0, 0.6, 0.8}, models::one_minus_cosine(0.4, 2)}};
  return o;
}

/// On which some of the hairs lie.
inline models::Effects mixed_body() {
  return {std::make_shared<models::Body>(
      models::Ellipsoid({0.1, 0.1, 0.1}), models::StrandPlace{{0, 0.08, -0.12}, {}},
      models::BodyContact{
          .stiffness = 1, .damping = 0.1, .friction = 0.2, .offset = 4e-5})};
}

inline constexpr models::HeadPack wide{models::HeadNumber::float64, 4};
inline constexpr double interval = 0.04;  // s
inline constexpr int intervals = 8;

/// Intervals first to last - 1, each in so many equal calls for so many blocks.
inline models::HeadWork advance(models::Head& head, int first, int last, int parts = 1,
                                std::size_t together = 1000) {
  const auto scratch = head.scratch();
  const double h = interval / parts;
  for (int i = first * parts; i < last * parts; ++i) {
    for (std::size_t b = 0; b < head.blocks(); b += together) {
      head.step(b, std::min(head.blocks(), b + together), i * h, h, *scratch);
    }
  }
  return scratch->work;
}

/// What is kept of each strand, in their order.
inline std::vector<std::vector<double>> kept_of(const models::Head& head) {
  std::vector<std::vector<double>> all;
  for (std::size_t b = 0; b < head.blocks(); ++b) {
    std::vector<double> block(head.strands_of(b) * head.kept());
    head.keep(b, block);
    for (std::size_t k = 0; k < head.strands_of(b); ++k) {
      const auto from = block.begin() + static_cast<std::ptrdiff_t>(k * head.kept());
      all.emplace_back(from, from + static_cast<std::ptrdiff_t>(head.kept()));
    }
  }
  return all;
}
inline void recall(models::Head& head, const std::vector<std::vector<double>>& all) {
  for (std::size_t b = 0, k = 0; b < head.blocks(); ++b) {
    std::vector<double> block;
    for (std::size_t i = 0; i < head.strands_of(b); ++i, ++k) {
      block.insert(block.end(), all[k].begin(), all[k].end());
    }
    head.recall(b, block);
  }
}

/// Points and their velocities of one strand after another.
struct Motion {
  std::vector<double> x, u;
};
inline Motion motion_of(const models::Head& head, double t) {
  Motion all;
  for (std::size_t b = 0; b < head.blocks(); ++b) {
    std::vector<double> x(head.strands_of(b) * head.numbers()), u(x.size());
    head.motion(b, t, x, u);
    all.x.insert(all.x.end(), x.begin(), x.end());
    all.u.insert(all.u.end(), u.begin(), u.end());
  }
  return all;
}
/// How far strand k, of length L, is from what it is in `want`, in the norm of the
/// tolerance: |dx|/L and |du| sqrt(L/g)/L.
inline double off(const Motion& from, const Motion& want, std::size_t k, double length) {
  const std::size_t each = 3 * (mixed_elements + 1);
  const double time = std::sqrt(length / earth_gravity);
  double most = 0;
  for (std::size_t i = k * each; i < (k + 1) * each; i += 3) {
    most = std::max({most, norm(load3(&from.x[i]) - load3(&want.x[i])) / length,
                     norm(load3(&from.u[i]) - load3(&want.u[i])) * time / length});
  }
  return most;
}

}  // namespace tress::testing_support
