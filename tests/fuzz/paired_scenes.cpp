#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>
#include <string>
#include <vector>

#include "experiments/run/exit_code.h"
#include "tests/fuzz/limited_run.h"
#include "tests/fuzz/random_head.h"

// paired_scenes COUNT SEED SIMULATE SECONDS [FOLDER]: runs random scenes, and first the
// files of FOLDER, by the program SIMULATE as one head of hair and strand by strand,
// until COUNT of them could be compared; runs of more than SECONDS of processor time are
// left out. Both must come to the same verdict, and where both go on to the end, to the
// same energies, those of effects included, and the same number of failed strands. Ends
// with 1 if some pair does not; its files stay in paired_scenes/.
//
// Replicated systems are the same bits as strands that are systems of their own, which
// those are that stay where they fail, and that do not touch; other times of exchanges,
// and Newton's iterations of four strands at once, differ by less than
constexpr double newton = 1e-6;
// Energies of lanes: the points of an element are those of any strand's need in a head,
// and agree with the strand's own to 1e-8 (models::quadrature_points); motions that are
// not smooth, as of strands that hit bodies, amplify this. A head that loses digits or a
// load differs by percents. Between them lies
constexpr double tolerance = 1e-3;
// of the largest energy of the run. Strands that take a step again in shorter ones are no
// longer the same steps: only their verdicts are compared. A strand by itself has more
// ways to solve a step than a head has (integrators/stage/stage.h): a head that says that
// it found no solution is counted, but is no finding. The equations of a long step may
// have several solutions, as where hairs start deep in a body, and either way takes one
// of them: where energies differ, both must come to the same ones with a sixteenth of the
// step.

namespace {

using tress::testing_support::LimitedRun;
using tress::testing_support::run_limited;

constexpr double thermal = 4e-21;  // J, kT at room temperature: less is no motion
const std::filesystem::path folder = "paired_runs";

using Columns = std::map<std::string, std::vector<double>>;
Columns columns(const std::string& file) {
  std::ifstream lines(file);
  std::string line, cell;
  std::vector<std::string> names;
  Columns all;
  while (std::getline(lines, line)) {
    const bool heads = names.empty();
    std::istringstream cells(line);
    for (std::size_t i = 0; std::getline(cells, cell, ','); ++i) {
      if (heads) {
        names.push_back(cell);
      } else {
        all[names.at(i)].push_back(cell.empty() ? std::nan("") : std::stod(cell));
      }
    }
  }
  return all;
}

struct Outcome {
  LimitedRun run;
  std::string stem, said;
  bool replicated = false;
};

struct Program {
  std::string simulate;
  double seconds;  // of processor time
};

Outcome run(const std::string& scene, const Program& program, const char* as) {
  const std::filesystem::path here = folder / as;
  std::filesystem::create_directories(here);
  Outcome made;
  made.stem = (here / std::filesystem::path(scene).stem()).string();
  made.run = run_limited({program.simulate, scene, "--as", as, "--progress", "none",
                          "--frames", "none", "--out", here.string()},
                         made.stem, program.seconds);
  std::ifstream err(made.stem + ".err");
  for (std::string line; std::getline(err, line);) {
    made.replicated = made.replicated || line.find("replicated") != std::string::npos;
    made.said = line;
  }
  return made;
}

/// Largest difference of an energy that both have over the largest one. What a head calls
/// gravity's is that of all uniform loads.
double apart(const Columns& head, const Columns& strands) {
  double most = 0, scale = thermal;
  for (const auto& [name, other] : strands) {
    if (!name.ends_with("_j") || !head.contains(name)) continue;
    if (name == "gravity_j" && strands.contains("constant_force_j")) continue;
    const std::vector<double>& one = head.at(name);
    if (one.size() != other.size()) return HUGE_VAL;
    for (std::size_t i = 0; i < one.size(); ++i) {
      const double off = std::abs(one[i] - other[i]);
      if (!std::isfinite(off)) return HUGE_VAL;
      most = std::max(most, off);
      scale = std::max(scale, std::abs(other[i]));
    }
  }
  return most / scale;
}

/// The scene with a sixteenth of its step, beside it.
std::string with_short_steps(const std::string& scene) {
  const std::string key = "dt_s = ";
  const std::filesystem::path file = scene;
  const std::string made = (folder / (file.stem().string() + ".short.toml")).string();
  std::ifstream lines(scene);
  std::ofstream out(made);
  for (std::string line; std::getline(lines, line);) {
    if (line.starts_with(key)) {
      line = key + std::to_string(std::stod(line.substr(key.size())) * 1e6 / 16) + "e-6";
    }
    out << line << '\n';
  }
  return made;
}

bool same_with_short_steps(const std::string& scene, const Program& simulate) {
  const std::string finer = with_short_steps(scene);
  const Outcome head = run(finer, simulate, "batch"),
                strands = run(finer, simulate, "strands");
  if (head.run.code != 0 || strands.run.code != 0) return false;
  const double off = apart(columns(head.stem + ".csv"), columns(strands.stem + ".csv"));
  std::printf("  %.2g with a sixteenth of the step\n", off);
  return off <= tolerance;
}

constexpr const char* several_solutions =
    "agree with shorter steps: the long ones have several solutions";

/// Whether the scene says so.
bool has(const std::string& scene, std::string_view words) {
  std::ifstream file(scene);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  return text.find(words) != std::string::npos;
}

/// A run of strands that fail and do not stay has no further frames.
std::string verdict_of_replicated(const std::string& scene, int code, const Columns& head,
                                  const Columns& strands) {
  if (!strands.contains("failed_strands")) {
    if (code != tress::experiments::done) return "agree: both fail, replicated";
  } else if (head.at("failed_strands") != strands.at("failed_strands")) {
    return "DIFFER: other strands fail";
  }
  const double off = apart(head, strands);
  const bool bits =
      strands.contains("failed_strands") && !has(scene, "strand_interaction");
  std::printf("  %.2g%s\n", off, bits ? " of the same bits" : "");
  if (!(off <= (bits ? 0 : newton))) return "DIFFER: energies of replicated systems";
  return bits ? "agree to the last bit, replicated" : "agree to 1e-6, replicated";
}

/// What came of a pair in words; "agree ...", "refused", or a finding.
std::string verdict(const std::string& scene, const Program& simulate) {
  using namespace tress::experiments;
  const Outcome head = run(scene, simulate, "batch"),
                strands = run(scene, simulate, "strands");
  for (const Outcome* one : {&head, &strands}) {
    if (one->run.code == usage_error) return "refused";
    if (one->run.stopped) return "stopped";
    if (one->run.code != done && one->run.code != rows_failed) return "CRASH";
  }
  if (!head.replicated && strands.run.code == done &&
      head.said.find("no solution") != std::string::npos) {
    return "limit: the head finds no solution of a step";
  }
  if (head.run.code != strands.run.code && !head.replicated &&
      same_with_short_steps(scene, simulate)) {
    return several_solutions;
  }
  if (head.run.code != strands.run.code) {
    std::printf("  head:    %s\n  strands: %s\n", head.said.c_str(),
                strands.said.c_str());
    return head.run.code == done ? "DIFFER: head goes on, strands fail"
                                 : "DIFFER: head fails, strands go on";
  }
  const Columns of_head = columns(head.stem + ".csv"),
                of_strands = columns(strands.stem + ".csv");
  if (head.replicated)
    return verdict_of_replicated(scene, head.run.code, of_head, of_strands);
  if (head.run.code == rows_failed) return "agree: both fail";
  const auto& again = of_strands.at("rejected_steps");
  if (std::any_of(again.begin(), again.end(), [](double n) { return n > 0; })) {
    return "agree: both go on, strands by shorter steps";
  }
  const double off = apart(of_head, of_strands);
  std::printf("  %.2g\n", off);
  if (!(off <= tolerance)) {
    return same_with_short_steps(scene, simulate) ? several_solutions
                                                  : "DIFFER: energies";
  }
  return off <= 1e-6 ? "agree to 1e-6" : "agree to 1e-3";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 5 && argc != 6) {
    std::fputs("usage: paired_scenes COUNT SEED SIMULATE SECONDS [FOLDER]\n", stderr);
    return 2;
  }
  try {
    std::filesystem::create_directories(folder);
    std::map<std::string, long> met;
    bool found = false;
    const Program program{argv[3], std::atof(argv[4])};
    if (!(program.seconds > 0)) {
      std::fprintf(stderr, "paired_scenes: SECONDS is \"%s\": give a positive number\n",
                   argv[4]);
      return 2;
    }
    const auto judge = [&](const std::string& scene) {
      std::printf("%s\n", scene.c_str());
      std::fflush(stdout);
      const std::string word = verdict(scene, program);
      std::printf("  %s\n", word.c_str());
      ++met[word];
      found = found || word.starts_with("DIFFER") || word == "CRASH";
      return word;
    };
    if (argc == 6) {
      std::vector<std::string> files;
      for (const auto& entry : std::filesystem::directory_iterator(argv[5])) {
        files.push_back(entry.path().string());
      }
      std::ranges::sort(files);
      for (const std::string& file : files) judge(file);
    }
    std::uint64_t seed = std::strtoull(argv[2], nullptr, 10) << 20;
    for (long compared = 0; compared < std::atol(argv[1]); ++seed) {
      const std::string scene = (folder / (std::to_string(seed) + ".toml")).string();
      std::ofstream(scene) << tress::testing_support::random_head(seed);
      const std::string word = judge(scene);
      if (word != "refused" && word != "stopped") ++compared;
    }
    for (const auto& [word, times] : met) std::printf("%6ld %s\n", times, word.c_str());
    return found ? 1 : 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "paired_scenes: %s\n", error.what());
    return 1;
  }
}
