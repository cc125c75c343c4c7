#include <algorithm>
#include <array>
#include <string>

#include "experiments/hard_cases/hard_case.h"
#include "experiments/hard_cases/hard_cases.h"

namespace tress::experiments::hard_cases {
namespace {

/// Time of failure, or the measure, in the named column.
struct Known {
  std::string_view column;
  KnownLimit known;
};

constexpr Known limits[] = {
    {"t_s",
     {"long_curl", 0.066, 0.067,
      "one curvature near the root swings two metres of curls farther than they fall in "
      "a step: the first two are solved short and made longer, of the third no solution "
      "is found"}},
    {"t_s",
     {"cone", 0, 0,
      "what sticks below 1 mm/s turns round within one of Newton's steps at 0.3 m/s: no "
      "solution of the first step"}},
    {"measure",
     {"cone_impulse", 2.4, 2.6,
      "impulses follow the response of the strand's own step, which is linear: at 1/30 s "
      "ends that hit head-on bend it farther than that; cone_exact, which solves for all "
      "at once, passes"}},
    {"measure",
     {"million_steps", 0.2, 0.22,
      "backward_euler keeps no momentum: in its first steps of 1/30 s it gains a fifth, "
      "the same after 5000 steps as after a million"}},
};

const Known* limit_of(std::string_view hard) {
  const auto found = std::ranges::find(
      limits, hard, [](const Known& limit) { return limit.known.claim; });
  return found == std::end(limits) ? nullptr : &*found;
}

/// Of super_helix with its exact Jacobian.
const Row* claimed(const std::vector<Row>& rows, std::string_view hard,
                   std::string_view integrator, const Pace& pace) {
  Row wanted;
  pace.identify(wanted);
  const auto found = std::ranges::find_if(rows, [&](const Row& row) {
    return row.text("case") == hard && row.text("model") == "super_helix" &&
           row.text("variant") == "jacobian=exact" &&
           row.text("integrator") == integrator &&
           row.text("dt_s") == wanted.text("dt_s") &&
           row.text("position_tol_rel") == wanted.text("position_tol_rel");
  });
  return found == rows.end() ? nullptr : &*found;
}

/// Returns whether a tolerance controls the error. It does not where the reference has
/// other elements, for the error is then one of space, nor over a number of steps whose
/// errors add up.
bool of_the_tolerance(const Row& row) {
  const auto cases = hard_case_catalogue();
  const auto found = std::ranges::find(cases, row.text("case"), &HardCase::name);
  return found == cases.end() || (found->rod_elements == 0 && found->count == 0);
}

/// Passed, but beyond its criterion, or farther off than anyone would ask for.
bool silently_wrong(const Row& row) {
  const bool kept = !row.has("measure") || row.number("measure") <= row.number("limit");
  const bool near = !row.has("error_rel") || !of_the_tolerance(row) ||
                    row.number("error_rel") <= largest_error;
  return !kept || !near;
}

/// A method that is given an error says when it cannot keep it.
void check_by_tolerance(const std::vector<Row>& rows, Verdicts& verdicts) {
  std::ptrdiff_t passing = 0, silent = 0;
  for (const Row& row : rows) {
    if (!row.has("position_tol_rel") || row.text("passed") != "true") continue;
    ++passing;
    if (silently_wrong(row)) ++silent;
  }
  const std::string never =
      "no adaptive run passes with an error above 5 %, apart from errors in space and "
      "those of a million steps";
  if (passing > 0) {
    verdicts.check(never, silent == 0, static_cast<double>(silent));
  } else {
    verdicts.not_judged(never);
  }
  for (const std::string_view hard : {"long_curl", "cone"}) {
    const std::string claim = std::string(hard) +
                              ": super_helix, exact Jacobian, tr_bdf2 is accurate at a "
                              "tolerance of 1e-3";
    const Row* row = claimed(rows, hard, "tr_bdf2", {longest_step, 1e-3});
    const bool unknown = row == nullptr ||
                         row->text("outcome") == name(Outcome::not_finished) ||
                         (row->text("passed") == "true" && !row->has("error_rel"));
    if (unknown) {
      verdicts.not_judged(claim);
    } else {
      verdicts.check(claim, row->text("outcome") == name(Outcome::accurate),
                     row->number("error_rel"));
    }
  }
}

/// A case with a regularised law, and the same by the exact one.
struct Pair {
  std::string_view regularised, exact;
};
constexpr Pair pairs[] = {{"grazing_contact", "grazing_exact"},
                          {"grazing_contact", "grazing_impulse"},
                          {"cone", "cone_exact"},
                          {"cone", "cone_impulse"},
                          {"coil_contact", "coil_impulse"}};

/// The row of the same model, method and step of another case; null: none.
const Row* counterpart(const std::vector<Row>& rows, const Row& of,
                       std::string_view hard) {
  const auto found = std::ranges::find_if(rows, [&](const Row& row) {
    if (row.text("case") != hard) return false;
    return std::ranges::all_of(
        std::array{"model", "variant", "integrator", "dt_s", "position_tol_rel"},
        [&](std::string_view column) { return row.text(column) == of.text(column); });
  });
  return found == rows.end() ? nullptr : &*found;
}

/// Contact that is exact holds where the regularised one did not.
void check_exact_contact(const std::vector<Row>& rows, Verdicts& verdicts) {
  constexpr int least = 15;
  int rising = 0;
  bool all = false;  // every case has rows
  for (const Row& row : rows) {
    bool has = false, holds = false;
    for (const Pair& pair : pairs) {
      if (row.text("case") != pair.regularised) continue;
      const Row* exact = counterpart(rows, row, pair.exact);
      has = has || exact != nullptr;
      holds = holds || (exact != nullptr && exact->text("passed") == "true");
    }
    const std::string_view outcome = row.text("outcome");
    const bool fell =
        outcome == name(Outcome::unstable) || outcome == name(Outcome::not_finished);
    if (fell && holds) ++rising;
    all = all || (has && row.text("case") == "coil_contact");
  }
  const Claim claim{
      "at least 15 combinations of contact case, model, method and step fail with a "
      "regularised law and survive with an exact one",
      "exact_contact_survives"};
  if (all) {
    verdicts.check(claim, rising >= least, rising);
  } else {
    verdicts.not_judged(claim);
  }
}

}  // namespace

void check_hard_cases(const std::vector<Row>& rows, Verdicts& verdicts) {
  const auto missing = std::ranges::count_if(
      rows, [](const Row& row) { return row.text("outcome").empty(); });
  verdicts.check("every cell has an outcome", missing == 0, static_cast<double>(missing));
  for (const HardCase& hard : hard_case_catalogue()) {
    std::string claim = std::string(hard.name) +
                        ": super_helix, exact Jacobian, backward_euler passes at 1/30 s";
    const Row* row = claimed(rows, hard.name, "backward_euler", {1.0 / 30});
    if (row == nullptr) {
      verdicts.not_judged(std::move(claim));
      continue;
    }
    if (row->text("outcome") == "refused") continue;  // its kinematics does not admit it
    const bool held = row->text("passed") == "true";
    if (!held) claim += "; " + std::string(row->text("why"));
    if (const Known* limit = limit_of(hard.name)) {
      verdicts.check_known(std::move(claim), held, row->number(limit->column),
                           limit->known);
    } else {
      verdicts.check(std::move(claim), held, row->number("measure"));
    }
  }
  check_by_tolerance(rows, verdicts);
  check_exact_contact(rows, verdicts);
}

}  // namespace tress::experiments::hard_cases
