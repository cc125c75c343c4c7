#pragma once

#include <string>
#include <vector>

#include "experiments/run/verdicts.h"
#include "simulation/files/row.h"
#include "simulation/groom/space_curve.h"
#include "simulation/scene/scene.h"

/// The gain that remeshing a moving strand could give.
namespace tress::experiments::adaptive_mesh {

using simulation::SpaceCurve;

/// A density of elements over a strand, in `cells` equal parts.
inline constexpr int cells = 48;
using Density = std::vector<double>;

/// Shapes of the strand of a scene of many elements, at even times.
struct Shapes {
  std::vector<SpaceCurve> at;
  std::vector<Density> density;  // |kappa'|^(2/3) of each
};

/// Computes the shapes of the scene with `fine` elements. For super_helix kappa' comes
/// from the jumps of its coordinates. For other models it comes from those of the `cells`
/// helices next to the shape, which does not determine the twist. Throws
/// std::runtime_error where the scene does not run to its end.
Shapes shapes_of(const simulation::Scene& scene, int fine, int instants);

/// The density of mesh = "rest"; where the scene cannot have them, that at t = 0.
Density density_at_rest(const simulation::Scene& scene, const Shapes& shapes);
/// Angle by which the tangent turns along the strand, the largest of all shapes (rad).
double turning_of(const Shapes& shapes);

/// Largest gain of remeshing, for many elements. With a density d of unit integral, n
/// elements are off by
///
///     e^2 = 1/(12 n^2) int |kappa'|^2/d^2 ds,
///
/// least for d ~ rho = |kappa'|^(2/3), with e^2 ~ (int rho)^3/n^2. For one d for all
/// shapes, the mean of e^2 over the shapes is least for d ~ (mean rho^3)^(1/3).
struct Limit {
  double remeshed, following;  // as in Needed, the fixed number over these
};
Limit limit_of(const Shapes& shapes);

/// n elements that share a density equally, each of whose cells has `least_share` of the
/// mean or more: their ends, as shares of the length.
std::vector<double> cut_by(const Density& density, int n);

/// Ways to cut a strand that moves.
enum class Cuts {
  equal,
  start,    // as the shape at t = 0 asks, or the one at rest
  mean,     // the mean over the run of what all shapes ask
  largest,  // the largest over the run
  anew      // as each shape asks, or as one of the fixed if that is nearer
};
inline constexpr Cuts all_cuts[] = {Cuts::equal, Cuts::start, Cuts::mean, Cuts::largest,
                                    Cuts::anew};
std::string_view name(Cuts cuts);

/// Distances over the length of n helices, cut in one way, from each shape: root mean
/// square over the strand of the chain next to it.
struct Misfit {
  Cuts cuts;
  int elements;
  std::vector<double> at;
};
std::vector<Misfit> misfits(const Shapes& shapes, const Density& rest,
                            const std::vector<int>& elements);

double root_mean_square(const std::vector<double>& all);
double largest(const std::vector<double>& all);
/// One of these two, of the distances at all instants.
using OverInstants = double (*)(const std::vector<double>&);

/// Elements for which the distance over the instants is `target`, by the power law
/// between two numbers tried; NaN: more than the largest tried. Below the least tried:
/// that one.
struct Needed {
  double fixed;      // the best cut that holds during the run
  double remeshed;   // as many at every instant, cut anew
  double following;  // cut anew, so many that each instant meets the target: mean
  Cuts best;         // the fixed cut
};
Needed needed(const std::vector<Misfit>& all, double target, OverInstants over);

/// A hair of the family on which tolerance_m is tested at rest
/// (tests/simulation/test_cuts.cpp).
struct LooseHair {
  std::string name;
  double length, young;  // m, Pa
  std::string tangent, shape;
};
std::vector<LooseHair> loose_hairs();
/// Tolerance of the judged runs over the length.
inline constexpr double judged_tolerance = 5e-3;

/// Elements that mesh = "rest" makes for a tolerance, over the length, and the distance
/// of tips from those of a finer mesh. The distance is that in the half second after
/// release: rms over the frames, over the length. `largest`: of joints, at the worst
/// frame.
struct MotionError {
  int elements;
  double tip, largest;
};
MotionError motion_error(const LooseHair& hair, double tolerance);
/// Motion error with the elements that a pilot finds (simulation/errors/pilot.h), and the
/// error that the pilot estimates, over the length. Also the elements of all of its runs
/// over those of one run with the elements found.
struct PilotError {
  MotionError found;
  double estimate, work;
};
PilotError pilot_error(const LooseHair& hair, double tolerance);

/// Distances of the tips of a scene of `elements` from those with many quadrature points,
/// and from those of many elements: rms over its frames, over the length. Throws
/// std::runtime_error where a run does not end.
struct PointsError {
  double points, elements;
};
PointsError points_error(const simulation::Scene& scene, int elements);

/// The claims about a finished table.
void judge(const std::vector<simulation::Row>& rows, Verdicts& verdicts);

}  // namespace tress::experiments::adaptive_mesh
