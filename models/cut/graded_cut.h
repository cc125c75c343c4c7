#pragma once

#include <vector>

#include "models/strand/strand.h"

namespace tress::models {

/// A clamped rod of one section under a uniform load, as its own weight.
struct LoadedRod {
  Material material;     // material of the rod
  CrossSection section;  // section of the rod
  double length = 0;     // m
  Shape natural;         // 1/m
  Frame clamp;           // at the root
  Vec load;              // N/m
};

/// Lengths of elements of constant curvature, and the largest distance of their shape at
/// rest from that of the rod, as estimated.
struct GradedCut {
  std::vector<double> lengths;  // m, from the root
  double error = 0;             // m
};

/// Returns `elements` elements that share |kappa'|^(2/3) equally, with kappa(s) the
/// Darboux vector at rest. The error of kappa, sum h^3 |kappa'|^2/12, is near its minimum
/// for this number of elements [De Boor 1973]. The balance of moments gives kappa'
/// without differences. With N the load beyond s, R the frame, K = diag(GJ, EI1, EI2) and
/// kappa_n the natural curvatures,
///
///     kappa' = kappa_n' + K^-1 (-kappa x K (kappa - kappa_n) + (R^T N) x e0),
///
/// on elements that are at rest themselves, in 4 passes that start from equal elements.
/// No element gets less than .3 of the mean of |kappa'|^(2/3), so none is longer than 3.4
/// mean ones. With .15, passes oscillate about a worse mesh where elements are few.
///
/// An element's own shape is off by kappa' h^3/12 at its end, where the tangent is right.
/// The error is the largest sum of these vectors up to any place. O(elements) per
/// iteration for the equilibrium. Throws std::runtime_error if there is no equilibrium.
GradedCut graded_cut(const LoadedRod& rod, int elements);

/// Lengths of elements of linear curvature: they share |kappa''|^(2/5) of the shape at
/// rest, by the same reasoning, kappa'' from the balance once more differentiated,
///
///     kappa'' = kappa_n'' + K^-1 (-kappa' x K (kappa - kappa_n) - kappa x K (kappa' -
///               kappa_n') - (kappa x (R^T N) + R^T load) x e0),
///
/// on the graded helices of a finer cut. No element gets less than .15 of the mean
/// share. Throws as graded_cut().
std::vector<double> linear_cut(const LoadedRod& rod, int elements);

/// make_strand() with elements of these lengths; clamped as the rod.
Strand cut_into(const LoadedRod& rod, const std::vector<double>& lengths,
                const Shape& initial = {});

/// Strain of an element along its length: `constant` as in super_helix, or `linear` as in
/// super_clothoid.
enum class ElementStrain { constant, linear };

/// Coordinates of the model at rest under the load: a stable equilibrium, reached from
/// the initial shape with falling energy. Throws std::runtime_error if none is found.
std::vector<double> coordinates_at_rest(const Strand& strand, const Vec& load,
                                        ElementStrain strain = ElementStrain::constant);

}  // namespace tress::models
