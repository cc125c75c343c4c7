#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include "experiments/cost_of_gradient/cost_of_gradient.h"
#include "experiments/problems/strand_models.h"

namespace tress::experiments::cost_of_gradient {
namespace {

using Selection = std::function<bool(const Row&)>;

bool measured(const Row& row) { return row.has("gradient_error_rel"); }

/// Rows on the curl as gradients are computed by default.
bool by_default(const Row& row) {
  return row.text("part") == "time" && row.text("start") == "damped" &&
         row.text("jacobian") == "exact" && measured(row);
}

/// Models whose joints have no bending direction where they are straight: a curl of ten
/// such elements snaps.
bool kinked(const Row& row) {
  return row.text("model") == "mass_spring" || row.text("model") == "inextensible_strand";
}

bool smooth(const Row& row) { return by_default(row) && !kinked(row); }

Selection of(std::string_view method, int steps) {
  return [=](const Row& row) {
    return smooth(row) && row.text("integrator") == method &&
           row.number("steps") == steps;
  };
}

/// Largest value over the selected rows; the least with `sign` -1. NaN counts as such.
struct Extreme {
  double value = -std::numeric_limits<double>::infinity();
  int rows = 0;
};
Extreme largest(const std::vector<Row>& rows, const Selection& selected,
                const std::function<double(const Row&)>& value, double sign = 1) {
  Extreme found;
  for (const Row& row : rows) {
    if (!selected(row)) continue;
    ++found.rows;
    const double own = sign * value(row);
    if (!(own <= found.value)) found.value = own;
  }
  found.value *= sign;
  return found;
}

double error(const Row& row) { return row.number("gradient_error_rel"); }

class Judge {
 public:
  Judge(const std::vector<Row>& rows, Verdicts& verdicts)
      : rows_(rows), verdicts_(verdicts) {}

  void at_most(const std::string& claim, double bound, const Selection& selected,
               const std::function<double(const Row&)>& value = error) {
    const Extreme found = largest(rows_, selected, value);
    decide(claim, found, found.value <= bound);
  }
  void at_least(const std::string& claim, double bound, const Selection& selected,
                const std::function<double(const Row&)>& value = error) {
    const Extreme found = largest(rows_, selected, value, -1);
    decide(claim, found, found.value >= bound);
  }
  /// Of the largest value, which any model may have.
  void reaches(const std::string& claim, double bound, const Selection& selected) {
    const auto ran = [&](const ModelEntry* model) {
      return std::ranges::any_of(
          rows_, [&](const Row& row) { return row.text("model") == model->id; });
    };
    if (!std::ranges::all_of(strand_models(), ran)) {
      verdicts_.not_judged(claim);
      return;
    }
    const Extreme found = largest(rows_, selected, error);
    decide(claim, found, found.value >= bound);
  }

 private:
  void decide(const std::string& claim, const Extreme& found, bool holds) {
    if (found.rows == 0) {
      verdicts_.not_judged(claim);
    } else {
      verdicts_.check(claim, holds, found.value);
    }
  }

  const std::vector<Row>& rows_;
  Verdicts& verdicts_;
};

}  // namespace

void judge(const std::vector<Row>& rows, Verdicts& verdicts) {
  Judge judge(rows, verdicts);
  const std::string smooth_models =
      "all models but mass_spring and inextensible_strand: ";
  judge.at_most(
      smooth_models +
          "with over 80 steps the order of the gradient is that of the tip within 0.3",
      0.3,
      [](const Row& row) {
        return smooth(row) && row.number("steps") > 80 && row.has("gradient_order");
      },
      [](const Row& row) {
        return std::abs(row.number("gradient_order") - row.number("tip_order"));
      });
  judge.at_least(smooth_models +
                     "the error of the gradient is at least 10 times that of "
                     "the tip over the length",
                 10, smooth,
                 [](const Row& row) { return error(row) / row.number("tip_error_rel"); });
  judge.at_least(smooth_models + "backward_euler with 160 steps is at least 1 % wrong",
                 0.01, of("backward_euler", 160));
  const auto within = [&](std::string_view method, int steps, double error,
                          const char* percent) {
    judge.at_most(fmt::format("{}{} with {} steps is within {}", smooth_models, method,
                              steps, percent),
                  error, of(method, steps));
  };
  within("tr_bdf2", 80, 0.02, "2 %");
  within("esdirk43", 20, 0.01, "1 %");
  within("esdirk43", 160, 1e-4, "0.01 %");
  judge.reaches(smooth_models +
                    "the worst gradient without a damped start is over 100 % "
                    "wrong with 40 steps",
                1, [](const Row& row) {
                  return row.text("start") == "as_run" && row.number("steps") == 40 &&
                         measured(row) && !kinked(row);
                });
  judge.at_least(
      "all models but super_clothoid: with 10 elements the error in space is at least 5 "
      "%",
      0.05, [](const Row& row) {
        return row.text("part") == "space" && measured(row) &&
               row.number("elements") == 10 && row.text("model") != "super_clothoid";
      });
  judge.at_least(
      "super_helix, regularised contact: the gradient is at least 30 times as wrong as "
      "the tip over the length",
      30,
      [](const Row& row) {
        return row.text("part") == "contact" && row.text("law").starts_with("regul") &&
               measured(row);
      },
      [](const Row& row) { return error(row) / row.number("tip_error_rel"); });
  const auto fitted = [](std::string_view method, int steps) -> Selection {
    return [=](const Row& row) {
      return row.text("part") == "fit" && row.text("integrator") == method &&
             row.number("steps") == steps && measured(row);
    };
  };
  judge.at_least(
      "super_helix: a fit by backward_euler with 80 steps is at least 10 % wrong", 0.1,
      fitted("backward_euler", 80));
  judge.at_most("super_helix: it leaves at most 0.1 % of the length of the tip's record",
                1e-3, fitted("backward_euler", 80),
                [](const Row& row) { return row.number("tip_error_rel"); });
  for (const std::string_view method : {"tr_bdf2", "esdirk43"}) {
    judge.at_most(
        fmt::format("super_helix: a fit by {} with 40 steps is within 2 %", method), 0.02,
        fitted(method, 40));
  }
}

}  // namespace tress::experiments::cost_of_gradient
