#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <memory>
#include <vector>

#include "simulation/head/head_run.h"
#include "simulation/run/world.h"

/// Scenes as one batch, and strand by strand.
namespace tress::testing_support {

using namespace simulation;
using models::HeadPack;

/// Positions of all strands at all frames, and which strands have failed.
struct Course {
  std::vector<std::vector<double>> frames;
  std::vector<std::size_t> lost;
};

inline Course of_strands(const Scene& scene) {
  World world(scene);
  Course course;
  for (std::size_t frame = 1; frame <= scene.last_frame(); ++frame) {
    EXPECT_EQ(world.advance(scene.time_of(frame)), Status::ok) << world.failure();
    course.frames.push_back(world.positions());
  }
  for (const FailedStrand& one : world.lost()) course.lost.push_back(one.strand);
  std::ranges::sort(course.lost);
  return course;
}

/// Steps of the scene from its frame to the next one.
inline void step_to(HeadRun& run, const Scene& scene, std::size_t frame) {
  const double begin = scene.time_of(frame - 1), end = scene.time_of(frame),
               count = std::max(
                   1.0,
                   std::ceil((end - begin) / longest_step(scene, run.lanes()) - 1e-9)),
               h = (end - begin) / count;
  for (int i = 0; i < static_cast<int>(count); ++i) run.step(begin + i * h, h);
  run.judge(end);
}

inline std::unique_ptr<HeadRun> batch(const SceneOutline& outline, int threads = 1) {
  const HeadPack pack{models::HeadNumber::float64, 4};
  return std::make_unique<HeadRun>(make_head(outline, pack, threads), threads);
}

/// Places are numbers where strands do not touch.
inline Course of_batch(HeadRun& run, const Scene& scene, std::size_t from = 1) {
  Course course;
  for (std::size_t frame = from; frame <= scene.last_frame(); ++frame) {
    step_to(run, scene, frame);
    run.positions(scene.time_of(frame), course.frames.emplace_back());
  }
  for (std::size_t k = 0; k < run.head().strands(); ++k) {
    if (run.head().lost(k)) course.lost.push_back(k);
  }
  return course;
}

inline double apart(const Course& one, const Course& other) {
  double most = 0;
  for (std::size_t f = 0; f < one.frames.size(); ++f) {
    for (std::size_t i = 0; i < one.frames[f].size(); ++i) {
      most = std::max(most, std::abs(one.frames[f][i] - other.frames[f][i]));
    }
  }
  return most;
}

}  // namespace tress::testing_support
