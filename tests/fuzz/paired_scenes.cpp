#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "experiments/run/exit_code.h"
#include "tests/fuzz/limited_run.h"
#include "tests/fuzz/pair_tables.h"
#include "tests/fuzz/random_head.h"

// paired_scenes COUNT SEED SIMULATE SECONDS [FOLDER]: runs random scenes, and first the
// files of FOLDER, by the program SIMULATE as one batch and strand by strand, until COUNT
// of them could be compared; runs of more than SECONDS of processor time are left out.
// Both must come to the same verdict, fail in the same strands for the same reason, and
// have the same positions in all frames, the same energies and the same numbers in every
// column that both tables have. Ends with 1 if some pair does not; its files stay in
// paired_runs/.
//
// Replicated systems are the same bits as strands that are systems of their own, which
// those are that stay where they fail, and that do not touch; other times of exchanges,
// and Newton's iterations of strands in lanes, differ by less than
constexpr double newton = 1e-6;
// Frames are written in single precision. Where more than this is between them, the scene
// itself must be as sensitive: a change of
constexpr double nearby = 1e-9;
// of all lengths and moduli must move strands by a hundredth of the difference. Lanes
// differ from strands by less than that change a hundred times: Newton's method ends at
// 1e-10 of the typical coordinates.
constexpr double amplified = 100;
// Strands that choose their steps end them at other times in lanes, to
constexpr double tolerance = 1e-3;
// of the largest energy of the run, as their own error. Strands that take a step again in
// shorter ones are no longer the same steps: only their verdicts are compared. A strand
// by itself has more ways to solve a step than a batch has (integrators/stage/stage.h): a
// batch that prints that it found no solution is counted, but is no finding. The
// equations of a long step may have several solutions, as where hairs start deep in a
// body, and either way takes one of them: where motions differ, both must come to the
// same one with a sixteenth of the step.

namespace {

using namespace tress::testing_support;

const std::filesystem::path folder = "paired_runs";

struct Outcome {
  LimitedRun run;
  std::string stem, said;
  bool replicated = false;

  Columns table() const { return columns(stem + ".csv"); }
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
  std::filesystem::remove(made.stem + ".failed.csv");
  made.run = run_limited({program.simulate, scene, "--as", as, "--progress", "none",
                          "--frames", "none", "--export", "usd", "--out", here.string()},
                         made.stem, program.seconds);
  std::ifstream err(made.stem + ".err");
  for (std::string line; std::getline(err, line);) {
    made.replicated = made.replicated || line.find("replicated") != std::string::npos;
    if (line.find(" simulated in ") != std::string::npos) made.said = line;
  }
  return made;
}

/// Everything that both runs write, in their first `rows` frames; points where both have
/// come to their end.
Apart compared(const Outcome& batch, const Outcome& strands, std::size_t rows) {
  Apart found = apart(batch.table(), strands.table(), rows);
  if (rows == batch.table()["t_s"].size()) {
    found.points = points_apart(batch.stem + ".usda", strands.stem + ".usda");
  }
  return found;
}
Apart compared(const Outcome& batch, const Outcome& strands) {
  return compared(batch, strands, strands.table()["t_s"].size());
}

/// Makes a scene beside it whose lines `change` has seen.
template <class Change>
std::string altered(const std::string& scene, const char* word, Change change) {
  const std::filesystem::path file = scene;
  const std::string made =
      (folder / (file.stem().string() + "." + word + ".toml")).string();
  std::ifstream lines(scene);
  std::ofstream out(made);
  for (std::string line; std::getline(lines, line);) {
    const std::size_t value = line.find_first_of("0123456789");
    for (const auto& [key, factor] : change) {
      if (!line.starts_with(key) || value == std::string::npos) continue;
      line = fmt::format("{} = {:.17g}", key, std::stod(line.substr(value)) * factor);
      break;
    }
    out << line << '\n';
  }
  return made;
}

using Change = std::vector<std::pair<std::string, double>>;

/// Whether strands that are a little longer and stiffer move as far from these as the
/// batch does.
bool as_sensitive(const std::string& scene, const Program& simulate,
                  const Outcome& strands, double off) {
  const std::string other = altered(
      scene, "near", Change{{"length_m", 1 + nearby}, {"youngs_modulus_pa", 1 + nearby}});
  const Outcome near = run(other, simulate, "strands");
  if (near.run.code != strands.run.code) return true;
  const double moved = compared(near, strands).most();
  std::printf("  %.2g of strands that differ by %.2g\n", moved, nearby);
  return off <= amplified * moved;
}

constexpr const char* several_solutions =
    "agree with shorter steps: the long ones have several solutions";

/// Whether the scene says so.
bool has(const std::string& scene, std::string_view words) {
  std::ifstream file(scene);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  return text.find(words) != std::string::npos;
}

/// As different_failures(), with the time of a frame for lanes, whose states are judged
/// with every frame at least. Systems of their own are judged at the steps of strands.
std::string other_failures(const Outcome& batch, const Outcome& strands) {
  const std::vector<Failure> all = failures_of(batch.stem + ".failed.csv"),
                             alone = failures_of(strands.stem + ".failed.csv");
  const std::vector<double> t = batch.table()["t_s"];
  const double frame = t.size() > 1 ? t[1] - t[0] : 0;
  if (alone.empty()) {
    return different_failures(all, {failure_in(strands.said)},
                              batch.replicated ? 0 : frame);
  }
  if (batch.replicated && alone.size() != all.size()) return "other strands fail";
  return different_failures(all, alone, batch.replicated ? 0 : frame);
}

/// Frames before any strand failed.
std::size_t sound_frames(const Outcome& batch, const Outcome& strands) {
  double first = HUGE_VAL;
  for (const Failure& one : failures_of(batch.stem + ".failed.csv")) {
    first = std::min(first, one.t);
  }
  first = std::min(
      first, failure_in(strands.said).some() ? failure_in(strands.said).t : HUGE_VAL);
  const std::vector<double> t = strands.table()["t_s"];
  return static_cast<std::size_t>(
      std::ranges::count_if(t, [&](double at) { return at < first; }));
}

/// Whether both come to the same motion in a sixteenth of the step, or fail in the same
/// strands.
bool same_with_short_steps(const std::string& scene, const Program& simulate) {
  const std::string finer = altered(scene, "short", Change{{"dt_s", 1. / 16}});
  const Outcome batch = run(finer, simulate, "batch"),
                strands = run(finer, simulate, "strands");
  if (batch.run.code != strands.run.code) return false;
  std::size_t frames = strands.table()["t_s"].size();
  if (strands.run.code != tress::experiments::done) {
    if (strands.run.code != tress::experiments::rows_failed) return false;
    if (!other_failures(batch, strands).empty()) return false;
    frames = sound_frames(batch, strands);
  }
  const double off = compared(batch, strands, frames).most();
  std::printf("  %.2g with a sixteenth of the step\n", off);
  return off <= tolerance;
}

/// Of two runs that came to their end, or failed in the same way.
std::string verdict_of_motion(const std::string& scene, const Program& simulate,
                              const Outcome& batch, const Outcome& strands) {
  const bool ended = strands.run.code == tress::experiments::done;
  // Strands that fail and do not stay end the run; others leave the energies.
  const bool stays = ended || std::filesystem::exists(strands.stem + ".failed.csv");
  const Apart found = stays ? compared(batch, strands)
                            : compared(batch, strands, sound_frames(batch, strands));
  const std::string how = ended ? "agree" : "agree: both fail";
  std::printf("  energies %.2g, points %.2g, means %.2g\n", found.energy, found.points,
              found.place);
  if (!found.unequal.empty() && (batch.replicated || ended)) {
    return "DIFFER: column " + found.unequal;
  }
  const double off = found.most();
  const bool bits = batch.replicated && !has(scene, "strand_interaction") &&
                    has(scene, "failed_strands = \"stay\"");
  if (bits) {
    return off == 0 ? how + " to the last bit" : "DIFFER: bits";
  }
  if (off <= newton) return how + " to 1e-6";
  const bool chooses = has(scene, "position_tol_rel") || has(scene, "rtol");
  if (chooses && off <= tolerance) return how + " to 1e-3, steps by tolerance";
  if (as_sensitive(scene, simulate, strands, off)) return how + ", a sensitive motion";
  if (!chooses && same_with_short_steps(scene, simulate)) return several_solutions;
  return "DIFFER: motion";
}

/// What came of a pair in words; "agree ...", "refused", or a finding.
std::string verdict(const std::string& scene, const Program& simulate) {
  using namespace tress::experiments;
  const Outcome batch = run(scene, simulate, "batch"),
                strands = run(scene, simulate, "strands");
  for (const Outcome* one : {&batch, &strands}) {
    if (one->run.code != usage_error) continue;
    if (batch.run.code == strands.run.code) return "refused";
    return one == &batch ? "refused as a batch" : "DIFFER: refused strand by strand";
  }
  for (const Outcome* one : {&batch, &strands}) {
    if (one->run.stopped) return "stopped";
    if (one->run.code != done && one->run.code != rows_failed) return "CRASH";
  }
  if (!batch.replicated && strands.run.code == done &&
      batch.said.find("no solution") != std::string::npos) {
    return "limit: the batch finds no solution of a step";
  }
  if (batch.run.code != strands.run.code) {
    if (!batch.replicated && same_with_short_steps(scene, simulate)) {
      return several_solutions;
    }
    std::printf("  batch:   %s\n  strands: %s\n", batch.said.c_str(),
                strands.said.c_str());
    return batch.run.code == done ? "DIFFER: batch goes on, strands fail"
                                  : "DIFFER: batch fails, strands go on";
  }
  if (batch.run.code == rows_failed) {
    if (const std::string other = other_failures(batch, strands); !other.empty()) {
      std::printf("  batch:   %s\n  strands: %s\n", batch.said.c_str(),
                  strands.said.c_str());
      if (!batch.replicated && same_with_short_steps(scene, simulate)) {
        return several_solutions;
      }
      return "DIFFER: " + other;
    }
  }
  const std::vector<double> again = strands.table()["rejected_steps"];
  if (!batch.replicated && std::ranges::any_of(again, [](double n) { return n > 0; })) {
    return "agree: both end alike, strands by shorter steps";
  }
  return verdict_of_motion(scene, simulate, batch, strands);
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
      if (!word.starts_with("refused") && word != "stopped") ++compared;
    }
    for (const auto& [word, times] : met) std::printf("%6ld %s\n", times, word.c_str());
    return found ? 1 : 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "paired_scenes: %s\n", error.what());
    return 1;
  }
}
