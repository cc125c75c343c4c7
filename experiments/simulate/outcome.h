#pragma once

#include <span>
#include <string>
#include <string_view>

#include "experiments/simulate/scene_run.h"
#include "simulation/errors/error_bars.h"
#include "simulation/errors/pilot.h"
#include "simulation/files/row.h"

namespace tress::experiments::scene_runs {

/// Columns of a run in the manifest.
std::span<const Column> outcome_columns();

/// The run's frames, time and counts, and why it failed if it did.
Row outcome(const Scene& scene, const SceneRun& run);

/// Adds the errors of one part, time or space.
void set_errors(std::string_view part, const ErrorBar& bar, Row& row);

/// Steps since the run began or was resumed, where error control chose them; else those
/// that were repeated. Empty: none.
std::string control_in_words(const Scene& scene, const SceneRun& run);

/// Forces of the supports in the last frame, in words.
std::string supports_in_words(const SceneRun& run);
/// "; pictures show 1000 of 20000 strands and 50 of 201 frames". Empty: they show all.
std::string pictures_in_words(const SceneRun& run);

/// "time error 2e-4 of the length at 0.3 s, ..."
std::string in_words(std::string_view part, const ErrorBar& bar, const Scene& scene);

/// A table of both over time: one line a frame.
std::string errors_csv(const Scene& scene, const ErrorBar& time, const ErrorBar& space);

/// The result of a pilot, as cells and as words.
void set_pilot(const Pilot& pilot, Row& row);
std::string in_words(const Pilot& pilot);

}  // namespace tress::experiments::scene_runs
