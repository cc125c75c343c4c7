#include "experiments/harness/transport_claims.h"

#include <algorithm>
#include <cmath>

namespace tress {
namespace {

using namespace transport;

double apart(const Row& a, const Row& b) {
  return std::hypot(a.number("tip_x_m") - b.number("tip_x_m"),
                    a.number("tip_y_m") - b.number("tip_y_m"),
                    a.number("tip_z_m") - b.number("tip_z_m"));
}

/// Of one model at one number of elements; NaN when the row is not there.
double value(const std::vector<Row>& rows, std::string_view column, const Row& like) {
  const auto found = std::ranges::find_if(rows, [&](const Row& row) {
    return row.ok() && row.has(column) &&
           std::ranges::all_of(like.cells(), [&row](const Row::Cell& cell) {
             return row.text(cell.first) == cell.second;
           });
  });
  return found == rows.end() ? std::nan("") : found->number(column);
}

Row like(std::string_view comparison, std::string_view model, int elements) {
  Row row;
  row.set("comparison", comparison).set("model", model).set("elements", elements);
  return row;
}

}  // namespace

void compare_with_corde(std::vector<Row>& rows) {
  constexpr double length = 0.1;  // m, of the default strand
  const auto found = [&rows](const Row& row, std::string_view model,
                             std::initializer_list<std::string_view> same) {
    return std::ranges::find_if(rows, [&](const Row& other) {
      return other.ok() && other.text("model") == model &&
             joined(other, same) == joined(row, same);
    });
  };
  for (Row& row : rows) {
    if (!row.ok()) continue;
    const auto other = found(row, theirs,
                             {"comparison", "scene", "elements", "youngs_modulus_pa",
                              "mass_damping_1_s", "t_s"});
    if (other != rows.end()) {
      if (row.has("tip_x_m"))
        row.set("corde_difference_rel", apart(row, *other) / length);
      if (row.has("lowest_t_s")) {
        row.set("lowest_t_ratio", other->number("lowest_t_s") / row.number("lowest_t_s"));
      }
      if (row.has("cost_per_element_step_s")) {
        row.set("cost_ratio", other->number("cost_per_element_step_s") /
                                  row.number("cost_per_element_step_s"));
      }
    }
    const auto counterpart = found(row, chain,
                                   {"comparison", "scene", "elements",
                                    "youngs_modulus_pa", "mass_damping_1_s", "t_s"});
    if (row.has("slowest_rad_s") && counterpart != rows.end()) {
      row.set("slowest_ratio",
              row.number("slowest_rad_s") / counterpart->number("slowest_rad_s"));
    }
    const auto reference = found(row, rod, {"comparison", "scene", "t_s"});
    if (row.has("tip_x_m") && reference != rows.end()) {
      row.set("rod_difference_rel", apart(row, *reference) / length);
    }
  }
}

void check_transport_claims(const std::vector<Row>& rows, Verdicts& verdicts) {
  const auto verdict = [&verdicts](const char* claim, double number, bool held) {
    if (!std::isnan(number)) verdicts.check(claim, held, number);
  };
  const auto apart_at = [&rows](std::string_view model, int elements) {
    return value(
        rows, "corde_difference_rel",
        like("dynamics", model, elements).set("scene", "straight").set("t_s", 0.1));
  };
  const double here = apart_at(ours, 40), before = apart_at(ours, 10);
  verdict(
      "straight, 0.1 s: force_transport is 5 % of the length off corde at 40 elements",
      here, here > 0.05);
  verdict("straight, 0.1 s: and as far as at 10 (ratio)", here / before,
          here / before > 0.9);
  const double control = apart_at(chain, 40);
  verdict("straight, 0.1 s: articulated_chain is 0.1 % off corde at most", control,
          control <= 1e-3);
  const double at_rest = value(rows, "deflection_error_rel", like("statics", ours, 40)) -
                         value(rows, "deflection_error_rel", like("statics", chain, 40));
  verdict("at rest force_transport is articulated_chain", at_rest,
          std::abs(at_rest) < 1e-6);
  const auto slowest = [&rows](int elements) {
    return value(rows, "slowest_ratio",
                 like("modes", ours, elements).set("scene", "weightless"));
  };
  const double stiffer = slowest(40) / slowest(10);
  verdict("weightless: its slowest oscillation is 1.8 times as fast at 10 elements",
          slowest(10), slowest(10) > 1.8);
  verdict("weightless: and another 1.7 times at 40", stiffer, stiffer > 1.7);
  const auto transient = [&rows](std::string_view model) {
    return value(rows, "energy_growth", like("transient", model, 20));
  };
  verdict("weightless, 20 elements: small motions of force_transport gain energy (times)",
          transient(ours), transient(ours) > 10);
  verdict("weightless: those of articulated_chain keep it to 1 %", transient(chain),
          transient(chain) < 1.01);
  const auto growth = [&rows](std::string_view model) {
    return value(rows, "growth_1_s",
                 like("modes", model, 10)
                     .set("scene", "hanging")
                     .set("youngs_modulus_pa", seed_hair));
  };
  verdict("hanging, the seed's modulus: small oscillations of force_transport grow (1/s)",
          growth(ours), growth(ours) > 1);
  verdict("hanging: those of articulated_chain do not", growth(chain),
          growth(chain) == 0);
}

}  // namespace tress
