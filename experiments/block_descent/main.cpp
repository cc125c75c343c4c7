// How many sweeps of block descent make a step, for blocks of one node to the whole
// strand?
#include "experiments/block_descent/block_descent.h"

namespace tress::experiments::block_descent {
namespace {

constexpr Column columns[] = {
    {"part",
     "sweeps (error against sweeps and blocks), order (1 compared with 2), "
     "penalty (range of penalties) or rods (map of stable_cosserat_rods)"},
    {"scene", "swing, or the cantilever of the published example"},
    {"model", "catalogue id"},
    {"integrator", "method"},
    {"elements", "number of elements"},
    {"stretch_over_bending", "EA L^2/(E I), EA as softened"},
    {"dt_s", "fixed step"},
    {"sweeps", "sweeps per step"},
    {"block", "nodes solved together, 0: all"},
    {"chebyshev", "rate for which sweeps are accelerated"},
    {"anderson", "number of earlier sweeps that Anderson acceleration combines"},
    {"penalty_per_s2", "largest stiffness of a row, times its G W G^T"},
    {"primal_sweeps", "sweeps before multipliers are improved"},
    {"direct_distance_rel",
     "rms distance of the tip from backward_euler's with the same step, over the length"},
    {"direct_error_rel", "error_rel of backward_euler with the same step"},
    {"error_rel",
     "rms distance of the tip from the continuous rod's, of the cantilever from the same "
     "edges' without error of time, over the length"},
    {"reference_gap_rel", "distance of two references"},
    {"within_1_percent", "error_rel is at most 0.01"},
    {"energy_distance_rel",
     "largest difference of mechanical energy from backward_euler's, over m g L"},
    {"steps", "steps of the run"},
    {"wall_s_per_sim_s", "wall time of a simulated second", true},
};

std::vector<Case> cases(const CommandLine& line) {
  std::vector<Trial> trials = descent_trials(line);
  const std::vector<Trial> of_rods = rod_trials(line);
  trials.insert(trials.end(), of_rods.begin(), of_rods.end());
  return cases_of(trials, line);
}

constexpr Unused unused[] = {{"elements", "twenty, or the published example's"},
                             not_random};

/// A method that diverges is a result.
bool finding(const Row& /*row*/) { return true; }

}  // namespace
}  // namespace tress::experiments::block_descent

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::block_descent;
  const Experiment experiment{
      .name = "block_descent",
      .question =
          "how many sweeps of block descent make a step, for blocks of one node to "
          "the whole strand?",
      .example = "--models mass_spring --integrators vbd,vbd_augmented --quick",
      .sizes = {"124 rows, 1.5 min", "295 rows"},
      .columns = columns,
      .unused = unused,
      .cases = cases,
      .checks = judge,
      .finding = finding};
  return run_experiment(experiment, argc, argv);
}
