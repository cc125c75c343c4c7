// Whether hard cases that were survived still are: the cells of expected.csv, one after
// the other, each at the best outcome known. Exit code 3 when one is worse. With
// --rewrite the file is written anew, of what this program finds.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <map>
#include <string>
#include <vector>

#include "experiments/hard_cases/grid.h"
#include "experiments/harness/csv.h"
#include "experiments/harness/exit_code.h"
#include "experiments/harness/files.h"

namespace tress {
namespace {

const std::string file = TRESS_SOURCE_DIR "/tests/hard_cases/expected.csv";
const std::vector<std::string> columns{"case",       "model", "variant",
                                       "integrator", "dt_s",  "outcome"};

// A cell that takes longer (s of the processor) is left to the experiment; what is kept
// has ten times as long, for slower machines and checked builds.
constexpr double longest = 0.3, patience = 10 * longest;
// Accurate is remembered with a tenth to spare: another compiler rounds otherwise.
constexpr double safely = 0.9 * largest_error;

/// Of two families, and the systems of particles: fully implicit and by one solve.
Grid cells() {
  CommandLine line;
  line.quick = true;
  line.models = {"super_helix", "der", "inextensible_strand", "inextensible_chain",
                 "tinkertoys"};
  line.integrators = {"semi_implicit_euler", "backward_euler"};
  return hard_grid(line, Settings(line, hard_case_settings()));
}

struct Found {
  Survival survival;
  double seconds;  // of the processor
};

Found run(const Cell& cell, References& references) {
  constexpr double coarser = 2;  // as --quick
  const auto began = std::clock();
  Survival survival = survive(cell.attempt, CpuLimit(patience), [&] {
    return references.get(cell.reference, patience, [&] {
      return reference(*cell.attempt.hard, cell.compared, cell.attempt.defaults,
                       cell.attempt.options, coarser, CpuLimit(patience));
    });
  });
  const double seconds = static_cast<double>(std::clock() - began) / CLOCKS_PER_SEC;
  return {std::move(survival), seconds};
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
    const Found found = run(cell, references);
    const Outcome outcome = to_remember(found.survival);
    if (found.seconds > longest || outcome == Outcome::not_finished) continue;
    rows.push_back(cell.identity().set("outcome", name(outcome)));
  }
  std::string text = csv_line(columns);
  for (const Row& row : rows) text += csv_line(in_order(row, columns));
  replace_file(file, text);
  fmt::print("{} cells written to {}\n", rows.size(), file);
  return done;
}

std::string key(const Row& row) {
  return joined(row, {"case", "model", "variant", "integrator", "dt_s"});
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
    const Found found = run(cell, references);
    const Outcome best = known->second, now = found.survival.outcome;
    const std::string which = describe(cell.identity());
    if (passed(best) && now < best) {
      ++worse;
      fmt::print("WORSE  {}: was {}, is {}: {}\n", which, name(best), name(now),
                 found.survival.why);
    } else if (to_remember(found.survival) > best && passed(now)) {
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
