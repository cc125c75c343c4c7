#include "experiments/heads/moving_head.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "models/effects/body.h"
#include "models/effects/strand_interaction.h"
#include "simulation/head/head_run.h"
#include "simulation/run/timing.h"

namespace tress::experiments::heads {
namespace {

using models::Head;
using models::HeadNumber;

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

/// A head without hairs.
std::unique_ptr<Head> bald(const Work& work, models::HeadPack pack) {
  HeadOptions options{{.elements = work.elements,
                       .points = 8,
                       .drag = work.acting == Acting::none ? 0 : 5e-5,
                       .longest = length,
                       .motion = {},
                       .effects = {}}};
  options.method = work.kind.method;
  options.motion.rotations = {{{0, 0, 1}, models::one_minus_cosine(0.3, 2)}};
  if (work.acting == Acting::body) {
    options.effects = {std::make_shared<models::Body>(
        models::Ellipsoid({0.09, 0.09, 0.09}), models::StrandPlace{},
        models::BodyContact{
            .stiffness = 10, .damping = 1, .friction = 0.3, .offset = 4e-5},
        options.motion)};
  }
  return work.kind.make(options, pack);
}

/// Each hair with its own effects, if there are any.
std::unique_ptr<Head> head(const Work& work, const models::StrandInteraction* between) {
  auto made = bald(work, work.pack);
  made->reserve(work.strands);
  for (std::size_t k = 0; k < work.strands; ++k) {
    models::Effects own;
    if (between != nullptr) own.push_back(between->effect(k));
    made->add(hair(k, work.strands, work.elements), own);
  }
  return made;
}

/// Returns the difference from the same hairs in double precision: every 97th, on a
/// head of their own.
double difference(const Work& work, int steps, const std::vector<double>& x) {
  const std::unique_ptr<Head> few = bald(work, {HeadNumber::float64, 4});
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

}  // namespace

void run_head(const Work& work, Row& row) {
  std::optional<simulation::HeadRun> moving;
  row.set("build_s", seconds_of([&] {
            std::unique_ptr<models::StrandInteraction> between;
            if (work.acting == Acting::interaction) {
              between = std::make_unique<models::StrandInteraction>(
                  Parameters(models::strand_interaction_parameters(), "heads"),
                  std::vector<int>(work.strands, work.elements + 1));
            }
            auto made = head(work, between.get());
            moving.emplace(std::move(made), work.threads, std::move(between));
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
    row.set("retry_lane_share", share(done.again_lanes, done.lanes + done.again_lanes));
    row.set("in_parts_per_step", share(done.in_parts, done.steps));
  }
  int lost = 0;
  for (std::size_t k = 0; k < work.strands; ++k) lost += all.lost(k) ? 1 : 0;
  row.set("failed", lost);
  if (const auto losses = all.losses(); !losses.empty()) {
    const models::HeadLoss& first = losses.front();
    fmt::print(stderr, "hair {} fails in step {}, at {} s: {}\n", first.strand,
               first.step, first.time, first.reason);
  }
  // Few hairs alone lack the neighbours that the others have.
  if (work.acting != Acting::interaction)
    row.set("difference_rel", difference(work, taken, x));
  row.set("state_hash", fmt::format("{:016x}", all.hash()));
}

}  // namespace tress::experiments::heads
