#pragma once

#include <string>
#include <vector>

#include "simulation/groom/curve_basis.h"
#include "simulation/groom/read_groom.h"
#include "simulation/groom/usd_transform.h"

namespace tress::simulation {

/// Reason for which USD does not render a prim [OpenUSD, UsdPrimDefaultPredicate,
/// UsdGeomImageable]: it is `inactive`, `undefined`, `abstract` or `invisible`, or its
/// purpose is `guide` or `proxy`. `no`: it is rendered.
enum class Hidden { no, inactive, undefined, abstract, invisible, guide, proxy };

/// The attributes of one BasisCurves.
struct UsdCurveSet {
  CurveBasis basis = CurveBasis::bezier;  // basis of the curves
  bool pinned = false;  // whether curves begin and end at their outer control points
  std::vector<std::size_t> counts;  // of the points of each curve
  std::vector<Vec> points;          // control points of all curves
  std::vector<double> widths;       // of all curves, of each, or of each control point
  int line = 0;                     // of the points
};

/// Curves of a stage, in the order of their prims. Properties that surround a prim act on
/// the curve sets that were added within it, which are known where the prim ends.
class UsdCurves {
 public:
  /// Names the file of `from` in messages. Takes widths if the settings say so.
  UsdCurves(ByteStream& from, const GroomReading& reading)
      : from_(from), reading_(reading) {}

  /// Returns the number of sets.
  std::size_t size() const { return sets_.size(); }
  /// Adds a set at the end. Widths for another interpolation than constant, uniform or
  /// vertex are left out, with a note.
  void add(const UsdCurveSet& set);
  /// The sets from `first` on lie within a prim with this map, which alone places them if
  /// `reset`.
  void place(std::size_t first, const Affine& map, bool reset);
  /// Marks the curves from `first` on as lying within a hidden prim.
  void hide(std::size_t first, Hidden why);
  /// Gives this purpose to the curves from `first` on that have none yet.
  void set_purpose(std::size_t first, Hidden why);

  /// The strands that are left, with notes on those that are not.
  void finish(GroomFile& made);

 private:
  struct Set {
    std::size_t first_point, first_strand;
    CurveBasis basis;
    bool pinned, placed = false, has_purpose = false;
    Hidden hidden = Hidden::no;
    // Curves whose count does not suit the basis, and the first of them.
    std::size_t unfit = 0, number = 0, count = 0;
    int line = 0;
    double lost = 0;      // largest share of a curve that its ends leave out
    bool unread = false;  // it has widths that are not read
  };
  std::size_t end_point(std::size_t set) const;
  std::size_t end_strand(std::size_t set) const;
  void leave_out_hidden(GroomFile& made);
  void judge_counts(GroomFile& made) const;
  void note_lost_ends(GroomFile& made) const;
  void finish_widths(GroomFile& made);

  ByteStream& from_;
  const GroomReading& reading_;
  Polylines lines_;
  std::vector<Set> sets_;
  std::size_t curves_ = 0;
};

}  // namespace tress::simulation
