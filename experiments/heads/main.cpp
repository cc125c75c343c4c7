// What does a head of hair cost: by number of strands, by what holds their numbers, and
// by threads? And are the results the same?
#include <algorithm>
#include <string>
#include <vector>

#include "experiments/heads/moving_head.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "simulation/files/parse.h"
#include "simulation/head/no_head.h"

namespace tress::experiments::heads {
namespace {

using models::HeadNumber;
using models::HeadPack;
using simulation::HeadMethod;

constexpr Column columns[] = {
    {"model", "model of the hairs"},
    {"integrator", "integrator of the steps"},
    {"dt_s", "step"},
    {"strands", "number of hairs on the head"},
    {"elements", "number of elements of each hair"},
    {"precision", "floating-point precision in bits: 64 or 32"},
    {"simd_width", "hairs per SIMD pack"},
    {"threads", "threads that share the blocks of hairs"},
    {"effects",
     "effects in addition to gravity: none; drag; body, an ellipsoid under the "
     "roots, and drag; interaction of neighbouring hairs, and drag"},
    {"build_s", "wall time to build the hairs", true},
    {"bytes_per_strand", "memory of a hair: state, rest shape, material, root"},
    {"cost_per_step_s", "wall time of a step, median", true},
    {"cost_per_element_step_s", "wall time of a step, median, per hair and element",
     true},
    {"cost_per_frame_s", "wall time of 1/60 s of motion and of reading all points", true},
    {"iterations_per_step", "Newton iterations per step of a hair"},
    {"lanes_per_iteration",
     "lanes computed over hairs iterated, in whole corrections; above 1: lanes "
     "without hairs"},
    {"retried_share", "share of the steps of hairs that needed damped corrections"},
    {"retry_lane_share", "share of all lanes used by these retries"},
    {"in_parts_per_step", "iterations of shorter steps, where damped ones failed"},
    {"failed", "hairs without a solution; the first one's step and reason on stderr"},
    {"difference_rel",
     "largest distance of a point from the run in double precision, over the "
     "length; every 97th hair"},
    {"state_hash", "checksum of all states at the end: equal bits, equal checksum"},
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
     .help = "frames of 1/60 s that iterative methods are computed for",
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
     .help = "frames of 1/60 s that are computed",
     .number = 3,
     .min = 1,
     .max = 1e5,
     .whole = true},
};

constexpr OwnOption command_options[] = {
    {"strands", "strands", "numbers of hairs, as in 1000,200000", true},
};

struct Model {
  std::string_view id;
  decltype(Kind::make) make;
  // Whether it has numbers of 32 bits, and by linearly_implicit_midpoint.
  bool narrow, narrow_midpoint;
};
constexpr Model head_models[] = {
    {"super_helix", simulation::helix_head, true, true},
    {"articulated_chain", simulation::chain_head, true, false},
    {"der", simulation::der_head, true, false},
    {"mass_spring", simulation::spring_head, false, false}};

/// All models by all methods, but what the head of the model refuses
/// (models/head/head.h).
std::vector<Kind> all_kinds() {
  std::vector<Kind> kinds;
  for (const Model& model : head_models) {
    for (const auto& [id, method] : head_methods) {
      const bool midpoint = method == HeadMethod::linearly_implicit_midpoint;
      kinds.push_back({model.id, id, model.make, method,
                       midpoint ? model.narrow_midpoint : model.narrow});
    }
  }
  return kinds;
}

bool first(const Kind& kind) {
  return kind.model == head_models[0].id && kind.method == head_methods[0].second;
}
bool iterates(const Kind& kind) {
  return kind.method == HeadMethod::backward_euler || kind.method == HeadMethod::tr_bdf2;
}

/// Every pack and number of threads under drag; what else acts, and others than the first
/// kind, as far as it takes to compare costs and bits.
bool wanted(const Kind& kind, int strands, HeadPack pack, int threads, Acting acting) {
  // One hair at a time is there for the comparison of bits and of cost by hair.
  if (pack.lanes == 1 && strands > 20000) return false;
  if (pack.number == HeadNumber::float32 && !kind.narrow) return false;
  const bool widest = pack == models::longest_pack(pack.number);
  if (threads > 1 && pack.lanes != 8 && !(first(kind) && widest && threads == 2)) {
    return false;
  }
  if (!first(kind) && (threads > 2 || !(widest || pack.lanes == 1))) return false;
  if (acting == Acting::drag) return true;
  if (!first(kind)) return false;
  if (pack.number != HeadNumber::float64 || pack.lanes == 1) return false;
  // Denser hair has hundreds of neighbours within reach.
  if (acting == Acting::interaction && strands > 1000) return false;
  return threads < 3 && (acting != Acting::none || threads == 1);
}

std::vector<Case> cases(const CommandLine& line) {
  const Settings settings(line, own_settings);
  const Parameters& own = settings.experiment();
  std::vector<Case> all;
  const std::vector<int> elements =
      line.elements.empty() ? std::vector{10} : line.elements;
  const auto add_one = [&](const Work& work) {
    Row identity;
    identity.set("model", std::string(work.kind.model));
    identity.set("integrator", std::string(work.kind.integrator)).set("dt_s", work.dt);
    identity.set("strands", static_cast<int>(work.strands));
    identity.set("elements", work.elements);
    identity.set("precision", work.pack.number == HeadNumber::float64 ? 64 : 32);
    identity.set("simd_width", work.pack.lanes).set("threads", work.threads);
    identity.set("effects",
                 std::string(names_of_acting[static_cast<std::size_t>(work.acting)]));
    all.push_back({identity, [work](Row& row, const auto&) { run_head(work, row); }});
  };
  const auto add = [&](const Kind& kind, int strands, int n, double dt) {
    const int frames = own.whole(iterates(kind) ? "newton_frames" : "frames");
    for (const Acting acting :
         {Acting::drag, Acting::none, Acting::body, Acting::interaction}) {
      for (const HeadPack& pack : models::compiled_packs()) {
        for (const int threads : {1, 2, 3}) {
          if (!wanted(kind, strands, pack, threads, acting)) continue;
          add_one({kind, static_cast<std::size_t>(strands), n, pack, threads, dt, frames,
                   acting});
        }
      }
    }
  };
  for (const std::string& count : split(own.word("strands"), ',', "strands")) {
    const auto strands = static_cast<int>(parse_whole(count, "strands", 1, 1000000));
    for (const Kind& kind : all_kinds()) {
      if (!experiments::wanted(line.models, kind.model)) continue;
      if (!experiments::wanted(line.integrators, kind.integrator)) continue;
      if (!first(kind) && strands > own.whole("others_up_to")) continue;
      for (const int n : elements) {
        if (!iterates(kind)) {
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
    // Its single corrections gain energy on what is stiff, and have no more to try.
    if (row.text("integrator") != "linearly_implicit_midpoint") {
      lost = std::max(lost, row.number("failed"));
    }
    if (row.has("lanes_per_iteration") && row.number("threads") == 1) {
      double& most = waste[row.number("dt_s") > 1.0 / 120 ? 1 : 0];
      most = std::max(most, row.number("lanes_per_iteration"));
    }
    // By methods that damp: rounding of others goes on. In long steps it decides between
    // several solutions.
    if (row.number("precision") == 32 && row.number("dt_s") <= 1.0 / 120 &&
        row.text("integrator").ends_with("_euler")) {
      narrow = std::max(narrow, row.number("difference_rel"));
    }
    for (const Row& other : rows) {
      if (!other.ok() || &other == &row) continue;
      bool same = true;
      for (const char* column : {"model", "integrator", "dt_s", "strands", "elements",
                                 "precision", "effects"}) {
        same = same && row.text(column) == other.text(column);
      }
      if (!same) continue;
      ++compared;
      if (row.text("state_hash") != other.text("state_hash")) ++different;
    }
  }
  const std::string bits =
      "results are bitwise equal for any number of SIMD lanes and threads";
  if (compared > 0) {
    verdicts.check(bits, different == 0, different);
  } else {
    verdicts.not_judged(bits);
  }
  verdicts.check("no hair fails, except with linearly_implicit_midpoint", lost == 0,
                 lost);
  verdicts.check(
      "in single precision no point is off by more than 1e-5 of the length, with Euler "
      "methods and steps up to 1/120 s",
      narrow <= 1e-5, narrow);
  const std::string wasted = "idle SIMD lanes lengthen iterations by no more than ";
  if (waste[0] > 0) {
    verdicts.check(wasted + "a fifth up to steps of 1/120 s", waste[0] <= 1.2, waste[0]);
  }
  if (waste[1] > 0) {
    verdicts.check(wasted + "a half in longer steps", waste[1] <= 1.5, waste[1]);
  }
}

constexpr Unused unused[] = {{"repeat", "--set frames sets the timed duration of a row"},
                             not_random};

}  // namespace
}  // namespace tress::experiments::heads

int main(int argc, char** argv) {
  using namespace tress::experiments;
  using namespace tress::experiments::heads;
  const Experiment experiment{.name = "heads",
                              .question =
                                  "what does a batch of strands cost, and is it the same "
                                  "for any number of threads?",
                              .example = "--strands 200000",
                              .sizes = {"131 rows, 3.5 min", "the same rows"},
                              .columns = columns,
                              .settings = own_settings,
                              .options = command_options,
                              .unused = unused,
                              .cases = cases,
                              .checks = judge};
  return run_experiment(experiment, argc, argv);
}
