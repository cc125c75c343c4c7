// Is the physics right? Every strand model against published tests of slender rods, and
// every integrator on a free hair without forces.
#include "experiments/run/experiment.h"
#include "experiments/validation/free_flight.h"
#include "experiments/validation/table.h"

namespace tress::experiments::validation {
namespace {

std::vector<Case> cases(const CommandLine& line) {
  return validation_cases(line, Settings(line, validation_settings()));
}

/// Returns whether a failed row is a valid result. These are a model that refuses a test
/// or finds no answer within the time limit, and a step too long for a flying hair.
/// Required results are among the checks, and a claim with a killed row is broken.
bool finding(const Row& row) {
  return row.text("test") == free_flight || row.status() == "refused" ||
         row.status() == "failed" || row.status() == "timeout";
}

constexpr Unused unused[] = {not_repeated, not_random};

}  // namespace
}  // namespace tress::experiments::validation

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::validation;
  const Experiment experiment{
      .name = "validation",
      .question = "is the physics right: what do published tests of rods say?",
      .example = "--models der,super_helix --set tests=cantilever",
      .sizes = {"1661 rows, 4.5 min", "11258 rows, hours"},
      .timed = false,
      .columns = validation_columns(),
      .settings = validation_settings(),
      .unused = unused,
      .cases = cases,
      .derive = fit_validation_orders,
      .checks = check_validation,
      .glossary = validation_glossary,
      .finding = finding};
  return run_experiment(experiment, argc, argv);
}
