#pragma once

#include <Eigen/LU>

#include "models/effects/gravity.h"
#include "models/effects/linear_drag.h"
#include "models/reduced/super_helix.h"
#include "tests/models/reduced/strand_cases.h"
#include "tests/support/apart.h"

/// What the tests of batches share: strands that differ, and how far results may.
namespace tress::testing_support {

using namespace simulation;

inline constexpr int segments = 6;
inline constexpr double h = 3e-4;  // s
inline constexpr Weights backward_euler{1, h, h* h};

/// A force that reads all that points have, and differs from point to point:
/// f = m (-a (1 + i) x - b v + c tangent), i the index of the point.
class Tether final : public Effect {
 public:
  std::string_view name() const override { return "tether"; }
  Needs needs() const override {
    return {.position = true, .velocity = true, .tangent = true, .derivatives = true};
  }
  void add_load(double, const Points& p, InOut f) const noexcept override {
    for (std::size_t i = 0; i < p.mass.size(); ++i) {
      const Vec load = pull(i) * load3(&p.x[3 * i]) - drag * load3(&p.v[3 * i]) +
                       along * load3(&p.tangent[3 * i]);
      store3(load3(&f[3 * i]) + p.mass[i] * load, &f[3 * i]);
    }
  }
  void add_derivatives(double, const Points& p, double pos, double vel,
                       InOut blocks) const noexcept override {
    for (std::size_t i = 0; i < p.mass.size(); ++i) {
      for (std::size_t k = 0; k < 9; k += 4) {
        blocks[9 * i + k] += p.mass[i] * (pos * pull(i) - vel * drag);
      }
    }
  }
  double potential(double, const Points&) const noexcept override { return 0; }
  double power(double, const Points&) const noexcept override { return 0; }

 private:
  static double pull(std::size_t i) { return -20.0 * static_cast<double>(1 + i); }
  static constexpr double drag = 3, along = 5;  // 1/s, m/s^2
};

/// Four strands that have nothing in common but the number of segments.
inline Strand strand(int lane, int dofs) {
  const double k = lane + 1;
  Material material;
  material.density = 1000 + 100 * k;
  material.youngs_modulus = 1e9 * k;
  material.internal_friction = 1e-12 * (5 - k);
  // In the plane of e0 and e2 where there is one bending plane only.
  const Vec natural = dofs == 1 ? Vec{0, 3 * k, 0} : Vec{4 - k, 3 * k, -2 * k};
  const Vec initial = dofs == 1 ? Vec{0, 5 - k, 0} : Vec{k, 5 - k, 2.0};
  Strand made = make_strand(material, {4e-5 + 1e-5 * k, 6e-5},
                            {.elements = segments, .length = 0.05 * k, .grading = k},
                            uniform_shape(natural), uniform_shape(initial));
  made.root.position = {0.1 * k, -0.2, 0.3};
  made.root.frame = rotation({0, 0, 1}, 0.3 * k);
  if (lane > 0) made.root.translations = {{{0, 1, 0.5}, sine(0.01 * k, 3)}};
  if (lane > 1) made.root.rotations = {{{0, 0.6, 0.8}, one_minus_cosine(0.4, 2)}};
  return made;
}

/// What gravity of effects() pulls it by at most, N.
inline double weight(int lane) {
  const Strand made = strand(lane, 3);
  double mass = 0;
  for (const Segment& segment : made.segments) {
    mass += made.material.density * segment.section.area() * segment.length;
  }
  return mass * 10;
}

inline Effects effects(int lane) {
  const auto gravity = std::make_shared<Gravity>(Vec{0, 1, -9.81});
  const auto drag = std::make_shared<LinearDrag>(2e-5, 0.5);
  switch (lane) {
    case 0:
      return {gravity, drag};
    case 1:
      return {};
    case 2:
      return {std::make_shared<Tether>()};
    default:
      return {std::make_shared<Gravity>(Vec{2, 0, -5}), drag, std::make_shared<Tether>()};
  }
}

// A number takes part in at most some hundred operations per segment, whose rounding
// errors of eps each add up: those of results are within this of the largest term.
inline constexpr double rounding = 100 * segments * eps;

/// The inverse of S(w), column by column.
inline Eigen::MatrixXd inverse(System& strand, std::size_t n) {
  Eigen::MatrixXd columns(n, n);
  for (Eigen::Index k = 0; k < columns.cols(); ++k) {
    std::vector<double> unit(n);
    unit[static_cast<std::size_t>(k)] = 1;
    EXPECT_EQ(strand.solve(unit, unit), Status::ok);
    columns.col(k) = Eigen::Map<const Eigen::VectorXd>(unit.data(), columns.rows());
  }
  return columns;
}

inline double condition(const Eigen::MatrixXd& inverse) {
  return inverse.lpNorm<Eigen::Infinity>() * inverse.inverse().lpNorm<Eigen::Infinity>();
}

}  // namespace tress::testing_support
