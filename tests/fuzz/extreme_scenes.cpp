#include <sys/wait.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <fstream>
#include <future>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <thread>
#include <vector>

#include "experiments/harness/files.h"
#include "tests/fuzz/random_scene.h"

// extreme_scenes COUNT SEED SIMULATE: runs random legal scenes by the program SIMULATE
// until COUNT of them were not refused, and judges what it wrote of those that it calls
// ok, from the tables alone. Every scene has 10 s. Ends with 1 on a crash and on a scene
// that ends ok with what physics rules out; their files stay in extreme_scenes/.

namespace {

using tress::testing_support::random_scene;
using tress::testing_support::RandomScene;

constexpr int seconds = 10;
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
  const double begin = kinetic.front() + series.at("elastic_j").front();
  if (scene.passive) {
    if (most > scene.weight_work + 0.1 * begin + thermal) {
      return "energy rises by " + std::to_string(most) +
             " J, m g L = " + std::to_string(scene.weight_work) + " J";
    }
  }
  const double energy =
      (2 * scene.weight_work + 1.1 * begin) / scene.lightest + scene.worked;
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

/// One scene; its outcome in a word.
std::string outcome(std::uint64_t seed, const std::string& simulate) {
  const RandomScene scene = random_scene(seed);
  const std::string stem = (folder / std::to_string(seed)).string();
  std::ofstream(stem + ".toml") << scene.text;
  const std::string command = "timeout -k 5 " + std::to_string(seconds) + " " + simulate +
                              " " + stem + ".toml --progress none --out " +
                              folder.string() + " >" + stem + ".out 2>" + stem + ".err";
  const int status = std::system(command.c_str());
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 255;
  std::string word = code == 0                    ? "ok"
                     : code == 3                  ? "stated failure"
                     : code == 2                  ? "refused"
                     : code == 124 || code == 137 ? "out of time"
                                                  : "crash";
  std::string why;
  if (word == "ok") why = nonsense(scene, stem);
  if (!why.empty()) word = "silent failure";
  if (word == "crash" || word == "silent failure") {
    std::printf("%s: seed %llu, %s %s\n", word.c_str(),
                static_cast<unsigned long long>(seed), why.c_str(), stem.c_str());
    std::fflush(stdout);
    return word;
  }
  if (std::getenv("EXTREME_SCENES_KEEP") == nullptr) {
    for (const char* ending :
         {".toml", ".out", ".err", ".csv", ".json", ".meta.json", ".frames", ".state"}) {
      std::filesystem::remove(stem + ending);
    }
  }
  return word;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: extreme_scenes COUNT SEED SIMULATE\n", stderr);
    return 2;
  }
  try {
    std::filesystem::create_directories(folder);
    const long count = std::atol(argv[1]);
    std::uint64_t seed = std::strtoull(argv[2], nullptr, 10) << 20;
    std::map<std::string, long> outcomes;
    const unsigned jobs = std::max(1u, std::thread::hardware_concurrency());
    for (long legal = 0; legal < count;) {
      std::vector<std::future<std::string>> running;
      for (unsigned job = 0; job < jobs; ++job) {
        running.push_back(
            std::async(std::launch::async, outcome, seed++, std::string(argv[3])));
      }
      for (auto& one : running) {
        const std::string word = one.get();
        ++outcomes[word];
        if (word != "refused") ++legal;
      }
    }
    for (const auto& [word, times] : outcomes) {
      std::printf("%6ld %s\n", times, word.c_str());
    }
    return outcomes["crash"] + outcomes["silent failure"] > 0 ? 1 : 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "extreme_scenes: %s\n", error.what());
    return 1;
  }
}
