#pragma once

#include <cstddef>
#include <span>
#include <vector>

#include "models/contact/box_pairs.h"
#include "models/contact/segment_cells.h"

namespace tress::models {

/// How differently what is near a place has moved in one step: hair far away that moves
/// fast is of no account to lists of what is nearby. A uniform grid; each cell knows a
/// box that holds the displacements of all segments in it and in the cells beside it.
/// Memory is O(cells), of which there are less than segments; a step is O(segments).
class LocalDrift {
 public:
  /// Segments as they lie at x. A place is told of all parts of segments whose middles
  /// are no farther from it than `sight` (m) along each axis; not of long segments.
  void fill(const SegmentCells& segments, In x, double sight, const Loop& loop);
  /// The displacement of every point; one that is not finite is of no account. The result
  /// does not depend on who runs the loop's parts.
  void move(const SegmentCells& segments, std::span<const Vec> by, const Loop& loop);

  /// Of the step; least > most where nothing is near. `at`: a finite place at the time of
  /// fill().
  const Box& near(const Vec& at) const { return near_[cell(at)]; }
  /// Half the diagonal of that box, mean over all segments, m.
  double mean() const { return mean_; }

 private:
  std::size_t cell(const Vec& at) const noexcept;

  double inverse_side_ = 1;
  Vec corner_;
  int count_[3] = {1, 1, 1};
  std::vector<int> cell_of_;    // of parts of segments
  std::vector<int> parts_;      // in each cell
  std::vector<Box> own_;        // of cells, by pieces of work
  std::vector<Box> near_, at_;  // of cells, and when extended along some axes
  double mean_ = 0;
};

}  // namespace tress::models
