#include <algorithm>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "experiments/run/exit_code.h"
#include "simulation/files/files.h"
#include "tests/fuzz/limited_run.h"
#include "tests/fuzz/random_scene.h"

// extreme_scenes COUNT SEED SIMULATE: runs random legal scenes by the program SIMULATE
// until COUNT of them were not refused, and judges what it wrote of those that it calls
// ok, from the tables alone. A scene that has used 10 s of processor time is stopped by
// SIGINT; one that does not end within a second of it hangs. Ends with 1 on a crash, on a
// hang, on a scene that ends ok with what physics rules out, whose files stay in
// extreme_scenes/, and where more are stopped than 99 of 100 samples have, if one scene
// in fifty is slow.

namespace {

using tress::testing_support::LimitedRun;
using tress::testing_support::random_scene;
using tress::testing_support::RandomScene;
using tress::testing_support::run_limited;

constexpr double limit = 10;       // s of processor time
constexpr double thermal = 4e-21;  // J, kT at room temperature: less is no motion
const std::filesystem::path folder = "extreme_scenes";

/// Columns of numbers by their names.
std::map<std::string, std::vector<double>> columns(const std::string& text) {
  std::istringstream lines(text);
  std::string line, cell;
  std::vector<std::string> names;
  std::map<std::string, std::vector<double>> all;
  while (std::getline(lines, line)) {
    std::istringstream cells(line);
    for (std::size_t i = 0; std::getline(cells, cell, ','); ++i) {
      if (names.size() <= i) {
        names.push_back(cell);
        all[cell];
      } else if (!all.empty() && line.front() != 't') {
        all[names[i]].push_back(cell.empty() ? std::nan("") : std::stod(cell));
      }
    }
  }
  return all;
}

/// Why no strand moves like this; empty: nothing is wrong with it.
std::string nonsense(const RandomScene& scene, const std::string& stem) {
  const auto series = columns(tress::read_file(stem + ".csv"));
  const std::vector<double>& kinetic = series.at("kinetic_j");
  double first = 0, most = 0;
  for (std::size_t i = 0; i < kinetic.size(); ++i) {
    double total = 0;
    for (const auto& [name, values] : series) {
      if (name.ends_with("_j")) total += values[i];
    }
    if (!std::isfinite(total)) return "energy is not finite";
    if (i == 0) first = total;
    most = std::max(most, total - first);
  }
  for (const double stretch : series.at("stretch_rel")) {
    if (!(stretch <= 0.5)) return "stretched by " + std::to_string(stretch);
  }
  double begin = kinetic.front() + series.at("elastic_j").front();
  // A body that a strand begins inside pushes it out.
  if (const auto body = series.find("body_j"); body != series.end()) {
    begin += body->second.front();
  }
  if (scene.passive) {
    if (most > scene.weight_work + 0.1 * begin + thermal) {
      return "energy rises by " + std::to_string(most) +
             " J, m g L = " + std::to_string(scene.weight_work) + " J";
    }
  }
  const double energy =
      (2 * scene.weight_work + 1.1 * begin + thermal) / scene.lightest + scene.worked;
  const double u = std::sqrt(2 * energy) + scene.pushed;
  const double bound = std::sqrt(30.0) * u + scene.carried;
  const auto page = nlohmann::json::parse(tress::read_file(stem + ".json"));
  for (const auto& channel : page["channels"]) {
    if (channel["name"] != "speed") continue;
    if (!(channel["high"].get<double>() <= bound)) {
      return "a point moves at " + channel["high"].dump() + " m/s";
    }
  }
  return {};
}

const char* word_of(const LimitedRun& run) {
  if (run.hung) return "hang";
  switch (run.code) {
    case tress::experiments::done:
      return "ok";
    case tress::experiments::rows_failed:
      return "stated failure";
    case tress::experiments::usage_error:
      return "refused";
    case tress::experiments::interrupted:
      return run.stopped ? "stopped" : "crash";
    default:
      return "crash";
  }
}

void tidy(const std::string& stem) {
  if (std::getenv("EXTREME_SCENES_KEEP") != nullptr) return;
  for (const char* ending :
       {".toml", ".out", ".err", ".csv", ".json", ".meta.json", ".frames", ".state"}) {
    std::filesystem::remove(stem + ending);
  }
}

/// One scene; its outcome in a word.
std::string outcome(std::uint64_t seed, const std::string& simulate) {
  const RandomScene scene = random_scene(seed);
  const std::string stem = (folder / std::to_string(seed)).string();
  std::ofstream(stem + ".toml") << scene.text;
  const LimitedRun run = run_limited(
      {simulate, stem + ".toml", "--progress", "none", "--out", folder.string()}, stem,
      limit);
  std::string word = word_of(run), why;
  try {
    if (word == "ok") why = nonsense(scene, stem);
  } catch (const std::exception& error) {
    why = std::string("its tables cannot be read: ") + error.what();
  }
  if (!why.empty()) word = "silent failure";
  const bool finding = word == "crash" || word == "hang" || word == "silent failure";
  if (finding || word == "stopped") {
    std::printf("%s: seed %llu %s\n", word.c_str(), static_cast<unsigned long long>(seed),
                why.c_str());
    std::fflush(stdout);
  }
  if (!finding) tidy(stem);
  return word;
}

/// How often each outcome was met, from this seed on until `count` scenes were not
/// refused: no scene is begun that those under way may make one too many, so the scenes
/// are the same however many run at once.
std::map<std::string, long> outcomes(long count, std::uint64_t seed,
                                     const std::string& simulate) {
  std::map<std::string, long> met;
  std::mutex mutex;
  std::condition_variable ended;
  std::uint64_t next = seed << 20;
  long legal = 0, running = 0;
  const auto work = [&] {
    std::unique_lock lock(mutex);
    while (true) {
      ended.wait(lock, [&] { return legal == count || legal + running < count; });
      if (legal == count) return;
      ++running;
      const std::uint64_t mine = next++;
      lock.unlock();
      const std::string word = outcome(mine, simulate);
      lock.lock();
      --running;
      ++met[word];
      if (word != "refused") ++legal;
      ended.notify_all();
    }
  };
  {
    std::vector<std::jthread> threads(std::max(1u, std::thread::hardware_concurrency()));
    for (std::jthread& thread : threads) thread = std::jthread(work);
  }
  return met;
}

/// The number of slow scenes that 99 of 100 samples of `count` scenes do not exceed, if
/// one scene in fifty is slow.
long most_slow(long count) {
  constexpr double rate = 1. / 50, sure = 0.99;
  double probability = std::pow(1 - rate, count), sum = probability;
  long slow = 0;
  while (sum < sure && slow < count) {
    probability *= rate / (1 - rate) * double(count - slow) / double(slow + 1);
    sum += probability;
    ++slow;
  }
  return slow;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: extreme_scenes COUNT SEED SIMULATE\n", stderr);
    return 2;
  }
  try {
    std::filesystem::create_directories(folder);
    auto met = outcomes(std::atol(argv[1]), std::strtoull(argv[2], nullptr, 10), argv[3]);
    long legal = 0;
    for (const auto& [word, times] : met) {
      std::printf("%6ld %s\n", times, word.c_str());
      if (word != "refused") legal += times;
    }
    std::printf("%6ld legal\n", legal);
    const long found = met["crash"] + met["hang"] + met["silent failure"];
    return found > 0 || met["stopped"] > most_slow(legal) ? 1 : 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "extreme_scenes: %s\n", error.what());
    return 1;
  }
}
