#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "simulation/files/files.h"
#include "simulation/scene/scene.h"
#include "tests/simulation/mutations.h"

// fuzz_scene SECONDS SEED FOLDER: spoils the scenes of a folder, again and again, and
// reads them. Ends with 1 on anything but a scene or an InputError; a crash or a hang (10
// s for one scene) ends it by a signal. The text it failed on is left in
// fuzz_scene_last.toml.

namespace {

constexpr unsigned hang = 10;  // s

std::vector<std::string> corpus(const char* folder) {
  std::vector<std::string> texts;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    if (entry.path().extension() == ".toml") {
      texts.push_back(tress::read_file(entry.path().string()));
    }
  }
  return texts;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 4) {
    std::fputs("usage: fuzz_scene SECONDS SEED FOLDER\n", stderr);
    return 2;
  }
  using Clock = std::chrono::steady_clock;
  const auto end = Clock::now() + std::chrono::seconds(std::atoi(argv[1]));
  tress::testing_support::Mutations mutations(std::strtoull(argv[2], nullptr, 10));
  const std::vector<std::string> texts = corpus(argv[3]);
  if (texts.empty()) {
    std::fprintf(stderr, "no scenes in %s\n", argv[3]);
    return 2;
  }
  const std::string last = "fuzz_scene_last.toml";
  long read = 0, refused = 0;
  while (Clock::now() < end) {
    std::string text = texts[mutations.pick(texts.size())];
    for (std::size_t n = 1 + mutations.pick(6); n-- > 0;) text = mutations.spoilt(text);
    std::FILE* file = std::fopen(last.c_str(), "wb");
    if (file != nullptr) {
      std::fwrite(text.data(), 1, text.size(), file);
      std::fclose(file);
    }
    ::alarm(hang);
    try {
      tress::simulation::parse_scene(text, last);
      ++read;
    } catch (const tress::InputError&) {
      ++refused;
    } catch (const std::exception& error) {
      std::fprintf(stderr, "not an InputError: %s (%s)\n", error.what(), last.c_str());
      return 1;
    }
    ::alarm(0);
  }
  std::filesystem::remove(last);
  std::printf("%ld scenes, %ld of them refused\n", read + refused, refused);
}
