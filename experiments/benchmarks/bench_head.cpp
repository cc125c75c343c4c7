// Heads of hair: what a step of a strand costs as a multiple of the reference kernel, in
// the cache and out of it, and a head of 200 000 strands.
#include <fmt/format.h>

#include <algorithm>
#include <functional>
#include <optional>
#include <vector>

#include "experiments/benchmarks/fixture.h"
#include "experiments/benchmarks/reference_strands.h"
#include "models/effects/body.h"
#include "simulation/head/head_run.h"
#include "simulation/head/make_head.h"
#include "simulation/run/timing.h"

namespace tress::experiments::benchmarks {
namespace {

using models::Head;
using models::HeadNumber;
using models::HeadPack;

constexpr int elements = reference_elements;
constexpr double length = reference_length, h = reference_step;  // m, s

using Make = std::unique_ptr<Head> (*)(const simulation::HeadOptions&, const HeadPack&);

std::unique_ptr<Head> head(
    std::size_t strands, HeadPack pack, double drag, Make make = simulation::helix_head,
    simulation::HeadMethod method = simulation::HeadMethod::linearly_implicit_euler) {
  simulation::HeadOptions options;
  options.method = method;
  options.elements = elements;
  options.drag = drag;
  options.longest = length;
  auto made = make(options, pack);
  made->reserve(strands);
  for (std::size_t k = 0; k < strands; ++k) made->add(reference_hair(k));
  return made;
}

/// Hair combed down on an ellipsoid, which is `away` from it (m) or, without a number,
/// not there.
std::unique_ptr<Head> combed(std::size_t strands, HeadPack pack,
                             std::optional<double> away, Make make) {
  const Vec axes{0.08, 0.1, 0.12};
  simulation::HeadOptions options;
  options.elements = elements;
  options.drag = 5e-5;
  options.longest = length;
  if (away) {
    options.effects = {std::make_shared<models::Body>(
        models::Ellipsoid(axes), models::StrandPlace{{*away, 0, 0}, {}},
        models::BodyContact{
            .stiffness = 10, .damping = 1, .friction = 0.3, .offset = 4e-5})};
  }
  auto made = make(options, pack);
  made->reserve(strands);
  for (std::size_t k = 0; k < strands; ++k) {
    // Over the upper half, neighbours in height side by side.
    const double up = 1 - (static_cast<double>(k) + 0.5) / static_cast<double>(strands);
    const double out = std::sqrt(1 - up * up),
                 turn = 2.399963229728653 * static_cast<double>(k);
    const Vec x{axes.x * out * std::cos(turn), axes.y * out * std::sin(turn),
                axes.z * up};
    const Vec slope{x.x / (axes.x * axes.x), x.y / (axes.y * axes.y),
                    x.z / (axes.z * axes.z)};
    const Vec normal = 1 / norm(slope) * slope;
    const Vec level = cross(normal, {0, 0, 1});
    const Vec e2 = 1 / norm(level) * level;
    const Vec uphill = cross(e2, normal);
    const Vec tangent = std::sqrt(0.5) * (normal - uphill);
    models::Strand one = reference_hair(k);
    one.root.position = x;
    one.root.frame = {tangent, cross(e2, tangent), e2};
    made->add(one);
  }
  return made;
}

struct Stepping {
  std::unique_ptr<Head> head;
  std::unique_ptr<Head::Scratch> scratch = head->scratch();
  double dt = h, t = 0;  // s
  void step() {
    head->step(0, head->blocks(), t, dt, *scratch);
    t += dt;
  }
};

struct Line {
  std::string_view name;
  HeadPack pack;
  std::size_t strands;
  double drag;
  double most;  // times the reference
  Make make = simulation::helix_head;
};
constexpr Line lines[] = {
    {"4 of 64 bits", {HeadNumber::float64, 4}, 64, 0, 1.2},
    {"4 of 64 bits", {HeadNumber::float64, 4}, 4096, 0, 1.3},
    {"4 of 64 bits, drag", {HeadNumber::float64, 4}, 64, 2e-5, 1.56},
    {"8 of 64 bits", {HeadNumber::float64, 8}, 64, 0, 0.7},
    {"8 of 32 bits", {HeadNumber::float32, 8}, 64, 0, 0.55},
    {"16 of 32 bits", {HeadNumber::float32, 16}, 64, 0, 0.35},
    {"clothoid, 1 of 64 bits",
     {HeadNumber::float64, 1},
     64,
     0,
     90,
     simulation::clothoid_head},
    {"clothoid, 8 of 64 bits",
     {HeadNumber::float64, 8},
     64,
     0,
     30,
     simulation::clothoid_head},
    {"chain, 4 of 64 bits", {HeadNumber::float64, 4}, 64, 0, 0.6, simulation::chain_head},
    {"chain, 4 of 64 bits",
     {HeadNumber::float64, 4},
     4096,
     0,
     0.6,
     simulation::chain_head},
    {"chain, 8 of 64 bits", {HeadNumber::float64, 8}, 64, 0, 0.4, simulation::chain_head},
    {"chain, 8 of 64 bits",
     {HeadNumber::float64, 8},
     4096,
     0,
     0.4,
     simulation::chain_head},
    {"chain, 8 of 32 bits", {HeadNumber::float32, 8}, 64, 0, 0.3, simulation::chain_head},
    {"chain, 8 of 32 bits",
     {HeadNumber::float32, 8},
     4096,
     0,
     0.3,
     simulation::chain_head},
    {"chain, 16 of 32 bits",
     {HeadNumber::float32, 16},
     64,
     0,
     0.2,
     simulation::chain_head},
    {"chain, 16 of 32 bits",
     {HeadNumber::float32, 16},
     4096,
     0,
     0.2,
     simulation::chain_head},
    {"der, 4 of 64 bits", {HeadNumber::float64, 4}, 64, 0, 1.5, simulation::der_head},
    {"der, 4 of 64 bits", {HeadNumber::float64, 4}, 4096, 0, 1.5, simulation::der_head},
    {"der, 8 of 64 bits", {HeadNumber::float64, 8}, 64, 0, 1.5, simulation::der_head},
    {"der, 16 of 32 bits", {HeadNumber::float32, 16}, 64, 0, 1.5, simulation::der_head},
    {"springs, 4 of 64 bits",
     {HeadNumber::float64, 4},
     64,
     0,
     1,
     simulation::spring_head},
    {"springs, 4 of 64 bits",
     {HeadNumber::float64, 4},
     4096,
     0,
     1,
     simulation::spring_head},
    {"springs, 8 of 64 bits",
     {HeadNumber::float64, 8},
     64,
     0,
     1,
     simulation::spring_head}};

void register_all() {
  benchmark::RegisterBenchmark("reference/64", [](benchmark::State& state) {
    ReferenceStrands kernel(64);
    for ([[maybe_unused]] auto _ : state) kernel.step();
    count_per_element(state, 64 * elements);
  });
  for (const Line& line : lines) {
    benchmark::RegisterBenchmark(
        fmt::format("step/{}/{}", line.name, line.strands).c_str(),
        [line](benchmark::State& state) {
          Stepping of{head(line.strands, line.pack, line.drag, line.make)};
          for ([[maybe_unused]] auto _ : state) of.step();
          count_per_element(state, static_cast<int>(line.strands) * elements);
        });
  }
}

/// The reference moves as heads do: the same motion, to the error of its shorter series.
bool same_motion() {
  ReferenceStrands kernel(64);
  Stepping of{head(64, {HeadNumber::float64, 4}, 0)};
  for (int s = 0; s < 20; ++s) {
    kernel.step();
    of.step();
  }
  std::vector<double> q(3 * elements), v(3 * elements);
  double most = 0;
  for (std::size_t k = 0; k < 64; ++k) {
    of.head->state(k, q, v);
    for (std::size_t i = 0; i < elements; ++i) {
      most =
          std::max(most, std::abs(q[3 * i + 1] - kernel.curvature(k, i)) / q[3 * i + 1]);
    }
  }
  return kept("heads", "the reference, its relative difference from a head,", most, 1e-2);
}

bool costs_met() {
  bool met = true;
  for (const Line& line : lines) {
    ReferenceStrands kernel(line.strands);
    Stepping of{head(line.strands, line.pack, line.drag, line.make)};
    const int repeat = static_cast<int>(40960 / line.strands);
    const auto repeated = [repeat](auto& what) {
      return [&what, repeat] {
        for (int i = 0; i < repeat; ++i) what.step();
      };
    };
    met = kept("heads",
               fmt::format("{}, {} strands, over the reference", line.name, line.strands),
               time_ratio(repeated(of), repeated(kernel)), line.most) &&
          met;
  }
  return met;
}

/// Steps with all derivatives of the residual: of an iteration of Newton's method, which
/// is a step of linearly_implicit_midpoint.
bool iterations_met() {
  constexpr std::size_t strands = 64;
  struct Kind {
    std::string_view name;
    HeadPack pack;
    Make make = simulation::helix_head;
  };
  struct Method {
    simulation::HeadMethod method;
    std::string_view what;
    double dt;  // s
  };
  bool met = true;
  for (const Method& method :
       {Method{simulation::HeadMethod::backward_euler, "an iteration of backward_euler",
               1.0 / 300},
        {simulation::HeadMethod::linearly_implicit_midpoint,
         "a step of linearly_implicit_midpoint", h},
        {simulation::HeadMethod::tr_bdf2, "an iteration of tr_bdf2", 1.0 / 300}}) {
    for (const Kind& kind :
         {Kind{"4 of 64 bits", {HeadNumber::float64, 4}},
          {"8 of 64 bits", {HeadNumber::float64, 8}},
          {"16 of 32 bits", {HeadNumber::float32, 16}},
          {"chain, 4 of 64 bits", {HeadNumber::float64, 4}, simulation::chain_head}}) {
      Stepping of{head(strands, kind.pack, 0, kind.make, method.method)};
      of.dt = method.dt;
      // Beyond those that iterate where others do not.
      for (int s = 0; s < 2; ++s) of.step();
      models::HeadWork& work = of.scratch->work = {};
      ReferenceStrands kernel(strands);
      const double step = time_ratio([&of] { of.step(); }, [&kernel] { kernel.step(); });
      met =
          kept("heads", fmt::format("{}, {} over the reference", kind.name, method.what),
               step * static_cast<double>(work.steps) /
                   static_cast<double>(work.iterations + work.again_iterations),
               10) &&
          met;
    }
  }
  return met;
}

/// Returns whether strands in all lanes of a register reach their speed-up over one at a
/// time, which takes the same iterations.
bool lanes_met() {
  constexpr std::size_t strands = 64;
  const HeadPack wide = models::widest_pack(HeadNumber::float64);
  struct Kind {
    std::string_view name;
    Make make;
  };
  bool met = true;
  for (const Kind& kind : {Kind{"corde", simulation::corde_head},
                           {"xpbd_cosserat", simulation::cosserat_head}}) {
    const auto stepping = [&](const HeadPack& pack) {
      return Stepping{
          head(strands, pack, 0, kind.make, simulation::HeadMethod::backward_euler)};
    };
    Stepping many = stepping(wide), one = stepping({HeadNumber::float64, 1});
    for (Stepping* of : {&many, &one}) {
      of->dt = 1.0 / 300;
      for (int s = 0; s < 2; ++s) of->step();
    }
    met = kept("heads", fmt::format("{}, {} lanes over 1", kind.name, wide.lanes),
               time_ratio([&] { many.step(); }, [&] { one.step(); }), 1 / 3.0) &&
          met;
  }
  return met;
}

/// Hair that has come to rest on its head: a body over none, touching and 5 m away.
bool bodies_met() {
  constexpr std::size_t strands = 256;
  bool met = true;
  struct Kind {
    std::string_view name;
    int lanes;
    Make make;
    double most = 1.3;
  };
  for (const Kind& kind : {Kind{"4 of 64 bits", 4, simulation::helix_head},
                           {"8 of 64 bits", 8, simulation::helix_head},
                           {"chain, 4 of 64 bits", 4, simulation::chain_head, 1.9},
                           {"chain, 8 of 64 bits", 8, simulation::chain_head, 2.2},
                           {"springs, 4 of 64 bits", 4, simulation::spring_head}}) {
    const HeadPack pack{HeadNumber::float64, kind.lanes};
    Stepping without{combed(strands, pack, {}, kind.make)},
        on{combed(strands, pack, 0.0, kind.make)},
        beside{combed(strands, pack, 5.0, kind.make)};
    ReferenceStrands kernel(strands);
    for (Stepping* one : {&without, &on, &beside}) {
      for (int s = 0; s < 500; ++s) one->step();
    }
    const auto repeated = [](auto& what) {
      return [&what] {
        for (int i = 0; i < 40; ++i) what.step();
      };
    };
    const auto name = [&kind](const char* what) {
      return fmt::format("{}, {}", kind.name, what);
    };
    met = kept("heads", name("drag and a head that hair lies on, over gravity and drag"),
               time_ratio(repeated(on), repeated(without)), kind.most) &&
          met;
    met = kept("heads", name("a body 5 m away over none"),
               time_ratio(repeated(beside), repeated(without)), 1.05) &&
          met;
    fmt::print("{}: {:.3g} times the reference\n", name("on a head"),
               time_ratio(repeated(on), repeated(kernel)));
  }
  return met;
}

/// 200 000 strands: building, memory, a step of gravity and drag, two threads over one.
bool head_met() {
  constexpr std::size_t strands = 200000;
  bool met = true;
  double one = 0;
  for (const int threads : {1, 2}) {
    std::optional<simulation::HeadRun> run;
    const double building = seconds_of([&] {
      run.emplace(head(strands, {HeadNumber::float64, 8}, 2e-5), threads);
    });
    std::vector<double> times;
    for (int s = 0; s < 9; ++s) {
      times.push_back(seconds_of([&] { run->step(s * h, h); }));
    }
    const double time = median(times);
    if (threads == 1) {
      const double bytes = static_cast<double>(run->head().bytes());
      met = kept("heads", "building 200 000 strands, s,", building, 10) && met;
      met = kept("heads", "memory of a strand, bytes,", bytes / strands, 2048) && met;
      one = time;
    } else {
      met =
          kept("heads", "a step of 200 000 strands on 2 threads, s,", time, 0.25) && met;
      met = kept("heads", "on 2 threads over 1, its time,", time / one, 1 / 1.8) && met;
    }
  }
  return met;
}

}  // namespace
}  // namespace tress::experiments::benchmarks

int main(int argc, char** argv) {
  using namespace tress::experiments::benchmarks;
  register_all();
  return run_and_judge(argc, argv, [](const Measured&) {
    const bool same = same_motion(), costs = costs_met(), iterations = iterations_met(),
               lanes = lanes_met(), bodies = bodies_met(), whole = head_met();
    return same && costs && iterations && lanes && bodies && whole;
  });
}
