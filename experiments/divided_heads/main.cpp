// What does a head of hair cost when processes divide it, and where does that stop to
// pay?
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "simulation/files/files.h"

namespace tress::experiments::divided_heads {
namespace {

constexpr Column columns[] = {
    {"kind", "measured, or predicted by the model alone"},
    {"effects", "beside gravity: drag; interaction of neighbouring hairs, and drag"},
    {"strands", "hairs, all on one scalp"},
    {"ranks", "processes of mpirun, of one thread each"},
    {"cores", "of the machine", true},
    {"cost_per_step_s", "wall time of a step, mean", true},
    {"ghosts_per_strand",
     "strands of other ranks that may touch a rank's own, over these"},
    {"claim_per_element_s", "of a step: to find which strands those are, by own elements",
     true},
    {"exchange_per_element_s",
     "of a step: to send and receive them, waiting included, by own elements", true},
    {"memory_mb", "of the rank that holds most, program included", true},
    {"model_cost_per_step_s", "what the model says", true},
    {"model_off_rel", "its difference from the measurement, over that", true},
    {"efficiency", "one rank's time over that of all ranks together, by the model", true},
    {"state", "checksum of all states at the end: equal bits, equal checksum"},
};

constexpr int elements = 10;
constexpr double dt = 0.0025, duration = 0.2;  // s
constexpr int measured_strands[] = {500, 1000, 2000, 4000}, measured_ranks[] = {1, 2, 4};
// Those that set the model's numbers; the others test it.
constexpr int fitted_strands[] = {500, 2000};

std::string scene(bool interaction, int strands) {
  return fmt::format(
      "title = \"a head that processes divide\"\nduration_s = {}\nframes_1_s = 5\n"
      "[model]\nid = \"super_helix\"\ntangent = \"stiff\"\n[integrator]\n"
      "id = \"semi_implicit_euler\"\ndt_s = {}\n[material]\nname = \"hair.caucasian\"\n"
      "[groom]\ncount = {}\nelements = {}\nlength_m = 0.2\n[root]\nmotion = \"rotate\"\n"
      "axis = [0, 0, 1]\nangle_rad = 0.5\n[effects.gravity]\n[effects.linear_drag]\n"
      "drag_kg_m_s = 1e-4\n{}",
      duration, dt, strands, elements,
      interaction ? "[effects.strand_interaction]\nstiffness_n_m2 = 2e-4\n"
                    "viscosity_n_s_m2 = 2e-4\ninner_radius_m = 3e-3\n"
                    "outer_radius_m = 6e-3\n"
                  : "");
}

/// A folder that is removed in the end.
struct Folder {
  std::filesystem::path path = std::filesystem::temp_directory_path() /
                               fmt::format("tress_divided_{}", ::getpid());
  Folder() { std::filesystem::create_directory(path); }
  ~Folder() {
    std::error_code ignored;
    std::filesystem::remove_all(path, ignored);
  }
};

/// As a user would: simulate by mpirun, more ranks than cores if need be.
void measure(Row& row) {
  const Folder folder;
  const std::string file = (folder.path / "head.toml").string();
  const auto ranks = static_cast<int>(row.number("ranks"));
  replace_file(file, scene(row.text("effects") == "interaction",
                           static_cast<int>(row.number("strands"))));
  const std::filesystem::path simulate =
      std::filesystem::read_symlink("/proc/self/exe").parent_path() / "simulate";
  const std::string command = fmt::format(
      "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
      "mpirun --oversubscribe --bind-to none -n {} '{}' '{}' --as head --frames none "
      "--progress none --out '{}' >'{}' 2>&1",
      ranks, simulate.string(), file, folder.path.string(),
      (folder.path / "log").string());
  if (std::system(command.c_str()) != 0) {
    row.failed("refused",
               "no mpirun, or simulate was built without MPI: see "
               "cmake/mpi_packages.txt");
    return;
  }
  const auto manifest =
      nlohmann::json::parse(read_file((folder.path / "head.meta.json").string()));
  const nlohmann::json& outcome = manifest.at("outcome");
  const auto number = [&](const char* name) { return outcome.at(name).get<double>(); };
  const double own = number("rank_strands");
  row.set("cores", static_cast<int>(std::thread::hardware_concurrency()));
  row.set("cost_per_step_s", number("step_s") / number("steps"));
  row.set("memory_mb", number("peak_memory_mb"));
  row.set("state", outcome.at("state").get<std::string>());
  if (!outcome.contains("ghosts_per_step")) return;
  row.set("ghosts_per_strand", number("ghosts_per_step") / own);
  row.set("claim_per_element_s", number("claim_s") / (own * elements));
  row.set("exchange_per_element_s", number("exchange_s") / (own * elements));
}

std::vector<Case> cases(const CommandLine& line) {
  const Settings settings(line, {});
  std::vector<Case> all;
  const auto add = [&](const char* kind, const char* effects, long strands, int ranks) {
    Row row;
    row.set("kind", kind).set("effects", effects).set("strands", strands);
    row.set("ranks", ranks);
    const bool measured = std::string_view(kind) == "measured";
    all.push_back({row, [measured](Row& r, const Deadline&) {
                     if (measured) measure(r);
                   }});
  };
  for (const char* effects : {"drag", "interaction"}) {
    for (const int strands : measured_strands) {
      for (const int ranks : measured_ranks) add("measured", effects, strands, ranks);
    }
  }
  for (const char* effects : {"drag", "interaction"}) {
    for (const long strands : {10'000L, 100'000L, 1'000'000L, 10'000'000L}) {
      for (int ranks = 1; ranks <= 4096; ranks *= 4) {
        add("predicted", effects, strands, ranks);
      }
    }
  }
  return all;
}

/// Wall time of a step of n hairs of e elements on R ranks,
///
///     T(n, R) = (n e/R) (k + c n) (1 + b g(R)) + l log2 R,
///
/// k: a hair alone; c n: its contacts, as the hairs within reach of one are as many as
/// hairs are dense; g(R): ghosts of an own strand, b: what one costs over a hair, to
/// send, receive, hold and list; l: latency of the collective calls of a step. Ghosts lie
/// along the border of a rank's region, over its area: g(R) = g(2) sqrt(R/2), but no more
/// than there are.
struct Model {
  double kernel = 0, contacts = 0, ghost = 0, ghosts_of_two = 0, latency = 0;

  /// Of the hairs of a rank, ghosts left out.
  double own_cost(double strands, double ranks) const {
    return strands * elements / ranks * (kernel + contacts * strands);
  }
  double cost(double strands, double ranks) const {
    const double ghosts =
        ranks > 1 ? std::min(ghosts_of_two * std::sqrt(ranks / 2), ranks - 1) : 0;
    return own_cost(strands, ranks) * (1 + ghost * ghosts) + latency * std::log2(ranks);
  }
};

/// The measured rows that set the model's numbers; empty if some are missing.
std::vector<const Row*> fitted(const std::vector<Row>& rows, std::string_view effects,
                               int ranks) {
  std::vector<const Row*> found;
  for (const Row& row : rows) {
    if (row.ok() && row.text("kind") == "measured" && row.text("effects") == effects &&
        row.number("ranks") == ranks &&
        std::ranges::find(fitted_strands, static_cast<int>(row.number("strands"))) !=
            std::end(fitted_strands)) {
      found.push_back(&row);
    }
  }
  if (found.size() != std::size(fitted_strands)) found.clear();
  return found;
}

/// The line through two points.
struct Line {
  double slope, offset;
  static Line through(const std::vector<const Row*>& two, const auto& x, const auto& y) {
    const double slope = (y(*two[1]) - y(*two[0])) / (x(*two[1]) - x(*two[0]));
    return {slope, y(*two[0]) - slope * x(*two[0])};
  }
};

std::optional<Model> model_of(const std::vector<Row>& rows, std::string_view effects) {
  const auto one = fitted(rows, effects, 1), two = fitted(rows, effects, 2);
  if (one.empty() || two.empty()) return {};
  const auto strands = [](const Row& row) { return row.number("strands"); };
  const auto per_element = [](const Row& row) {
    return row.number("cost_per_step_s") / (row.number("strands") * elements);
  };
  Model model;
  if (effects == "interaction") {
    const Line line = Line::through(one, strands, per_element);
    model.kernel = line.offset;
    model.contacts = line.slope;
    for (const Row* row : two) {
      model.ghosts_of_two += row->number("ghosts_per_strand") / std::size(fitted_strands);
    }
  } else {
    model.kernel = (per_element(*one[0]) + per_element(*one[1])) / 2;
  }
  // What two ranks take: by their own hairs, and in any case.
  const Line line = Line::through(
      two, [&](const Row& row) { return model.own_cost(row.number("strands"), 2); },
      [](const Row& row) { return row.number("cost_per_step_s"); });
  model.latency = std::max(line.offset, 0.0);
  if (model.ghosts_of_two > 0) model.ghost = (line.slope - 1) / model.ghosts_of_two;
  return model;
}

void predict(std::vector<Row>& rows) {
  for (const char* effects : {"drag", "interaction"}) {
    const std::optional<Model> model = model_of(rows, effects);
    if (!model) continue;
    for (Row& row : rows) {
      if (!row.ok() || row.text("effects") != effects) continue;
      const double n = row.number("strands"), ranks = row.number("ranks");
      // More ranks than cores take turns.
      const double turns =
          row.has("cores") ? std::max(1.0, ranks / row.number("cores")) : 1;
      const double cost = turns * model->cost(n, ranks);
      row.set("model_cost_per_step_s", cost);
      row.set("efficiency", model->cost(n, 1) / (ranks * model->cost(n, ranks)));
      if (row.has("cost_per_step_s")) {
        row.set("model_off_rel", cost / row.number("cost_per_step_s") - 1);
      }
    }
  }
}

void judge(const std::vector<Row>& rows, Verdicts& verdicts) {
  std::map<std::string, std::string> states;
  int compared = 0, different = 0;
  double off = 0, exchange = 0;
  for (const Row& row : rows) {
    if (!row.ok() || row.text("kind") != "measured") continue;
    const auto [first, added] = states.emplace(
        std::string(row.text("effects")) + ' ' + std::string(row.text("strands")),
        std::string(row.text("state")));
    if (!added) {
      ++compared;
      different += first->second != row.text("state") ? 1 : 0;
    }
    if (row.number("ranks") > 2) continue;
    if (row.has("model_off_rel")) {
      off = std::max(off, std::abs(row.number("model_off_rel")));
    }
    if (row.has("exchange_per_element_s")) {
      exchange = std::max(exchange, row.number("exchange_per_element_s"));
    }
  }
  const std::string bits = "any number of ranks gives the same bits";
  if (compared > 0) {
    verdicts.check(bits, different == 0, different);
  } else {
    verdicts.not_judged(bits);
  }
  verdicts.figure("one and two ranks: largest difference of the model, relative", off);
  verdicts.figure("two ranks: largest time to exchange, by own elements, s", exchange);
}

/// Without MPI.
bool finding(const Row& row) { return row.status() == "refused"; }

constexpr Unused unused[] = {{"models", "hairs are super-helices"},
                             {"integrators", "steps are those of semi_implicit_euler"},
                             {"elements", "hairs have ten"},
                             {"repeat", "a row is the mean of its steps"},
                             not_random};

}  // namespace
}  // namespace tress::experiments::divided_heads

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::divided_heads;
  const Experiment experiment{
      .name = "divided_heads",
      .question = "what does a head of hair cost when processes divide it?",
      .example = "--quick",
      .columns = columns,
      .unused = unused,
      .cases = cases,
      .derive = predict,
      .checks = judge,
      .finding = finding};
  return run_experiment(experiment, argc, argv);
}
