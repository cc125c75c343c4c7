// What does a head of hair cost: by number of strands, by what holds their numbers, and
// by threads? And are the results the same?
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "models/head/head.h"
#include "simulation/files/parse.h"
#include "simulation/run/head_run.h"
#include "simulation/run/timing.h"

namespace tress::experiments::heads {
namespace {

using models::Head;
using models::HeadMethod;
using models::HeadNumber;
using models::HeadPack;

constexpr Column columns[] = {
    {"model", "of a hair"},
    {"integrator", "of its steps"},
    {"dt_s", "step"},
    {"strands", "number of hairs on the head"},
    {"elements", "of each"},
    {"bits", "of a number: 64 or 32"},
    {"lanes", "hairs computed side by side"},
    {"threads", "that share the blocks of hairs"},
    {"build_s", "wall time to build them", true},
    {"bytes_per_strand", "memory of a hair: state, rest shape, material, root"},
    {"cost_per_step_s", "wall time of a step, median", true},
    {"cost_per_element_step_s", "the same by hairs and elements", true},
    {"cost_per_frame_s", "wall time of 1/60 s of motion and of reading all points", true},
    {"iterations_per_step", "Newton's, of a hair"},
    {"lanes_per_iteration",
     "lanes computed over hairs iterated, by whole corrections: what lanes without hairs "
     "waste"},
    {"retried_share", "of the steps of hairs: those that needed damped corrections"},
    {"lanes_of_retries", "share of all lanes that they took"},
    {"alone_per_step", "iterations of hairs one at a time, where damped ones failed"},
    {"lost", "hairs without a solution; the first one's step and reason on stderr"},
    {"difference_rel",
     "largest distance of a point from that in 64 bits, over the length; every 97th "
     "hair"},
    {"state", "checksum of all states at the end: equal bits, equal checksum"},
};

constexpr Parameter own_settings[] = {
    {.name = "strands",
     .help = "numbers of hairs, as in 1000,200000",
     .text = true,
     .fallback = "1000,20000,200000"},
    {.name = "dt_s",
     .help = "step of methods that do not iterate (s)",
     .number = 1.0 / 300,
     .min = 1e-7,
     .max = 0.1},
    {.name = "dt_newton_s",
     .help = "steps of methods that iterate, as in 0.01;0.02 (s)",
     .min = 1e-7,
     .max = 0.1,
     .rows = true,
     .fallback = "0.008333333333333333;0.03333333333333333"},
    {.name = "newton_frames",
     .help = "of 1/60 s that they are computed for",
     .number = 30,
     .min = 1,
     .max = 1e5,
     .whole = true},
    {.name = "others_up_to",
     .help = "hairs on the largest head by models and methods other than the first",
     .number = 1000,
     .min = 0,
     .max = 1e6,
     .whole = true},
    {.name = "frames",
     .help = "of 1/60 s that are computed",
     .number = 3,
     .min = 1,
     .max = 1e5,
     .whole = true},
};

constexpr OwnOption command_options[] = {
    {"strands", "strands", "numbers of hairs, as in 1000,200000", true},
};

constexpr double length = 0.2;      // m
constexpr double frame = 1.0 / 60;  // s

/// Hair `k` of `count`: roots spread evenly over the upper half of a head of 9 cm, curls
/// that differ from hair to hair.
models::Strand hair(std::size_t k, std::size_t count, int elements) {
  const double place = static_cast<double>(k) + 0.5, golden = 2.399963229728653;
  const double up = 1 - place / static_cast<double>(count), out = std::sqrt(1 - up * up);
  const Vec normal{out * std::cos(golden * place), out * std::sin(golden * place), up};
  models::Material material;
  material.internal_friction = 2e-10;
  const double curl = 15 + 10 * std::sin(0.37 * static_cast<double>(k % 97));
  models::Strand made =
      make_strand(material, {4e-5, 3e-5}, {.elements = elements, .length = length},
                  models::uniform_shape({3, curl, 0}));
  made.root.position = 0.09 * normal;
  // A frame whose e0 is the normal.
  const Vec side = std::abs(up) < 0.9 ? Vec{0, 0, 1} : Vec{1, 0, 0};
  const Vec across = cross(normal, side);
  const Vec e1 = 1 / norm(across) * across;
  made.root.frame = {normal, e1, cross(normal, e1)};
  return made;
}

struct Kind {
  std::string_view model, integrator;
  std::unique_ptr<Head> (*make)(const models::HeadOptions&, const HeadPack&);
  HeadMethod method;
};
constexpr Kind kinds[] = {
    {"super_helix", "semi_implicit_euler", models::helix_head,
     HeadMethod::semi_implicit_euler},
    {"der", "semi_implicit_euler", models::der_head, HeadMethod::semi_implicit_euler},
    {"der", "backward_euler", models::der_head, HeadMethod::backward_euler}};

std::unique_ptr<Head> head(const Kind& kind, std::size_t strands, int elements,
                           HeadPack pack) {
  models::HeadOptions options{.elements = elements,
                              .points = 8,
                              .drag = 5e-5,
                              .longest = length,
                              .motion = {},
                              .method = kind.method};
  options.motion.rotations = {{{0, 0, 1}, models::one_minus_cosine(0.3, 2)}};
  auto made = kind.make(options, pack);
  made->reserve(strands);
  for (std::size_t k = 0; k < strands; ++k) made->add(hair(k, strands, elements));
  return made;
}

struct Work {
  Kind kind;
  std::size_t strands;
  int elements;
  HeadPack pack;
  int threads;
  double dt;
  int frames;
};

/// From the same hairs in 64 bits: every 97th, on a head of theirs alone.
double difference(const Work& work, int steps, const std::vector<double>& x) {
  const std::unique_ptr<Head> few =
      head(work.kind, 0, work.elements, {HeadNumber::float64, 4});
  const std::size_t each = few->numbers();
  std::vector<std::size_t> which;
  for (std::size_t k = 0; k < work.strands; k += 97) {
    few->add(hair(k, work.strands, work.elements));
    which.push_back(k);
  }
  const auto scratch = few->scratch();
  double most = 0;
  std::vector<double> own(4 * each);
  for (std::size_t b = 0; b < few->blocks(); ++b) {
    for (int s = 0; s < steps; ++s) few->step(b, s * work.dt, work.dt, *scratch);
    few->positions(b, steps * work.dt, own);
    for (std::size_t i = 0; i < few->strands_of(b) * each; ++i) {
      const std::size_t k = which[4 * b + i / each];
      most = std::max(most, std::abs(own[i] - x[k * each + i % each]));
    }
  }
  return most / length;
}

void run(const Work& work, Row& row) {
  std::optional<simulation::HeadRun> moving;
  row.set("build_s", seconds_of([&] {
            moving.emplace(head(work.kind, work.strands, work.elements, work.pack),
                           work.threads);
          }));
  const Head& all = moving->head();
  row.set("bytes_per_strand",
          static_cast<double>(all.bytes()) / static_cast<double>(work.strands));
  // Of steps longer than a frame the reading of points is timed with each.
  const int steps = std::max(1, static_cast<int>(std::lround(frame / work.dt)));
  std::vector<double> of_steps, of_frames, x;
  int taken = 0;
  for (int f = 0; f < work.frames; ++f) {
    of_frames.push_back(seconds_of([&] {
      for (int s = 0; s < steps; ++s) {
        of_steps.push_back(seconds_of([&] { moving->step(taken++ * work.dt, work.dt); }));
      }
      moving->positions(taken * work.dt, x);
    }));
  }
  const double step = median(of_steps);
  row.set("cost_per_step_s", step);
  row.set("cost_per_element_step_s",
          step / (static_cast<double>(work.strands) * work.elements));
  row.set("cost_per_frame_s", median(of_frames));
  const models::HeadWork done = moving->work();
  if (done.iterations > 0) {
    const auto share = [](long of, long by) {
      return static_cast<double>(of) / static_cast<double>(by);
    };
    row.set("iterations_per_step",
            share(done.iterations + done.again_iterations, done.steps));
    row.set("lanes_per_iteration", share(done.lanes, done.iterations));
    row.set("retried_share", share(done.retried, done.steps));
    row.set("lanes_of_retries", share(done.again_lanes, done.lanes + done.again_lanes));
    row.set("alone_per_step", share(done.alone, done.steps));
  }
  int lost = 0;
  for (std::size_t k = 0; k < work.strands; ++k) lost += all.lost(k) ? 1 : 0;
  row.set("lost", lost);
  if (const auto losses = all.losses(); !losses.empty()) {
    const models::HeadLoss& first = losses.front();
    fmt::print(stderr, "hair {} is lost in step {}, at {} s: {}\n", first.strand,
               first.step, first.time, first.reason);
  }
  row.set("difference_rel", difference(work, taken, x));
  row.set("state", fmt::format("{:016x}", all.hash()));
}

constexpr HeadPack packs[] = {{HeadNumber::float64, 1},
                              {HeadNumber::float64, 4},
                              {HeadNumber::float64, 8},
                              {HeadNumber::float32, 8},
                              {HeadNumber::float32, 16}};

std::vector<Case> cases(const CommandLine& line) {
  const Settings settings(line, own_settings);
  const Parameters& own = settings.experiment();
  std::vector<Case> all;
  const std::vector<int> elements =
      line.elements.empty() ? std::vector{10} : line.elements;
  const auto add = [&](const Kind& kind, int strands, int n, double dt) {
    for (const HeadPack& pack : packs) {
      // One hair at a time is there for the comparison of bits and of cost by hair.
      if (pack.lanes == 1 && strands > 20000) continue;
      for (const int threads : {1, 2, 3}) {
        if (threads > 1 && pack.lanes != 8) continue;
        Row identity;
        identity.set("model", std::string(kind.model));
        identity.set("integrator", std::string(kind.integrator)).set("dt_s", dt);
        identity.set("strands", strands).set("elements", n);
        identity.set("bits", pack.number == HeadNumber::float64 ? 64 : 32);
        identity.set("lanes", pack.lanes).set("threads", threads);
        const Work work{
            kind,
            static_cast<std::size_t>(strands),
            n,
            pack,
            threads,
            dt,
            own.whole(kind.method == HeadMethod::semi_implicit_euler ? "frames"
                                                                     : "newton_frames")};
        all.push_back({identity, [work](Row& row, const auto&) { run(work, row); }});
      }
    }
  };
  for (const std::string& count : split(own.word("strands"), ',', "strands")) {
    const auto strands = static_cast<int>(parse_whole(count, "strands", 1, 1000000));
    for (const Kind& kind : kinds) {
      if (!wanted(line.models, kind.model)) continue;
      if (!wanted(line.integrators, kind.integrator)) continue;
      if (&kind != kinds && strands > own.whole("others_up_to")) continue;
      for (const int n : elements) {
        if (kind.method == HeadMethod::semi_implicit_euler) {
          add(kind, strands, n, own.number("dt_s"));
          continue;
        }
        for (const double dt : own.numbers("dt_newton_s")) add(kind, strands, n, dt);
      }
    }
  }
  return all;
}

void judge(const std::vector<Row>& rows, Verdicts& verdicts) {
  int compared = 0, different = 0;
  double lost = 0, narrow = 0, waste[2] = {};
  for (const Row& row : rows) {
    if (!row.ok()) continue;
    lost = std::max(lost, row.number("lost"));
    if (row.text("integrator") == "backward_euler" && row.number("threads") == 1) {
      double& most = waste[row.number("dt_s") > 1.0 / 120 ? 1 : 0];
      most = std::max(most, row.number("lanes_per_iteration"));
    }
    if (row.number("bits") == 32) {
      narrow = std::max(narrow, row.number("difference_rel"));
    }
    for (const Row& other : rows) {
      if (!other.ok() || &other == &row) continue;
      bool same = true;
      for (const char* column :
           {"model", "integrator", "dt_s", "strands", "elements", "bits"}) {
        same = same && row.text(column) == other.text(column);
      }
      if (!same) continue;
      ++compared;
      if (row.text("state") != other.text("state")) ++different;
    }
  }
  const std::string bits = "any number of lanes and threads gives the same bits";
  if (compared > 0) {
    verdicts.check(bits, different == 0, different);
  } else {
    verdicts.not_judged(bits);
  }
  verdicts.check("no hair is lost", lost == 0, lost);
  verdicts.check("in 32 bits no point is off by more than 1e-5 of the length",
                 narrow <= 1e-5, narrow);
  const std::string wasted = "lanes without hairs add no more to iterations than ";
  if (waste[0] > 0) {
    verdicts.check(wasted + "a fifth up to steps of 1/120 s", waste[0] <= 1.2, waste[0]);
  }
  if (waste[1] > 0) {
    verdicts.check(wasted + "a half in longer steps", waste[1] <= 1.5, waste[1]);
  }
}

constexpr Unused unused[] = {{"repeat", "--set frames says how long a row is timed"},
                             not_random};

}  // namespace
}  // namespace tress::experiments::heads

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::heads;
  const Experiment experiment{
      .name = "heads",
      .question = "what does a head of hair cost, and is it the same by all threads?",
      .example = "--strands 200000",
      .columns = columns,
      .settings = own_settings,
      .options = command_options,
      .unused = unused,
      .cases = cases,
      .checks = judge};
  return run_experiment(experiment, argc, argv);
}
