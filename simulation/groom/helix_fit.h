#pragma once

#include <span>
#include <vector>

#include "math/frame.h"
#include "simulation/groom/space_curve.h"

namespace tress::simulation {

/// Angle by which the tangent of a curve turns in all, rad, up to each of its arcs().
std::vector<double> turning(const SpaceCurve& curve);

/// Returns the number of helices for which a curve of this turning (rad) is within
/// `tolerance` of its length everywhere: max(2, 1 + ceil(turning sqrt(0.02/tolerance))).
/// The distance falls as the square of the angle of an element. One element is added
/// because the distance is largest at the two ends, where the chain is free.
int elements_by_turning(double turning, double tolerance);

/// Returns the ends of n elements, n + 1 arc lengths from 0. Each has an equal share of
/// half the length plus half the turning. A bend thus gets more elements than a straight
/// part, and no element is longer than twice the mean.
std::vector<double> cut_by_turning(const SpaceCurve& curve,
                                   std::span<const double> turning, int n);
/// Returns the ends of n equal elements.
std::vector<double> cut_equally(double length, int n);

/// A chain of helices, each of constant Darboux vector, that starts at the curve's root.
struct HelixChain {
  Vec place;                  // of the root, m
  Frame root;                 // there
  std::vector<double> joint;  // n + 1 arc lengths from 0, m
  std::vector<Vec> darboux;   // twist and curvatures in the frame, 1/m
};

/// Weights that let a fit trade distance for strains that vary little: of squares of
/// angles (rad^-2), relative to squares of distances over the length.
struct FitWeights {
  double jump = 2e-6, twist = 1e-6;  // weights of jumps between elements, and of twist
};

/// Fits the chain next to a curve, with joints at these arc lengths. It minimises
///
///     1/L^3 int |x(s) - c(s)|^2 ds + w1 sum |l (k_{i+1} - k_i)|^2 + w2 sum |l_i tau_i|^2
///
/// over all Darboux vectors and the frame at the root [Levenberg 1944; Marquardt 1963].
/// Here l is the mean of two lengths and tau the twist. The integral uses 3 Gauss points
/// per element. The start is the curvature of the twistless frame, averaged over each
/// element. That alone is ten times as far away, since errors of angle add up along the
/// strand. The two small weights determine what the curve leaves open: the twist of a
/// straight part, and strains that oscillate from element to element. O(n^3) for each of
/// a dozen steps at most.
HelixChain fit_helices(const SpaceCurve& curve, std::span<const double> joints,
                       const FitWeights& weights = {});

/// Returns this sum for a chain.
double misfit(const SpaceCurve& curve, const HelixChain& chain);

/// Places on a chain at ascending arc lengths from 0 to its length.
std::vector<Vec> places_on(const HelixChain& chain, std::span<const double> arcs);

/// Root mean square, over the length, and largest distance (m) of the points of a curve
/// from a chain. Points are compared at the same arc length, with the chain or with the
/// straight edges between its joints.
struct FitError {
  double rms = 0, largest = 0;  // root mean square over the length, largest; m
};
/// Lines between joints that a fit is compared with: `helices` or straight `edges`.
enum class Between { helices, edges };
/// Computes the distance of a chain from a curve.
FitError distance(const SpaceCurve& curve, const HelixChain& chain, Between between);

}  // namespace tress::simulation
