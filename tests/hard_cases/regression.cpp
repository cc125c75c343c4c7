// Whether hard cases that were survived still are: the cells of expected.csv, one after
// the other, each at the best outcome known. Exit code 3 when one is worse. With
// --rewrite the file is written anew, of what this program finds.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "experiments/hard_cases/hard_cases.h"
#include "experiments/run/exit_code.h"
#include "simulation/files/csv.h"
#include "simulation/files/files.h"

namespace tress {

using namespace experiments;
using namespace experiments::hard_cases;
namespace {

const std::string file = TRESS_SOURCE_DIR "/tests/hard_cases/expected.csv";
const std::vector<std::string> columns{
    "case", "model", "variant", "integrator", "dt_s", "position_tol_rel", "outcome"};

// For a reference that another process makes: here there is none.
constexpr double patience = 0;
// Accurate is remembered with a tenth to spare: another compiler rounds otherwise.
constexpr double safely = 0.9 * largest_error;

/// Of two families, and the systems of particles: fully implicit, by one solve and by
/// tolerance.
Grid cells() {
  CommandLine line;
  line.quick = true;
  line.models = {"super_helix", "der", "inextensible_strand", "inextensible_chain",
                 "tinkertoys"};
  line.integrators = {"linearly_implicit_euler", "backward_euler", "tr_bdf2"};
  return hard_grid(line, Settings(line, hard_case_settings()));
}

/// Bounded by work alone: the same on a slow machine and in a checked build.
Survival run(const Cell& cell, References& references) {
  constexpr double coarser = 2;  // as --quick
  return survive(cell.attempt, quick_row, [&] {
    return references.get(cell.reference, patience, [&] {
      return reference(*cell.attempt.hard, cell.compared, cell.attempt.defaults,
                       cell.attempt.options, coarser, quick_reference);
    });
  });
}

Outcome to_remember(const Survival& survival) {
  if (survival.outcome == Outcome::accurate && *survival.error > safely) {
    return Outcome::stable;
  }
  return survival.outcome;
}

int rewrite(const Grid& grid) {
  References references(grid.references);
  std::vector<Row> rows;
  for (const Cell& cell : grid.cells) {
    const Outcome outcome = to_remember(run(cell, references));
    if (outcome == Outcome::not_finished) continue;
    rows.push_back(cell.identity().set("outcome", name(outcome)));
  }
  std::string text = csv_line(columns);
  for (const Row& row : rows) text += csv_line(in_order(row, columns));
  replace_file(file, text);
  fmt::print("{} cells written to {}\n", rows.size(), file);
  return done;
}

std::string key(const Row& row) {
  return joined(row,
                {"case", "model", "variant", "integrator", "dt_s", "position_tol_rel"});
}

int compare(const Grid& grid) {
  std::map<std::string, Outcome> expected;
  for (const Row& row : read_csv(file).rows) {
    expected[key(row)] = outcome_of(row.text("outcome"), file);
  }
  References references(grid.references);
  int worse = 0, better = 0;
  for (const Cell& cell : grid.cells) {
    const auto known = expected.find(key(cell.identity()));
    if (known == expected.end()) continue;
    const Survival found = run(cell, references);
    const Outcome best = known->second, now = found.outcome;
    const std::string which = describe(cell.identity());
    if (passed(best) && now < best) {
      ++worse;
      fmt::print("WORSE  {}: was {}, is {}: {}\n", which, name(best), name(now),
                 found.why);
    } else if (to_remember(found) > best && passed(now)) {
      ++better;
      fmt::print("better {}: was {}, is {}\n", which, name(best), name(now));
    }
    expected.erase(known);
  }
  for (const auto& [which, best] : expected) {
    ++worse;
    fmt::print("WORSE  {}: was {}, is no cell any more\n", which, name(best));
  }
  fmt::print("{} worse, {} better; --rewrite takes what is now\n", worse, better);
  return worse == 0 ? done : rows_failed;
}

}  // namespace
}  // namespace tress

int main(int argc, char** argv) {
  using namespace tress;
  return exit_code("hard_cases_regression", [&] {
    const Grid grid = cells();
    const bool anew = argc == 2 && std::string(argv[1]) == "--rewrite";
    return anew ? rewrite(grid) : compare(grid);
  });
}
