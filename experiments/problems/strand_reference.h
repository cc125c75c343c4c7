#pragma once

#include <functional>
#include <memory>
#include <string_view>
#include <vector>

#include "contract/integrator.h"

namespace tress::experiments {

/// A strand of one scene by a model of the catalogue, with equal elements.
using MakeStrand =
    std::function<std::unique_ptr<System>(std::string_view model, int elements)>;

/// Tip motion from two independent computations, (3 samples) each as run_tip samples it,
/// and their distance (tip_error).
struct TipReference {
  std::vector<double> tip, other;
  double gap = 0;
};

/// The times at which tips are compared, and the length that scales errors.
struct TipSampling {
  double t_end;   // s
  int samples;    // t_end k / samples, k = 1 .. samples
  double length;  // of the strand, m
};

/// The equations of one model at N elements, integrated to convergence by an explicit
/// Runge-Kutta method of order 8, and by an Adams method. Both resolve the fastest
/// bending mode, so cost grows as N^3: about 3 s for 2 s of 20 elements of a hair. Throws
/// std::runtime_error when one of them fails.
TipReference converged_model(const MakeStrand& make, std::string_view model, int elements,
                             const TipSampling& sampling);

/// Models whose approximations of the continuous rod are independent.
struct RodModels {
  std::string_view one, other;
};
inline constexpr RodModels clamped_rod{"super_helix", "articulated_chain"};
inline constexpr RodModels free_rod{"super_helix", "der"};

/// The finest run of a reference.
struct Finest {
  int elements = 160;
  double step = 2.5e-4;  // s: an error of 2e-5 of the length before extrapolation
};

/// Tips of one run at all compared instants; throws std::runtime_error if the run fails.
using TipsOf =
    std::function<std::vector<double>(std::string_view model, std::string_view integrator,
                                      int elements, const Options& options)>;

/// Computes the tips of the continuous rod. One side is one model with the finest mesh
/// and half the elements, with implicit_midpoint, each at the finest step and twice that.
/// It is extrapolated to zero step (order 2) and then to zero element length (order 2;
/// remainders of higher order are already small). The other side is the same for the
/// other model with generalized_alpha.
TipReference converged_rod(const TipsOf& tips, double length, const RodModels& models,
                           const Finest& finest = {});

/// The equations of one model at the elements of `finest`, extrapolated in the step alone
/// by both methods: for scenes on which explicit methods are too slow.
TipReference extrapolated_model(const TipsOf& tips, double length, std::string_view model,
                                const Finest& finest);

/// Returns the extrapolated tips of a strand of the catalogue.
TipReference extrapolated_model(const MakeStrand& make, std::string_view model,
                                int elements, const TipSampling& sampling, double step);

/// The rod limit of a strand of the catalogue. About 10 s for 2 s of a hair.
TipReference converged_rod(const MakeStrand& make, const TipSampling& sampling,
                           const RodModels& models = clamped_rod);

/// x + (x - coarse) / (ratio^2 - 1): the limit of two answers of order 2 when the second
/// has steps or elements `ratio` times as fine [Richardson 1911].
std::vector<double> extrapolated(In coarse, In fine, double ratio);

}  // namespace tress::experiments
