#pragma once

#include <array>
#include <numbers>

#include "contract/forms/energetics.h"
#include "tests/models/reduced/static_equilibrium.h"

/// Strands at rest under gravity against solutions of Kirchhoff's equations of the
/// continuous rod, computed independently of this code as boundary-value problems on two
/// meshes that agree to 1e-12. Unit rod: L = 1 m, EI = 1 N m^2, so Gamma = rho g S L^3/EI
/// is the weight in N.
namespace tress::testing_support {

using namespace simulation;

inline constexpr double line_density = 0.1 * std::numbers::pi;  // kg/m

/// Clamped horizontally; horizontal and vertical way to the tip.
struct Master {
  double gamma, width, height;
};
inline constexpr std::array master_curve = {
    Master{1, 0.9912463953466362, 0.1234714019833512},
    Master{10, 0.6563537612385990, 0.7001997155143134},
    Master{100, 0.1592233826284426, 0.9375239353963470}};

/// Relative error of height over width, the ordinate of the gravito-bending curve.
inline double master_error(std::string_view model, const ModelSettings& rod,
                           const Master& exact, int elements, double accuracy = 1e-11,
                           double growth = 3) {
  const Hung hung = hang(model, with(rod, {{"elements", std::to_string(elements)}}),
                         exact.gamma / line_density, accuracy, growth);
  const std::vector<double> x = points(hung);
  const double width = x[x.size() - 3], height = -x[x.size() - 1];
  EXPECT_NEAR(x[x.size() - 2], 0, 1e-12);  // planar
  return std::abs(height / width / (exact.height / exact.width) - 1);
}

/// Hair of natural curvature 18.04/L and twist 3.588/L, clamped with its tangent down,
/// Gamma = 35.8678125, GJ/EI = 1/1.4; points at s = L/12, 2 L/12 ... L. The curvature is
/// about x, the second axis of a clamp that looks down.
inline constexpr double curly_gamma = 35.8678125;
inline constexpr double curly_energy = -2.3792742702619;  // elastic and of gravity, EI/L
inline constexpr double curly[12][3] = {
    {0.0001164057744664, 0.04785354002524, -0.0605616254811},
    {0.04467666043572, 0.1049811594293, -0.03832225086826},
    {0.09877092747442, 0.05877241612858, -0.01425821871004},
    {0.07733539439723, 0.001960299940598, -0.06016107924917},
    {0.03892641073454, 0.04258442222258, -0.1123738189972},
    {0.08200510324511, 0.1050872650009, -0.1129549117869},
    {0.1474238548443, 0.06839613426009, -0.1035165260631},
    {0.1237380398617, 0.004333781520926, -0.1366333685185},
    {0.07066163631011, 0.0363762520818, -0.1806566227126},
    {0.1046240809576, 0.1038754255772, -0.1870426642896},
    {0.1747727351719, 0.07689474386209, -0.1779950046448},
    {0.1575486055087, 0.00707793852891, -0.2017219830847}};

/// Farthest distance (L) of the points, and relative error of the energy.
struct CurlyError {
  double points, energy;
};
inline CurlyError curly_error(std::string_view model, const ModelSettings& rod,
                              std::size_t n, double accuracy = 1e-11, double growth = 3) {
  const Hung hung = hang(model,
                         with(rod, {{"elements", std::to_string(n)},
                                    {"root_tangent", "down"},
                                    {"natural_curvature2_per_m", "18.0361544841071"},
                                    {"natural_twist_per_m", "3.58817892564338"}}),
                         curly_gamma / line_density, accuracy, growth);
  const std::vector<double> x = points(hung);
  double farthest = 0;
  for (std::size_t i = 0; i < 12; ++i) {
    const double* p = &x[3 * (i + 1) * n / 12];
    farthest = std::max(
        farthest, std::hypot(p[0] - curly[i][0], p[1] - curly[i][1], p[2] - curly[i][2]));
  }
  const Energy at_rest =
      hung.system->energetics()->energy(0, hung.q, zeros(*hung.system));
  return {farthest, std::abs(at_rest.potential / curly_energy - 1)};
}

}  // namespace tress::testing_support
