#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "simulation/scene/scene.h"

namespace tress::simulation {

/// Distance of two runs above which they are no longer one motion and its error, over the
/// length: from there the estimate would be of no meaning.
constexpr double parted_from = 0.1;

/// Largest and root mean square error of material points, over the length of their
/// strand.
struct PointErrors {
  double largest = 0, rms = 0;  // errors over the length
};

/// Errors of one strand over the frames before its two runs part.
struct StrandError {
  PointErrors error;            // errors over all those frames
  double largest_at = 0;        // s
  std::optional<double> parts;  // s, the first frame at which they are apart
};

/// Estimated error of a run in time or in space [Richardson 1911]: its distance from a
/// finer run, divided by the part of the error that the finer run lacks.
struct ErrorBar {
  std::vector<StrandError> strands;  // errors of each strand
  /// Errors at every frame over all strands that have not parted, until all have.
  std::vector<PointErrors> frames;
  /// Error of every material point at every frame of the scene, over the length of its
  /// strand; `parted_from` for strands that have parted. Empty: there is no estimate.
  std::vector<std::vector<float>> points;
  std::string missing;      // why there is no estimate; empty: there is
  bool unfinished = false;  // for a run did not come to its end

  /// The strand with the largest error; the first of those that part earliest, if any do.
  std::size_t worst() const;
  /// Median over strands of their largest errors.
  double median() const;
  std::size_t parted() const;  // strands
};

/// Bounds of the largest error, as multiples of its estimate, that held in at least 90 %
/// of the calibration runs. The runs are of six clamped hairs (13 to 25 cm; straight,
/// wavy, curled; released, shaken, turned; with and without drag). Three models
/// (super_helix, articulated_chain, der) were run, in time with five methods each. Half
/// of the runs exceed a bare estimate. tests/control/test_error_bound.cpp measures the
/// shares.
constexpr double time_bound = 1.5;
constexpr double space_bound = 1.5;  // factor for estimates in space
/// The population in words, for where a bound is printed.
constexpr std::string_view time_population = "90 runs of 6 clamped hairs";
constexpr std::string_view space_population = "14 runs of 6 clamped hairs";  // in words

/// Estimates the error against a run that halves every step, or with a tenth of the
/// tolerance (of rtol and atol), whose own error is neglected. The scene's method is
/// assumed to have its declared order. Where contact or friction lower the order to 1, a
/// method of order 2 has an error up to 3/2 of the estimate.
ErrorBar time_error(const Scene& scene, int threads);

/// Distance of two runs of one scene with two meshes, at equal arc length, times
/// `factor`.
ErrorBar distance(const Scene& scene, const Scene& finer, double factor, int threads);

/// Against a run with twice the elements, at equal arc length, by the model's order in
/// their length. Missing for bodies whose elements no table sets.
ErrorBar space_error(const Scene& scene, int threads);

/// Throws InputError if the scene's method ends its steps after a number of sweeps. A
/// shorter step does not show the error that unfinished sweeps leave in the equations.
void check_error_bars(const Scene& scene);

/// Throws InputError if the scene has no tolerance to compare the error with.
void check_verifiable(const Scene& scene);

}  // namespace tress::simulation
