#pragma once

#include <algorithm>

#include "models/quaternion_rods/cosserat_edge.h"
#include "models/quaternion_rods/quaternion_rod.h"

namespace example {

using tress::load_quaternion;
using tress::QuaternionOf;
using tress::models::CosseratEdge;
using tress::models::QuaternionJoint;

#ifdef SPOILT
inline constexpr bool shear_turns = false;
#else
inline constexpr bool shear_turns = true;  // geometric stiffness of stretch and shear
#endif

/// Shearable rod of two-node elements with a position x and a material frame R, that of
/// the quaternion q/|q|, at every node [Simo & Vu-Quoc 1986, Comput. Methods Appl. Mech.
/// Eng. 58, 79]. Strains are constant in an element from x_i, q_i to x_j, q_j of length l
/// at rest, and taken in its middle (one-point quadrature, so that shear does not lock),
/// where the frame is that of q_i + q_j:
///
///     C_s = R^T (x_j - x_i)/l - e0                   stretch and shear
///     C_b = 2 vec(conj(q_i) q_j) - its rest          twist and bending
///     E = sum l C_s^T diag(EA, k GA, k GA) C_s/2 + C_b^T diag(GJ, EI1, EI2) C_b/(2 l)
///       + nu EI/(2 l) times (|q|^2 - 1)^2/2 at both ends
///
/// The clamp is the first node: its frame is that of the root. Order 2 in l. Friction
/// acts on the rate of C_b. O(n); stiffest are turns of nodes against shear, so that
/// explicit methods need steps below the time of a shear wave across the section.
struct Element {
  static constexpr int strains = 8, coordinates = 11;  // x = (x_j - x_i, q_i, q_j)
  CosseratEdge middle;
  QuaternionJoint turn;
  double stiffness[strains] = {}, friction[strains] = {};

  template <class T>
  void strain(const T* x, T* s) const {
    T at_middle[7], stretched[4];
    to_middle(x, at_middle);
    middle.strain(at_middle, stretched);
    std::copy_n(stretched, 3, s);
    turn.strain(x + 3, s + 3);
    for (int end = 0; end < 2; ++end) {
      const QuaternionOf<T> q = load_quaternion(x + 3 + 4 * end);
      s[6 + end] = dot(q, q) - T(1);
    }
  }

  void gradient(const double* x, double (&g)[strains][coordinates]) const {
    double at_middle[7], stretched[4][7], turned[3][8];
    to_middle(x, at_middle);
    middle.gradient(at_middle, stretched);
    turn.gradient(x + 3, turned);
    for (auto& row : g) std::ranges::fill(row, 0.0);
    for (int k = 0; k < 3; ++k) {
      std::copy_n(stretched[k], 7, g[k]);
      std::copy_n(stretched[k] + 3, 4, g[k] + 7);
      std::copy_n(turned[k], 8, g[3 + k] + 3);
    }
    for (int l = 0; l < 4; ++l) {
      g[6][3 + l] = 2 * x[3 + l];
      g[7][7 + l] = 2 * x[7 + l];
    }
  }

  void add_second(const double* x, const double* stress,
                  double (&h)[coordinates][coordinates]) const {
    double at_middle[7], of_middle[7][7] = {}, of_turn[8][8] = {};
    to_middle(x, at_middle);
    const double stretching[4] = {stress[0], stress[1], stress[2], 0};
    if (shear_turns) middle.add_second(at_middle, stretching, of_middle);
    turn.add_second(x + 3, stress + 3, of_turn);
    const auto in_middle = [](int i) { return i < 7 ? i : i - 4; };
    for (int i = 0; i < coordinates; ++i) {
      for (int j = 0; j < coordinates; ++j) {
        h[i][j] += of_middle[in_middle(i)][in_middle(j)];
        if (i >= 3 && j >= 3) h[i][j] += of_turn[i - 3][j - 3];
      }
      if (i >= 3) h[i][i] += 2 * stress[i < 7 ? 6 : 7];
    }
  }

 private:
  template <class T>
  static void to_middle(const T* x, T* y) {
    std::copy_n(x, 3, y);
    for (int l = 0; l < 4; ++l) y[3 + l] = x[3 + l] + x[7 + l];
  }
};

}  // namespace example
