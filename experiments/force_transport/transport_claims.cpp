#include "experiments/force_transport/transport_claims.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace tress::experiments::force_transport {
namespace {

using namespace transport;

double apart(const Row& a, const Row& b) {
  return std::hypot(a.number("tip_x_m") - b.number("tip_x_m"),
                    a.number("tip_y_m") - b.number("tip_y_m"),
                    a.number("tip_z_m") - b.number("tip_z_m"));
}

/// Value of a claim: NaN if a row that was run lacks it, empty if a row is missing.
using Value = std::optional<double>;

/// For one model at one number of elements.
Value value(const std::vector<Row>& rows, std::string_view column, const Row& like) {
  Value found;
  for (const Row& row : rows) {
    const bool same = std::ranges::all_of(like.cells(), [&row](const Row::Cell& cell) {
      return row.text(cell.first) == cell.second;
    });
    if (!same) continue;
    if (row.ok() && row.has(column)) return row.number(column);
    found = std::nan("");
  }
  return found;
}

template <typename Combine>
Value both(Value a, Value b, Combine combine) {
  return a && b ? Value(combine(*a, *b)) : Value();
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
                              "mass_damping_per_s", "t_s"});
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
                                    "youngs_modulus_pa", "mass_damping_per_s", "t_s"});
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
  // Comparisons with NaN never hold.
  const auto verdict = [&verdicts](const char* claim, Value number, auto holds) {
    if (number) {
      verdicts.check(claim, holds(*number), *number);
    } else {
      verdicts.not_judged(claim);
    }
  };
  const auto above = [](double least) {
    return [least](double number) { return number > least; };
  };
  const auto ratio = [](Value a, Value b) { return both(a, b, std::divides()); };
  const auto apart_at = [&rows](std::string_view model, int elements) {
    const auto tip = [&](std::string_view whose, std::string_view column) {
      return value(
          rows, column,
          like("dynamics", whose, elements).set("scene", "straight").set("t_s", 0.1));
    };
    return both(tip(model, "corde_difference_rel"), tip(theirs, "tip_x_m"),
                [](double difference, double) { return difference; });
  };
  verdict(
      "straight, 0.1 s, 40 elements: the tip of force_transport is over 5 % of the "
      "length from that of corde",
      apart_at(ours, 40), above(0.05));
  verdict("straight, 0.1 s: this distance with 40 elements is over 0.9 of that with 10",
          ratio(apart_at(ours, 40), apart_at(ours, 10)), above(0.9));
  verdict(
      "straight, 0.1 s, 40 elements: the tip of articulated_chain is within 0.1 % of "
      "the length of that of corde",
      apart_at(chain, 40), [](double off) { return off <= 1e-3; });
  verdict(
      "at rest, 40 elements: force_transport deflects as articulated_chain does",
      both(value(rows, "deflection_error_rel", like("statics", ours, 40)),
           value(rows, "deflection_error_rel", like("statics", chain, 40)), std::minus()),
      [](double at_rest) { return std::abs(at_rest) < 1e-6; });
  const auto slowest = [&rows](int elements) {
    const auto of = [&](std::string_view model, std::string_view column) {
      return value(rows, column,
                   like("modes", model, elements).set("scene", "weightless"));
    };
    return both(of(ours, "slowest_ratio"), of(chain, "slowest_rad_s"),
                [](double times, double) { return times; });
  };
  verdict(
      "weightless, 10 elements: the slowest oscillation of force_transport is over "
      "1.8 times as fast as that of articulated_chain",
      slowest(10), above(1.8));
  verdict("weightless: this ratio with 40 elements is over 1.7 times that with 10",
          ratio(slowest(40), slowest(10)), above(1.7));
  const auto transient = [&rows](std::string_view model) {
    return value(rows, "energy_growth", like("transient", model, 20));
  };
  verdict(
      "weightless, 20 elements: small motions of force_transport multiply their energy "
      "by over 10",
      transient(ours), above(10));
  verdict(
      "weightless, 20 elements: small motions of articulated_chain gain less than 1 % "
      "of energy",
      transient(chain), [](double growth) { return growth < 1.01; });
  const auto growth = [&rows](std::string_view model) {
    return value(rows, "growth_per_s",
                 like("modes", model, 10)
                     .set("scene", "hanging")
                     .set("youngs_modulus_pa", seed_hair));
  };
  verdict(
      "hanging, published modulus: small oscillations of force_transport grow by over "
      "1/s",
      growth(ours), above(1));
  verdict(
      "hanging, published modulus: small oscillations of articulated_chain do not grow",
      growth(chain), [](double rate) { return rate == 0; });
}

}  // namespace tress::experiments::force_transport
