#include "integrators/esdirk43.h"

#include <numbers>

#include "integrators/entry.h"

namespace tress::integrators {
namespace {

constexpr double r2 = std::numbers::sqrt2;
constexpr double g = 1. / 4;

// The first two weights of every stage and of the embedded method agree, which gives its
// stages order 2.
constexpr double a3 = (1 - r2) / 8;
constexpr double a4 = (5 - 7 * r2) / 64;
constexpr double a5 = -(13796 + 54539 * r2) / 125000;
constexpr double b1 = (1181 - 987 * r2) / 13782;
constexpr double e1 = -480923228411. / 4982971448372;

// Measured on scenes/accuracy with super_helix at thresholds from 1e-2 to 1e-4: the error
// of a run is in proportion to the threshold, as in the limit, and was 0.08 to 3.2 of it.
constexpr EsdirkTable table{
    .stages = 6,
    .order = 4,
    .embedded_order = 3,
    .a = {{{},
           {g, g},
           {a3, a3, g},
           {a4, a4, 7 * (1 + r2) / 32, g},
           {a5, a5, (506605 + 132109 * r2) / 437500, 166 * (-97 + 376 * r2) / 109375, g},
           {b1, b1, 47 * (-267 + 1783 * r2) / 273343, -16 * (-22922 + 3525 * r2) / 571953,
            -15625 * (97 + 376 * r2) / 90749876, g}}},
    .embedded = {e1, e1, 6709447293961. / 12833189095359, 3513175791894. / 6748737351361,
                 -498863281070. / 6042575550617, 2077005547802. / 8945017530137},
    .share = 0.3,
    .power = 1};

}  // namespace

const EsdirkTable& esdirk43_table() { return table; }

IntegratorEntry esdirk43_entry() {
  return {.id = "esdirk43",
          .summary = "L-stable, five solves with one matrix",
          .source = "Kennedy-Carpenter 2016",
          .error_controlled = true,
          .tangent = true,
          .stages = 5,
          .contact = Contact::exact,
          // Index 3 differentiates twice what the stages, of order 2, leave in g.
          .formulations = {{Formulation::parametric, table.order},
                           {Formulation::acceleration, table.order},
                           {Formulation::baumgarte, table.order},
                           {Formulation::projection, table.order},
                           {Formulation::index3, 2}},
          .make = [](System& system, const Options& options) {
            return make_esdirk(table, system, options);
          }};
}

}  // namespace tress::integrators
