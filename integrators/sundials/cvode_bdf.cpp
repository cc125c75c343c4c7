#include "integrators/sundials/cvode_bdf.h"

#include "integrators/entry.h"

namespace tress::integrators {
namespace {

constexpr std::string_view bdf_id = "cvode_bdf";
constexpr int bdf_standard_order = 2;
constexpr int bdf_highest_order = 5;

int project(sunrealtype t, N_Vector y, N_Vector correction, sunrealtype, N_Vector error,
            void* self) noexcept {
  return sundials_code(static_cast<FirstOrder*>(self)->project(
      t, entries(y), entries(correction), error == nullptr ? InOut{} : entries(error)));
}

}  // namespace

CvodeBdf::CvodeBdf(System& system, const Options& options)
    : Cvode(bdf_id, system, options, projected_formulations, CV_BDF,
            chosen_order(bdf_id, options, bdf_standard_order, 1, bdf_highest_order)),
      implicit_(context_, equations_) {
  implicit_.attach(memory_);
  if (options.formulation == Formulation::projection) {
    require(CVodeSetProjFn(memory_.get(), &project), "CVodeSetProjFn");
  }
}

IntegratorEntry cvode_bdf_entry() {
  return {.id = "cvode_bdf",
          .summary = "BDF, order 2 by default, 1-5 on request",
          .source = "SUNDIALS CVODE",
          .adaptive = true,
          .tangent = true,
          .formulations = of_order(2, projected_formulations),
          .objection = inverts_mass,
          .make = make_method<CvodeBdf>};
}

}  // namespace tress::integrators
