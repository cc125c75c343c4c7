#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <exception>
#include <filesystem>
#include <new>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "models/mesh/read_mesh.h"
#include "simulation/files/files.h"
#include "simulation/groom/place_groom.h"
#include "tests/models/mesh/mesh_files.h"
#include "tests/simulation/mutations.h"
#include "tests/support/groom_bytes.h"
#include "tests/support/made_groom.h"

// fuzz_groom SECONDS SEED READER...: spoils files of each reader of grooms (hair, data,
// bin, ply, usda, vtp) and of meshes (mesh.obj, mesh.ply, mesh.stl; all of them if none
// is named) for so much processor time, and reads them. Ends with 1 on anything but what
// the reader returns or an InputError of one line, on more than 2 s of processor time for
// a MB and on more memory than 20 times the file; a crash or a hang (60 s for one file)
// ends it by a signal. The file it failed on is left as fuzz_groom_last.READER.

namespace {

/// Bytes that operator new gave out, now and at most since they were last counted.
struct Heap {
  std::size_t now = 0, most = 0;
} heap;

}  // namespace

void* operator new(std::size_t size) {
  heap.most = std::max(heap.most, heap.now + size);
  void* const place = std::malloc(size);
  if (place == nullptr) throw std::bad_alloc();
  heap.now += malloc_usable_size(place);
  return place;
}
void operator delete(void* place) noexcept {
  if (place != nullptr) heap.now -= malloc_usable_size(place);
  std::free(place);
}
void operator delete(void* place, std::size_t) noexcept { operator delete(place); }

namespace {

using namespace tress;
using namespace tress::simulation;
using testing_support::groom_bytes;
using testing_support::Mutations;

constexpr unsigned hang = 60;                     // s
constexpr double seconds_of_mb = 2, start = 0.5;  // s
// The buffer of a file, and a little of everything.
constexpr std::size_t memory_of_byte = 20, least_memory = 1 << 20;
constexpr std::size_t longest = 1 << 20;
constexpr const char* readers[] = {"hair", "data",     "bin",      "ply",     "usda",
                                   "vtp",  "mesh.obj", "mesh.ply", "mesh.stl"};
bool of_meshes(const std::string& reader) { return reader.starts_with("mesh."); }

/// What the mutations of a USD file begin with: all that its reader knows.
constexpr const char* usd_stage = R"(#usda 1.0
(
    doc = """a stage"""
    metersPerUnit = 0.01
    upAxis = "Y"
    subLayers = [@a.usda@ (offset = 1)]
)
def Xform "head" (
    kind = "group"
    active = true
)
{
    double3 xformOp:translate = (0, 0, 1)
    double3 xformOp:translate:pivot = (0, 1, 0)
    float3 xformOp:rotateXYZ = (0, 10, 0)
    matrix4d xformOp:transform.timeSamples = { 0: ((1, 0, 0, 0), (0, 1, 0, 0), (0, 0, 1, 0), (0, 0, 0, 1)), 1: None }
    uniform token[] xformOpOrder = ["!resetXformStack!", "xformOp:translate", "xformOp:translate:pivot", "xformOp:rotateXYZ", "!invert!xformOp:translate:pivot", "xformOp:transform"]
    token visibility = "inherited"
    def BasisCurves "cubic" (hidden = true)
    {
        uniform token type = "cubic"
        uniform token basis = "catmullRom"
        uniform token wrap = "pinned"
        uniform token purpose = "render"
        int[] curveVertexCounts = [4, 3]
        point3f[] points = [(0, 0, 3), (0, 1, 2), (0, 2, 1), (0, 2, 0), (1, 0, 3), (1, 1, 2), (1, 1, 1e-3)]
        float[] widths = [0.1] (interpolation = "constant")
        rel material:binding = </a/b>
        asset map = @x@</y>
    }
    over "lost" { def BasisCurves "guide" {
        uniform token type = "linear"
        uniform token purpose = "guide"
        int[] curveVertexCounts = [2]
        point3f[] points.timeSamples = { 0: [(0, 0, 0), (1, 1, 1)], 1: [] }
    } }
}
)";

std::vector<std::string> meshes(const std::string& reader) {
  const models::TriangleMesh ball = testing_support::ball(0.1, 1);
  if (reader == "mesh.obj") {
    return {testing_support::as_obj(ball),
            "# a quad, by corner, texture and normal\no a\ng b\nusemtl c\nv 0 0 0\nv 1 0 "
            "0\nv 1 1 0\nv 0 1 0 1\nvt 0 0\nvn 0 0 1\ns off\nf 1/1/1 2//1 -2/1 -1\n"};
  }
  if (reader == "mesh.ply") return {testing_support::as_ply(ball)};
  return {testing_support::as_stl(ball),
          "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex "
          "0 1 0\nendloop\nendfacet\nendsolid a\n"};
}

/// Sound files of a reader.
std::vector<std::string> corpus(const std::string& reader) {
  if (of_meshes(reader)) return meshes(reader);
  testing_support::MadeGroom groom = testing_support::ponytail();
  groom.locks = 2;
  groom.hairs = 2;
  groom.points = 8;
  const Polylines lines = testing_support::made(groom, 3);
  std::vector<std::string> files{groom_bytes(reader, lines)};
  if (reader == "ply") {
    files.push_back(groom_bytes("ply.little", lines));
    files.push_back(groom_bytes("ply.big", lines));
  } else if (reader == "vtp") {
    files.push_back(groom_bytes("vtp.binary", lines));
    files.push_back(groom_bytes("vtp.appended", lines));
  } else if (reader == "usda") {
    files.emplace_back(usd_stage);
  } else if (reader == "hair") {
    // Without its header: counts of segments and points as they are.
    files.push_back(files[0].substr(4, 8) + files[0].substr(128));
  }
  return files;
}

std::string with_bytes(std::string file, Mutations& mutations) {
  constexpr std::uint32_t some[] = {0,          1,          0xff,       0xffff,
                                    0x7fffffff, 0x80000000, 0xffffffff, 0x7fc00000};
  const std::size_t width = std::min<std::size_t>(1 + mutations.pick(4), file.size());
  // Half of all changes in the head of the file, where its sizes are.
  const std::size_t range =
      mutations.pick(2) == 0 ? file.size() : std::min<std::size_t>(file.size(), 200);
  if (width == 0) return file;
  const std::size_t at = std::min(mutations.pick(range), file.size() - width);
  const std::uint32_t x = some[mutations.pick(std::size(some))];
  return file.replace(at, width, reinterpret_cast<const char*>(&x), width);
}

std::string with_a_part_again(std::string file, Mutations& mutations) {
  if (file.empty()) return file;
  const std::size_t at = mutations.pick(file.size());
  const std::string part =
      file.substr(at, 1 + mutations.pick(mutations.pick(4) == 0 ? 2000 : 40));
  const std::size_t times = 1 + mutations.pick(longest / part.size());
  std::string many;
  for (std::size_t i = 0; i < times; ++i) many += part;
  return file.insert(at, many);
}

std::string spoilt(std::string file, Mutations& mutations) {
  for (std::size_t n = 1 + mutations.pick(4); n-- > 0;) {
    const std::size_t how = mutations.pick(200);
    if (how == 0) {
      file = with_a_part_again(std::move(file), mutations);
    } else if (how < 20) {
      file.resize(mutations.pick(file.size() + 1));
    } else if (how < 110 && file.size() < 100'000) {
      file = mutations.spoilt(std::move(file));
    } else {
      file = with_bytes(std::move(file), mutations);
    }
  }
  return file;
}

double processor_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Worst {
  double seconds = 0, seconds_of_mb = 0, memory_of_byte = 0;
};

/// Why the file is a finding; empty: it is none.
template <class Read>
std::string finding(std::size_t size, const Read& read, Worst& worst, bool& refused) {
  const double begun = processor_seconds();
  const std::size_t before = heap.now;
  heap.most = before;
  std::size_t taken = 0;
  std::string why;
  try {
    read([&] { taken = heap.most - before; });
  } catch (const InputError& error) {
    refused = true;
    if (std::string_view(error.what()).find('\n') != std::string_view::npos) {
      why = "a message of several lines";
    }
  } catch (const std::exception& error) {
    why = std::string("not an InputError: ") + error.what();
  }
  if (taken == 0) taken = heap.most - before;
  const double seconds = processor_seconds() - begun,
               mb = static_cast<double>(size) / 1e6;
  worst.seconds = std::max(worst.seconds, seconds);
  if (mb > 0.1) worst.seconds_of_mb = std::max(worst.seconds_of_mb, seconds / mb);
  if (size > 100'000) {
    worst.memory_of_byte = std::max(
        worst.memory_of_byte, static_cast<double>(taken) / static_cast<double>(size));
  }
  if (!why.empty()) return why;
  if (seconds > start + seconds_of_mb * mb) {
    return std::to_string(seconds) + " s for " + std::to_string(mb) + " MB";
  }
  if (taken > least_memory + memory_of_byte * size) {
    return std::to_string(taken) + " bytes of memory for " + std::to_string(size);
  }
  return {};
}

/// Reads a file and uses what it holds. `read`: to be called in between.
template <class Read>
void use_mesh(const std::string& name, const Read& read) {
  const models::TriangleMesh mesh = models::read_mesh(name, 1);
  read();
  const models::ClosedSurface surface(mesh, name);
}
template <class Read>
void use_groom(const std::string& name, const GroomReading& reading, const Read& read) {
  GroomFile file = read_groom(name, reading);
  read();
  GroomPlacing placing;
  placing.bad = reading.bad;
  place_groom(std::move(file), name, placing);
}

/// Whether nothing was found.
bool fuzz(const std::string& reader, int seconds, std::uint64_t seed) {
  const double end = processor_seconds() + seconds;
  Mutations mutations(seed);
  const std::vector<std::string> files = corpus(reader);
  const std::string last = "fuzz_groom_last." + reader;
  Worst worst;
  long read = 0, refusals = 0;
  while (processor_seconds() < end) {
    const std::string file = spoilt(files[mutations.pick(files.size())], mutations);
    std::FILE* const to = std::fopen(last.c_str(), "wb");
    if (to != nullptr) {
      std::fwrite(file.data(), 1, file.size(), to);
      std::fclose(to);
    }
    GroomReading reading;
    if (mutations.pick(2) == 0) reading.bad = BadStrands::drop;
    if (reader == "usda") reading.hidden = mutations.pick(2) == 0;
    ::alarm(hang);
    bool refused = false;
    const std::string why = finding(
        file.size(),
        [&](const auto& read_now) {
          of_meshes(reader) ? use_mesh(last, read_now)
                            : use_groom(last, reading, read_now);
        },
        worst, refused);
    ::alarm(0);
    if (!why.empty()) {
      std::fprintf(stderr, "%s (%s)\n", why.c_str(), last.c_str());
      return false;
    }
    ++read;
    refusals += refused ? 1 : 0;
  }
  std::filesystem::remove(last);
  std::printf(
      ".%s: %ld files, %ld of them refused; at most %.2f s, of files above 0.1 MB %.2f "
      "s/MB "
      "and %.1f bytes of memory for a byte\n",
      reader.c_str(), read, refusals, worst.seconds, worst.seconds_of_mb,
      worst.memory_of_byte);
  std::fflush(stdout);
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  std::vector<std::string> chosen(std::min(argc, 3) + argv, argc + argv);
  if (chosen.empty()) chosen.assign(std::begin(readers), std::end(readers));
  for (const std::string& reader : chosen) {
    if (argc >= 3 && std::ranges::count(readers, reader) > 0) continue;
    std::fputs(
        "usage: fuzz_groom SECONDS SEED "
        "[hair|data|bin|ply|usda|vtp|mesh.obj|mesh.ply|mesh.stl ...]\n",
        stderr);
    return 2;
  }
  const std::uint64_t seed = std::strtoull(argv[2], nullptr, 10);
  for (const std::string& reader : chosen) {
    if (!fuzz(reader, std::atoi(argv[1]), seed)) return 1;
  }
  return 0;
}
