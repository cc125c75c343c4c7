// What does a head of hair cost when processes divide it, and where does that stop to
// pay?
#include <fmt/format.h>
#include <stdlib.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <span>
#include <string>
#include <thread>
#include <vector>

#include "contract/input_error.h"
#include "experiments/divided_heads/cost_model.h"
#include "experiments/divided_heads/launch.h"
#include "experiments/divided_heads/predictions.h"
#include "experiments/divided_heads/scene.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "simulation/files/files.h"

namespace tress::experiments::divided_heads {
namespace {

/// A part of the time of a step: its name in outcomes of simulate, and its column.
struct Part {
  std::string_view outcome;
  std::string_view column;
};
constexpr Part ghost_search{"claim_s", "ghost_search_per_element_s"},
    halo_exchange{"exchange_s", "halo_exchange_per_element_s"},
    ghost_contact{"meet_s", "ghost_contact_per_element_s"};

constexpr Column columns[] = {
    {"kind", "measured, or predicted by the model alone"},
    {"effects",
     "effects in addition to gravity: drag; interaction of neighbouring hairs, "
     "and drag"},
    {"strands",
     "number of hairs, which have the same density on the scalp in all "
     "rows"},
    {"ranks", "processes of mpirun, of one thread each"},
    {"beside", "number of such grooms that run at the same time"},
    {"cores", "cores of the machine", true},
    {"cost_per_step_s", "wall time of a step, mean of a run; median of runs", true},
    {"ghosts_per_strand",
     "strands of other ranks that may touch a rank's own, over these"},
    {ghost_search.column,
     "time per step to find the strands of other ranks that may touch own ones, "
     "per own element",
     true},
    {halo_exchange.column,
     "time per step to send and receive these strands, waiting included, per own "
     "element",
     true},
    {ghost_contact.column,
     "time per step to list the contacts with strands of other ranks, per own "
     "element",
     true},
    {"memory_mb", "memory of the rank that holds most, program included", true},
    {"model_cost_per_step_s", "cost_per_step_s predicted by the model", true},
    {"model_off_rel",
     "difference of the prediction from the measurement, over the measurement", true},
    {"held_out_off_rel", "model_off_rel of a model fitted to grooms of other sizes only",
     true},
    {"model_ghosts_per_strand", "ghosts_per_strand predicted by the model"},
    {"efficiency",
     "share of a rank's time spent on its own hairs, predicted by the model", true},
    {"state_hash", "checksum of all states at the end: equal bits, equal checksum"},
};

#ifdef TRESS_HAS_MPI
constexpr bool has_mpi = true;
#else
constexpr bool has_mpi = false;
#endif

// Each twice the one before, for the same number of hairs on each of 1, 2 and 4 ranks.
constexpr int measured_strands[] = {1000, 2000, 4000, 8000},
              strands_of_quick[] = {500, 1000, 2000};
/// How a head is measured.
struct Setting {
  int ranks, beside;
};
constexpr Setting settings_of_head[] = {{1, 1}, {1, 2}, {2, 1}, {4, 1}};

struct Failed {
  std::string reason;
};

/// As a user would: simulate by mpirun, more ranks than cores if need be. The outcomes of
/// the heads that run at the same time.
std::vector<nlohmann::json> run(const std::filesystem::path& folder,
                                const std::string& head, const Setting& setting) {
  const std::filesystem::path simulate =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "simulate";
  const auto out = [&](int i) { return folder / std::to_string(i); };
  const auto log = [&](int i) { return out(i).string() + ".log"; };
  std::vector<Launched> beside;
  for (int i = 0; i < setting.beside; ++i) {
    const std::vector<std::string> words{"mpirun",     "--oversubscribe",
                                         "--bind-to",  "none",
                                         "-n",         std::to_string(setting.ranks),
                                         simulate,     folder / (head + ".toml"),
                                         "--as",       "batch",
                                         "--frames",   "none",
                                         "--progress", "none",
                                         "--out",      out(i)};
    beside.emplace_back(words, log(i));
  }
  for (int i = 0; i < setting.beside; ++i) {
    if (beside[static_cast<std::size_t>(i)].succeeds()) continue;
    const std::string text = read_file(log(i));
    throw Failed{"mpirun failed: " + text.substr(0, text.find('\n'))};
  }
  std::vector<nlohmann::json> outcomes;
  for (int i = 0; i < setting.beside; ++i) {
    outcomes.push_back(
        nlohmann::json::parse(read_file((out(i) / (head + ".meta.json")).string()))
            .at("outcome"));
  }
  return outcomes;
}

double step_of(const nlohmann::json& outcome) {
  return outcome.at("step_s").get<double>() / outcome.at("steps").get<double>();
}

void fill(Row& row, const nlohmann::json& outcome) {
  const auto number = [&](const std::string& name) {
    return outcome.at(name).get<double>();
  };
  const double own = number("rank_strands");
  row.set("cores", static_cast<int>(std::thread::hardware_concurrency()));
  row.set("cost_per_step_s", step_of(outcome));
  row.set("memory_mb", number("peak_memory_mb"));
  row.set("state_hash", outcome.at("state_hash").get<std::string>());
  if (!outcome.contains("ghosts_per_step")) return;
  row.set("ghosts_per_strand", number("ghosts_per_step") / own);
  for (const Part& part : {ghost_search, halo_exchange, ghost_contact}) {
    row.set(part.column, number(std::string(part.outcome)) / (own * elements));
  }
}

/// Heads of all these numbers of hairs and all settings take turns, so that the load
/// and the speed of the machine affect all of them equally.
std::vector<Row> measure(const Row& of_all, std::span<const int> strands, int repeat) {
  struct Measured {
    std::string head;
    Setting setting;
    std::vector<nlohmann::json> runs;
  };
  for (const char* allowed :
       {"OMPI_ALLOW_RUN_AS_ROOT", "OMPI_ALLOW_RUN_AS_ROOT_CONFIRM"}) {
    ::setenv(allowed, "1", 1);
  }
  const PrivateFolder folder;
  std::vector<Row> rows;
  std::vector<Measured> all;
  for (const int count : strands) {
    const std::string head = fmt::format("head_{}", count);
    replace_file((folder.path() / (head + ".toml")).string(),
                 scene(of_all.text("effects") == "interaction", count));
    for (const Setting& setting : settings_of_head) {
      all.push_back({head, setting, {}});
      rows.push_back(of_all);
      rows.back().set("strands", count).set("ranks", setting.ranks);
      rows.back().set("beside", setting.beside);
    }
  }
  try {
    for (int i = 0; i < repeat; ++i) {
      for (Measured& one : all) {
        // The slowest of those that run at the same time.
        one.runs.push_back(
            std::ranges::max(run(folder.path(), one.head, one.setting), {}, step_of));
      }
    }
  } catch (const Failed& failed) {
    for (Row& row : rows) row.failed("not_run", failed.reason);
    return rows;
  }
  for (std::size_t k = 0; k < rows.size(); ++k) {
    auto& runs = all[k].runs;
    const auto middle = runs.begin() + static_cast<std::ptrdiff_t>(repeat / 2);
    std::ranges::nth_element(runs, middle, {}, step_of);
    fill(rows[k], *middle);
  }
  return rows;
}

std::vector<Case> cases(const CommandLine& line) {
  const Settings settings(line, {});
  if (!has_mpi) {
    throw InputError("built without MPI", "divided_heads",
                     "install the packages of cmake/mpi_packages.txt and build again");
  }
  std::vector<Case> all;
  const auto row_of = [](const char* kind, const char* effects) {
    Row row;
    row.set("kind", kind).set("effects", effects);
    return row;
  };
  const std::span<const int> strands =
      line.quick ? std::span<const int>(strands_of_quick) : measured_strands;
  for (const char* effects : {"drag", "interaction"}) {
    all.push_back({row_of("measured", effects),
                   {},
                   [strands, repeat = line.repeat](const Row& row, const Deadline&) {
                     return measure(row, strands, repeat);
                   }});
  }
  for (const char* effects : {"drag", "interaction"}) {
    for (const long count : {10'000L, 100'000L, 1'000'000L, 10'000'000L}) {
      for (int ranks = 1; ranks <= 4096; ranks *= 4) {
        all.push_back(
            {row_of("predicted", effects).set("strands", count).set("ranks", ranks),
             [](Row&, const Deadline&) {}});
      }
    }
  }
  return all;
}

void judge(const std::vector<Row>& rows, Verdicts& verdicts) {
  std::map<std::string, std::string> states;
  int compared = 0, different = 0;
  double off = 0, held_out = 0, exchange = 0;
  for (const Row& row : rows) {
    if (!row.ok() || row.text("kind") != "measured") continue;
    const auto [first, added] = states.emplace(
        std::string(row.text("effects")) + ' ' + std::string(row.text("strands")),
        std::string(row.text("state_hash")));
    if (!added) {
      ++compared;
      different += first->second != row.text("state_hash") ? 1 : 0;
    }
    if (row.number("ranks") > 2) continue;
    if (row.has("model_off_rel")) {
      off = std::max(off, std::abs(row.number("model_off_rel")));
    }
    if (row.has("held_out_off_rel")) {
      held_out = std::max(held_out, std::abs(row.number("held_out_off_rel")));
    }
    if (row.has(halo_exchange.column)) {
      exchange = std::max(exchange, row.number(halo_exchange.column));
    }
  }
  const std::string bits = "results are bitwise equal for any number of ranks";
  if (compared > 0) {
    verdicts.check(bits, different == 0, different);
  } else {
    verdicts.not_judged(bits);
  }
  verdicts.figure("one and two ranks: largest relative error of the cost model", off);
  verdicts.figure(
      "one and two ranks: the same for numbers of hairs that the model was not fitted to",
      held_out);
  verdicts.figure("two ranks: largest time to exchange halos per own element, s",
                  exchange);
}

constexpr Unused unused[] = {
    {"models", "hairs are super-helices"},
    {"integrators", "steps are those of linearly_implicit_euler"},
    {"elements", "hairs have ten"},
    not_random};

}  // namespace
}  // namespace tress::experiments::divided_heads

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::divided_heads;
  const Experiment experiment{
      .name = "divided_heads",
      .question = "what does a batch cost that processes divide?",
      .example = "--quick",
      .sizes = {"58 rows, 3 sizes of heads", "58 rows, all sizes"},
      .quick_timeout_s = 600,
      .columns = columns,
      .unused = unused,
      .cases = cases,
      .derive = add_predictions,
      .checks = judge};
  return run_experiment(experiment, argc, argv);
}
