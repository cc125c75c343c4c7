// What does a head of hair cost: by number of strands, by what holds their numbers, by
// threads, and by what acts on it? And are the results the same?
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "models/effects/body.h"
#include "models/effects/strand_interaction.h"
#include "models/head/head.h"
#include "simulation/files/parse.h"
#include "simulation/run/head_run.h"
#include "simulation/run/timing.h"

namespace tress::experiments::heads {
namespace {

using models::Head;
using models::HeadNumber;
using models::HeadPack;

constexpr Column columns[] = {
    {"strands", "number of hairs on the head"},
    {"elements", "of each"},
    {"bits", "of a number: 64 or 32"},
    {"lanes", "hairs computed side by side"},
    {"threads", "that share the blocks of hairs"},
    {"effects",
     "beside gravity: none; drag; body, an ellipsoid under the roots, and drag; "
     "interaction of neighbouring hairs, and drag"},
    {"build_s", "wall time to build them", true},
    {"bytes_per_strand", "memory of a hair: state, rest shape, material, root"},
    {"cost_per_step_s", "wall time of a step, median", true},
    {"cost_per_element_step_s", "the same by hairs and elements", true},
    {"cost_per_frame_s", "wall time of 1/60 s of motion and of reading all points", true},
    {"lost", "hairs whose result was not finite"},
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
    {.name = "dt_s", .help = "step (s)", .number = 1.0 / 300, .min = 1e-7, .max = 0.1},
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

enum class Acting { none, drag, body, interaction };
constexpr std::string_view names[] = {"none", "drag", "body", "interaction"};

/// A head without hairs.
std::unique_ptr<Head> bald(int elements, HeadPack pack, Acting acting) {
  models::HeadOptions options{.elements = elements,
                              .points = 8,
                              .drag = acting == Acting::none ? 0 : 5e-5,
                              .longest = length,
                              .motion = {},
                              .effects = {}};
  options.motion.rotations = {{{0, 0, 1}, models::one_minus_cosine(0.3, 2)}};
  if (acting == Acting::body) {
    options.effects = {std::make_shared<models::Body>(
        models::Ellipsoid({0.09, 0.09, 0.09}), models::StrandPlace{},
        models::BodyContact{
            .stiffness = 10, .damping = 1, .friction = 0.3, .offset = 4e-5},
        options.motion)};
  }
  return helix_head(options, pack);
}

/// Each hair with its own effects, if there are any.
std::unique_ptr<Head> head(std::size_t strands, int elements, HeadPack pack,
                           Acting acting, const models::StrandInteraction* between) {
  auto made = bald(elements, pack, acting);
  made->reserve(strands);
  for (std::size_t k = 0; k < strands; ++k) {
    models::Effects own;
    if (between != nullptr) own.push_back(between->effect(k));
    made->add(hair(k, strands, elements), own);
  }
  return made;
}

struct Work {
  std::size_t strands;
  int elements;
  HeadPack pack;
  int threads;
  double dt;
  int frames;
  Acting acting;
};

/// From the same hairs in 64 bits: every 97th, on a head of theirs alone.
double difference(const Work& work, int steps, const std::vector<double>& x) {
  const std::unique_ptr<Head> few =
      bald(work.elements, {HeadNumber::float64, 4}, work.acting);
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
  std::optional<models::StrandInteraction> between;
  if (work.acting == Acting::interaction) {
    between.emplace(Parameters(models::strand_interaction_parameters(), "heads"),
                    std::vector<int>(work.strands, work.elements + 1));
  }
  std::optional<simulation::HeadRun> moving;
  row.set("build_s", seconds_of([&] {
            moving.emplace(head(work.strands, work.elements, work.pack, work.acting,
                                between ? &*between : nullptr),
                           work.threads);
          }));
  const Head& all = moving->head();
  std::vector<double> places, speeds;
  const auto exchange = [&](double t) {
    if (!between) return;
    places.resize(work.strands * all.numbers());
    speeds.resize(places.size());
    for (std::size_t b = 0, first = 0; b < all.blocks(); ++b) {
      const std::size_t size = all.strands_of(b) * all.numbers();
      all.motion(b, t, std::span(places).subspan(first, size),
                 std::span(speeds).subspan(first, size));
      first += size;
    }
    between->update(places, speeds);
  };
  row.set("bytes_per_strand",
          static_cast<double>(all.bytes()) / static_cast<double>(work.strands));
  const int steps = std::max(1, static_cast<int>(std::lround(frame / work.dt)));
  std::vector<double> of_steps, of_frames, x;
  int taken = 0;
  for (int f = 0; f < work.frames; ++f) {
    of_frames.push_back(seconds_of([&] {
      for (int s = 0; s < steps; ++s) {
        of_steps.push_back(seconds_of([&] {
          exchange(taken * work.dt);
          moving->step(taken++ * work.dt, work.dt);
        }));
      }
      moving->positions(taken * work.dt, x);
    }));
  }
  const double step = median(of_steps);
  row.set("cost_per_step_s", step);
  row.set("cost_per_element_step_s",
          step / (static_cast<double>(work.strands) * work.elements));
  row.set("cost_per_frame_s", median(of_frames));
  int lost = 0;
  for (std::size_t k = 0; k < work.strands; ++k) lost += all.lost(k) ? 1 : 0;
  row.set("lost", lost);
  // Few hairs alone lack the neighbours that the others have.
  if (!between) row.set("difference_rel", difference(work, taken, x));
  row.set("state", fmt::format("{:016x}", all.hash()));
}

constexpr HeadPack packs[] = {{HeadNumber::float64, 1},
                              {HeadNumber::float64, 4},
                              {HeadNumber::float64, 8},
                              {HeadNumber::float32, 8},
                              {HeadNumber::float32, 16}};

/// Every pack and number of threads under drag; what else acts, as far as it takes to
/// compare costs and bits.
bool wanted(int strands, HeadPack pack, int threads, Acting acting) {
  // One hair at a time is there for the comparison of bits and of cost by hair.
  if (pack.lanes == 1 && strands > 20000) return false;
  if (threads > 1 && pack.lanes != 8) return false;
  if (acting == Acting::drag) return true;
  if (pack.number != HeadNumber::float64 || pack.lanes == 1) return false;
  if (acting == Acting::interaction && strands > 20000) return false;
  return threads < 3 && (acting != Acting::none || threads == 1);
}

std::vector<Case> cases(const CommandLine& line) {
  const Settings settings(line, own_settings);
  const Parameters& own = settings.experiment();
  std::vector<Case> all;
  const std::vector<int> elements =
      line.elements.empty() ? std::vector{10} : line.elements;
  const auto add = [&](int strands, int n, HeadPack pack, int threads, Acting acting) {
    Row identity;
    identity.set("strands", strands).set("elements", n);
    identity.set("bits", pack.number == HeadNumber::float64 ? 64 : 32);
    identity.set("lanes", pack.lanes).set("threads", threads);
    identity.set("effects", std::string(names[static_cast<std::size_t>(acting)]));
    const Work work{static_cast<std::size_t>(strands),
                    n,
                    pack,
                    threads,
                    own.number("dt_s"),
                    own.whole("frames"),
                    acting};
    all.push_back({identity, [work](Row& row, const auto&) { run(work, row); }});
  };
  for (const std::string& count : split(own.word("strands"), ',', "strands")) {
    const auto strands = static_cast<int>(parse_whole(count, "strands", 1, 1000000));
    for (const int n : elements) {
      for (const Acting acting :
           {Acting::drag, Acting::none, Acting::body, Acting::interaction}) {
        for (const HeadPack& pack : packs) {
          for (const int threads : {1, 2, 3}) {
            if (wanted(strands, pack, threads, acting)) {
              add(strands, n, pack, threads, acting);
            }
          }
        }
      }
    }
  }
  return all;
}

void judge(const std::vector<Row>& rows, Verdicts& verdicts) {
  int compared = 0, different = 0;
  double lost = 0, narrow = 0;
  for (const Row& row : rows) {
    if (!row.ok()) continue;
    lost = std::max(lost, row.number("lost"));
    if (row.number("bits") == 32) {
      narrow = std::max(narrow, row.number("difference_rel"));
    }
    for (const Row& other : rows) {
      if (!other.ok() || &other == &row) continue;
      bool same = true;
      for (const char* column : {"strands", "elements", "bits", "effects"}) {
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
}

constexpr Unused unused[] = {{"models", "super_helix alone comes in packs"},
                             {"integrators", "semi_implicit_euler alone does"},
                             {"repeat", "--set frames says how long a row is timed"},
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
