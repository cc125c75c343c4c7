#include "experiments/simulate/head_recording.h"

#include <fcntl.h>
#include <fmt/format.h>

#include <filesystem>
#include <utility>

#include "contract/input_error.h"
#include "experiments/simulate/failed_strands.h"
#include "simulation/files/csv.h"
#include "simulation/files/files.h"
#include "simulation/files/row.h"

namespace tress::experiments::scene_runs {
namespace {

/// Checks the outputs before creating any.
std::string checked(std::string stem) {
  for (const char* ending : {".csv", ".h5", ".failed.csv"}) check_output(stem + ending);
  return stem;
}

std::string line_of(const std::vector<std::string>& columns,
                    std::span<const double> series) {
  Row row;
  std::vector<std::string> cells;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    row.set(columns[i], series[i]);
    cells.emplace_back(row.text(columns[i]));
  }
  return csv_line(cells);
}

}  // namespace

HeadRecording::HeadRecording(std::string stem, RunKey key, const Scene& scene,
                             const HeadRun& run, StoredFrames stored, bool resume)
    : stem_(checked(std::move(stem))),
      key_(std::move(key)),
      columns_(stored.columns),
      head_{run.strands(), run.head().numbers() / 3},
      kept_(run.kept()),
      lock_(stem_ + ".frames", "this scene") {
  try {
    open(scene, std::move(stored), resume);
  } catch (...) {
    if (lock_.read().empty()) lock_.remove();  // not frames that other runs have left
    throw;
  }
}

void HeadRecording::open(const Scene& scene, StoredFrames stored, bool resume) {
  remove_leftovers(stem_);
  const std::string state = stem_ + ".state";
  std::error_code error;
  if (resume && std::filesystem::exists(state, error)) {
    saved_ = std::make_unique<HeadToResume>(state, key_, head_.strands, kept_);
    progress_ = saved_->progress();
    frames_.emplace(stem_, head_, std::move(stored), progress_.sums, progress_.frames);
  } else {
    if (std::filesystem::remove(state, error); error) {
      throw InputError("cannot remove: " + error.message(), state,
                       "choose another --out");
    }
    frames_.emplace(stem_, scene, head_, std::move(stored));
  }
  std::string table = csv_line(columns_);
  for (std::size_t frame = 0; frame < frames_->size(); ++frame) {
    table += line_of(columns_, frames_->series(frame));
  }
  replace_file(stem_ + ".csv", table);
  csv_.emplace(stem_ + ".csv", O_WRONLY | O_APPEND | O_CLOEXEC);
  std::filesystem::remove(stem_ + ".failed.csv", error);  // of a run before
  write_lost();
}

void HeadRecording::write_lost() {
  if (progress_.lost.size() == lost_written_) return;
  replace_file(stem_ + ".failed.csv", failed_table(progress_.lost));
  lost_written_ = progress_.lost.size();
}

void HeadRecording::add(const std::vector<double>& series) {
  frames_->write(series);
  write_all(csv_->descriptor(), line_of(columns_, series), stem_ + ".csv");
  write_lost();
  progress_.sums = frames_->sums();
}

std::unique_ptr<SavedHead> HeadRecording::saving(std::size_t step) {
  frames_->sync();
  progress_.frames = frames_->state();
  progress_.step = step;
  return std::make_unique<SavedHead>(stem_ + ".state", key_, head_.strands, kept_,
                                     progress_);
}

void HeadRecording::close() {
  frames_->sync();
  lock_.remove();
  std::error_code ignored;  // a leftover file is harmless
  std::filesystem::remove(stem_ + ".state", ignored);
}

}  // namespace tress::experiments::scene_runs
