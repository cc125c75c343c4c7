#include "integrators/sundials/cvode_adams.h"

#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include "integrators/entry.h"

namespace tress::integrators {
namespace {

constexpr std::string_view adams_id = "cvode_adams";
constexpr int adams_highest_order = 12;
constexpr int anderson_vectors = 0;  // plain fixed-point iteration

}  // namespace

CvodeAdams::CvodeAdams(System& system, const Options& options)
    : Cvode(adams_id, system, options, ode_formulations, CV_ADAMS,
            chosen_order(adams_id, options, adams_highest_order, 1, adams_highest_order)),
      fixed_point_(require(
          SUNNonlinSol_FixedPoint(y_.handle(), anderson_vectors, context_.handle()),
          "SUNNonlinSol_FixedPoint")) {
  require(CVodeSetNonlinearSolver(memory_.get(), fixed_point_.get()),
          "CVodeSetNonlinearSolver");
}

IntegratorEntry cvode_adams_entry() {
  return {.id = "cvode_adams",
          .summary = "orders 1-12 Adams-Moulton",
          .source = "SUNDIALS CVODE",
          .adaptive = true,
          .formulations = of_order(12, ode_formulations),
          .gaps = {{Formulation::projection,
                    "a projected state would not match the method's history"}},
          .objection = inverts_mass,
          .make = make_method<CvodeAdams>};
}

}  // namespace tress::integrators
