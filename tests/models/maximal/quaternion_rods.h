#pragma once

#include <gtest/gtest.h>

#include <random>

#include "contract/forms/compliance_form.h"
#include "math/frame.h"
#include "models/quaternion_rods/quaternion_rod.h"
#include "tests/support/variable.h"

namespace tress::testing_support {

using namespace models;

/// Forces and blocks of a rod of three such edges, numbers of order one, far from rest,
/// against its energy in derivative numbers.
template <class Edge>
void expect_forces_of_energy(const Edge& edge) {
  constexpr std::size_t edges = 3, size = 3 * (edges + 1) + 4 * edges;
  const QuaternionJoint joint(RodJoint{{0.3, -0.4, 0.2}, {1, 2, 3}, {}});
  std::mt19937 random(3);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (const bool walled : {false, true}) {
    QuaternionRod<Edge> rod(std::vector(edges, edge),
                            std::vector(walled ? edges : edges - 1, joint), walled);
    RootPose root;
    root.frame = rotation({0, 0.6, 0.8}, 0.7);
    std::vector<double> z(size), rate(size), force(size), by_blocks(size);
    for (double& x : z) x = uniform(random);
    rod.add_force({root, z, rate}, force);
    const Quaternion q0 = load_quaternion(&z[3 * (edges + 1)]);
    const Quaternion wall = nearer(q0, quaternion_of(root.frame));

    StrainForm& strains = *rod.strain_form();
    const auto blocks = strains.strain_blocks();
    double of_blocks = 0;
    for (std::size_t k = 0; k < blocks.size(); ++k) {
      ComplianceForm::Value value;
      std::vector<double> x;
      for (const int place : blocks[k].coordinates) {
        x.push_back(z[static_cast<std::size_t>(place)]);
      }
      strains.strain(k, root, x.data(), value);
      for (std::size_t row = 0; row < static_cast<std::size_t>(blocks[k].rows); ++row) {
        const double stress = value.c[row] / blocks[k].alpha[row];
        of_blocks += stress * value.c[row] / 2;
        for (std::size_t i = 0; i < x.size(); ++i) {
          by_blocks[static_cast<std::size_t>(blocks[k].coordinates[i])] +=
              stress * value.gradient[row][i];
        }
      }
    }

    for (std::size_t k = 0; k < size; ++k) {
      using T = Dual<1>;
      std::vector<T> y(z.begin(), z.end());
      y[k] = testing_support::variable<1>(z[k], 0);
      T energy(0), x[8];
      QuaternionOf<T> before{T(wall.w), Vec3<T>(wall.v)};
      for (std::size_t i = 0; i < edges; ++i) {
        const auto q = load_quaternion(&y[3 * (edges + 1) + 4 * i]);
        store3(load3(&y[3 * i + 3]) - load3(&y[3 * i]), x);
        store_quaternion(q, x + 3);
        energy += strain_energy(edge, x);
        store_quaternion(before, x);
        store_quaternion(q, x + 4);
        if (i > 0 || walled) energy += strain_energy(joint, x);
        before = q;
      }
      // Sums of some ten terms of order ten.
      EXPECT_NEAR(force[k], energy.part[0], 1e-13) << k;
      EXPECT_NEAR(by_blocks[k], energy.part[0], 1e-13) << k;
      EXPECT_GT(std::abs(force[k]), 1e-3) << k;
      EXPECT_NEAR(rod.energy({root, z, rate}), energy.value, 1e-13);
      EXPECT_NEAR(of_blocks, energy.value, 1e-13);
    }
  }
}

}  // namespace tress::testing_support
