#include "experiments/run/rows.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "contract/input_error.h"
#include "contract/printable.h"
#include "experiments/run/exit_code.h"
#include "experiments/run/message.h"
#include "simulation/files/parse.h"

namespace tress::experiments {
namespace {

std::string_view heading(Verdicts::State state) {
  switch (state) {
    case Verdicts::State::held:
      return "PASS";
    case Verdicts::State::broken:
      return "FAIL";
    case Verdicts::State::known_limit:
      return "KNOWN LIMIT";
    case Verdicts::State::changed:
      return "CHANGED";
    case Verdicts::State::not_judged:
    case Verdicts::State::figure:
      break;
  }
  return "FIGURE";
}

void tell_verdicts(std::string_view experiment, const Verdicts& verdicts) {
  int not_judged = 0;
  for (const Verdicts::Verdict& verdict : verdicts.all()) {
    if (verdict.state == Verdicts::State::not_judged) {
      ++not_judged;
      continue;
    }
    const bool limit = verdict.state == Verdicts::State::known_limit ||
                       verdict.state == Verdicts::State::changed;
    tell("{}: {} {} ({:.3g}){}{}\n", experiment, heading(verdict.state), verdict.claim,
         verdict.value, limit ? "; " : "", limit ? verdict.reason : "");
  }
  if (not_judged > 0) {
    tell("{}: claims of the study not judged, since their rows were not run: {}\n",
         experiment, not_judged);
  }
}

}  // namespace

std::vector<std::string> parse_run_ids(const std::string& list) {
  std::vector<std::string> ids = split(list, ',', "--run-id");
  for (const std::string& id : ids) {
    const std::string_view text = id;
    const std::string_view hash = text.substr(0, 16), further = text.substr(hash.size());
    const auto made_of = [](std::string_view part, std::string_view digits) {
      return part.find_first_not_of(digits) == part.npos;
    };
    const bool number = further.size() > 1 && further.front() == '.' &&
                        made_of(further.substr(1), "0123456789");
    if (hash.size() == 16 && made_of(hash, "0123456789abcdef") &&
        (further.empty() || number)) {
      continue;
    }
    throw InputError(fmt::format("'{}' is not a run_id", id), "--run-id",
                     "give the 16 hexadecimal digits of that column");
  }
  return ids;
}

std::vector<Case> chosen_rows(std::vector<Case> cases, const CommandLine& line) {
  if (line.run_ids.empty()) return cases;
  std::set<std::string> wanted;  // of cases: without the number of a further row
  for (const std::string& id : line.run_ids) wanted.insert(id.substr(0, id.find('.')));
  std::set<std::string> found;
  std::erase_if(cases, [&](const Case& work) {
    const std::string id(work.identity.text("run_id"));
    if (wanted.contains(id)) found.insert(id);
    return !wanted.contains(id);
  });
  for (const std::string& id : wanted) {
    if (found.contains(id)) continue;
    throw InputError("no row of these options has the run_id " + id, line.place("run-id"),
                     "--dry-run prints the rows with their run_id");
  }
  return cases;
}

int report_table(const Experiment& experiment, const CommandLine& line,
                 const std::vector<Row>& rows, const Verdicts& verdicts) {
  std::map<std::string, int> counts;
  const Row* failed = nullptr;
  for (const Row& row : rows) {
    ++counts[std::string(row.status())];
    const bool finding = experiment.finding && experiment.finding(row);
    if (failed == nullptr && !row.ok() && !finding) failed = &row;
  }
  // With JSON progress they are in the manifest.
  if (line.progress != ProgressMode::json) tell_verdicts(experiment.name, verdicts);
  if (line.progress != ProgressMode::none || failed != nullptr) {
    std::string text;
    for (const auto& [status, count] : counts)
      text += fmt::format(", {} {}", count, status);
    if (failed != nullptr) {
      text += fmt::format("; first: {}", printable(failed->text("reason")));
    }
    tell("{}: {} rows{} -> {}\n", experiment.name, rows.size(), text, line.out);
  }
  const bool alarm = std::ranges::any_of(verdicts.all(), &Verdicts::Verdict::alarm);
  return alarm || failed != nullptr ? rows_failed : done;
}

}  // namespace tress::experiments
