#include "integrators/tr_bdf2.h"

#include "integrators/entry.h"

namespace tress::integrators {
IntegratorEntry tr_bdf2_entry() {
  return {.id = "tr_bdf2",
          .summary = "L-stable, two solves with one matrix",
          .source = "Bank 1985; Hosea-Shampine 1996",
          .error_controlled = true,
          .tangent = true,
          .stages = 2,
          .contact = Contact::exact,
          .formulations = of_order(tr_bdf2_table().order, stage_formulations),
          .make = [](System& system, const Options& options) {
            return make_esdirk(tr_bdf2_table(), system, options);
          }};
}

}  // namespace tress::integrators
