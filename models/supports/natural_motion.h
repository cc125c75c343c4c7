#pragma once

#include <utility>
#include <vector>

#include "contract/forms/natural_strains.h"
#include "models/strand/strand.h"

namespace tress::models {

/// Natural strains of a strand over time, linear between rows and constant beyond them:
/// muscles, and curls that dry.
class NaturalMotion {
 public:
  /// Natural turns of half an edge at the ends of a strand, from the middle of the edge
  /// to its end. They are twist and the two curvatures, rad.
  struct Halves {
    Vec root{}, tip{};  // at the root, at the tip
  };
  /// Returns the halves of a strand in its natural shape.
  static Halves halves(const Strand& strand);
  /// Natural strains at a time.
  struct Row {
    double time;                 // s
    std::vector<double> values;  // in the order of NaturalStrains::natural()
    Halves halves{};             // natural turns of the halves
  };
  NaturalMotion() = default;
  /// Takes at least one row, times ascending. `model`: the halves that the sections of
  /// the model have (Sections::Kind::natural_half).
  NaturalMotion(std::vector<Row> rows, const Halves& model)
      : rows_(std::move(rows)), model_(model) {}

  /// Returns true if there are rows.
  bool any() const { return !rows_.empty(); }
  /// Sets the natural strains of time t, if they differ from those set last.
  void set(NaturalStrains& strains, double t);
  /// Sets those of time t, continued by `ahead` (s) as they change at t.
  void set_beyond(NaturalStrains& strains, double t, double ahead);
  /// Returns the turn of a section at an end from the model's to that of the natural
  /// shape that was set last. The reference stays valid and follows set().
  const Frame& turn(bool tip) const { return tip ? to_tip_ : to_root_; }
  /// Returns the length of the interval between rows, s. 0: they are constant at t.
  double interval(double t) const;
  /// Returns true if the natural strains may differ within an interval of time.
  bool moves(double from, double to) const {
    return rows_.size() > 1 && from < rows_.back().time && to > rows_.front().time;
  }
  /// Returns the time of the first row after t, s; infinity: none.
  double next_breakpoint(double t) const;

 private:
  std::vector<Row> rows_;
  Halves model_;
  Frame to_root_, to_tip_;   // of the time that was set last
  std::vector<double> now_;  // scratch
  double set_ = 0;           // time that was set last, s
  bool begun_ = false;       // set_ is the time of the strains as they are
};

}  // namespace tress::models
