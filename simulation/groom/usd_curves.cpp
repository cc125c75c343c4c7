#include "simulation/groom/usd_curves.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "contract/input_error.h"
#include "simulation/groom/groom_lengths.h"

namespace tress::simulation {
namespace {

constexpr std::array<std::string_view, 7> reasons{
    "",          "inactive",         "without def (over)", "of a class",
    "invisible", "of purpose guide", "of purpose proxy"};

/// The widths of a set, of which one of three interpolations is told by their number.
class Widths {
 public:
  explicit Widths(const UsdCurveSet& set)
      : all_(set.widths),
        basis_(set.basis),
        pinned_(set.pinned),
        of_point_(all_.size() > 1 && all_.size() == set.points.size()),
        of_curve_(!of_point_ && all_.size() > 1 && all_.size() == set.counts.size()) {}

  /// Whether they have another number.
  bool unread() const { return all_.size() > 1 && !of_point_ && !of_curve_; }
  /// Appends the widths of the points on a curve, NaN where there are none.
  void append(std::size_t curve, std::size_t from, std::size_t control, std::size_t on,
              std::vector<double>& to) const {
    if (!of_point_) {
      const double one = unread() || all_.empty()
                             ? std::numeric_limits<double>::quiet_NaN()
                             : all_[of_curve_ ? curve : 0];
      to.insert(to.end(), on, one);
      return;
    }
    std::vector<Vec> of_control;
    for (const double width : std::span(all_).subspan(from, control)) {
      of_control.push_back({width, 0, 0});
    }
    for (const Vec& x : points_on(of_control, basis_, pinned_)) to.push_back(x.x);
  }

 private:
  const std::vector<double>& all_;
  CurveBasis basis_;
  bool pinned_, of_point_, of_curve_;
};

}  // namespace

void UsdCurves::add(const UsdCurveSet& set) {
  Set made{lines_.points.size(), lines_.size(), set.basis, set.pinned};
  made.line = set.line;
  std::size_t from = 0, points = lines_.points.size();
  for (const std::size_t count : set.counts) {
    if (count > set.points.size() - from) {
      from_.refuse_text(fmt::format("curves of more than the {} points that there are",
                                    set.points.size()),
                        "the file is damaged: write it again");
    }
    from += count;
    points += points_of_curve(count, set.basis, set.pinned);
  }
  if (from != set.points.size()) {
    from_.refuse_text(
        fmt::format("curves of {} points where there are {}", from, set.points.size()),
        "the file is damaged: write it again");
  }
  if (points > lines_.points.capacity()) {
    lines_.points.reserve(std::max(points, lines_.points.capacity() * 5 / 4));
  }
  const Widths widths(set);
  made.unread = widths.unread();
  std::size_t after = 0, curve = 0;
  for (const std::size_t count : set.counts) {
    from = after;
    const std::span control = std::span(set.points).subspan(from, count);
    after += count;
    const std::size_t number = curves_++, of_set = curve++;
    if (points_of_curve(count, set.basis, set.pinned) == 0) {
      if (made.unfit++ == 0) {
        made.number = number;
        made.count = count;
      }
      continue;
    }
    const std::vector<Vec> on = points_on(control, set.basis, set.pinned);
    const double ends =
        norm(on.front() - control.front()) + norm(on.back() - control.back());
    if (ends > 0) made.lost = std::max(made.lost, ends / polyline_length(control));
    lines_.points.insert(lines_.points.end(), on.begin(), on.end());
    if (reading_.widths) widths.append(of_set, from, count, on.size(), lines_.widths);
    lines_.end_strand(number, static_cast<std::uint64_t>(set.line));
  }
  sets_.push_back(made);
}

std::size_t UsdCurves::end_point(std::size_t set) const {
  return set + 1 < sets_.size() ? sets_[set + 1].first_point : lines_.points.size();
}
std::size_t UsdCurves::end_strand(std::size_t set) const {
  return set + 1 < sets_.size() ? sets_[set + 1].first_strand : lines_.size();
}

void UsdCurves::place(std::size_t first, const Affine& map, bool reset) {
  for (std::size_t k = first; k < sets_.size(); ++k) {
    if (sets_[k].placed) continue;
    const Mat3& m = map.linear;
    const double size = std::cbrt(std::abs(dot(m.r0, cross(m.r1, m.r2))));
    for (std::size_t i = sets_[k].first_point; i < end_point(k); ++i) {
      lines_.points[i] = map(lines_.points[i]);
      if (!lines_.widths.empty()) lines_.widths[i] *= size;
    }
    sets_[k].placed = reset;
  }
}

void UsdCurves::hide(std::size_t first, Hidden why) {
  for (std::size_t k = first; k < sets_.size(); ++k) {
    if (sets_[k].hidden == Hidden::no) sets_[k].hidden = why;
  }
}

void UsdCurves::set_purpose(std::size_t first, Hidden why) {
  for (std::size_t k = first; k < sets_.size(); ++k) {
    if (sets_[k].has_purpose) continue;
    sets_[k].has_purpose = true;
    if (sets_[k].hidden == Hidden::no) sets_[k].hidden = why;
  }
}

void UsdCurves::leave_out_hidden(GroomFile& made) {
  std::array<std::size_t, reasons.size()> count{};
  Polylines shown;
  for (std::size_t k = 0; k < sets_.size(); ++k) {
    count[static_cast<std::size_t>(sets_[k].hidden)] +=
        end_strand(k) - sets_[k].first_strand;
  }
  std::string said;
  for (std::size_t i = 1; i < count.size(); ++i) {
    if (count[i] == 0) continue;
    said += fmt::format("{}{} {}", said.empty() ? "" : ", ", count[i], reasons[i]);
  }
  if (said.empty()) return;
  if (reading_.hidden) {
    made.notes.push_back(
        fmt::format("curves that USD does not render are taken: {}", said));
    return;
  }
  if (count[0] == 0) {
    throw InputError(fmt::format("no curve that USD renders: {}", said), from_.file(),
                     "give hidden_strands = \"take\", or show them and export again");
  }
  made.notes.push_back(fmt::format(
      "curves that USD does not render are left out: {} (hidden_strands = \"take\" takes "
      "them)",
      said));
  for (std::size_t k = 0; k < sets_.size(); ++k) {
    if (sets_[k].hidden != Hidden::no) continue;
    for (std::size_t i = sets_[k].first_strand; i < end_strand(k); ++i) {
      const std::span<const Vec> x = lines_.strand(i);
      const std::span<const double> widths = lines_.widths_of(i);
      shown.points.insert(shown.points.end(), x.begin(), x.end());
      shown.widths.insert(shown.widths.end(), widths.begin(), widths.end());
      shown.end_strand(lines_.numbers[i], lines_.places[i]);
    }
  }
  lines_ = std::move(shown);
  std::erase_if(sets_, [](const Set& set) { return set.hidden != Hidden::no; });
}

void UsdCurves::judge_counts(GroomFile& made) const {
  std::size_t unfit = 0;
  for (const Set& set : sets_) {
    if (set.unfit == 0) continue;
    unfit += set.unfit;
    if (reading_.bad == BadStrands::drop) continue;
    throw InputError(
        fmt::format("strand {} has {} point{}, but {}", set.number, set.count,
                    set.count == 1 ? "" : "s", counts_in_words(set.basis, set.pinned)),
        fmt::format("{}: line {}", from_.file(), set.line),
        "export with another type, basis or wrap, or give bad_strands = \"drop\" to "
        "leave "
        "such out");
  }
  if (unfit == 0) return;
  made.notes.push_back(
      fmt::format("{} strand{} left out: the number of points does not suit the basis",
                  unfit, unfit == 1 ? "" : "s"));
}

void UsdCurves::note_lost_ends(GroomFile& made) const {
  double lost = 0;
  for (const Set& set : sets_) {
    if (!set.pinned && set.basis != CurveBasis::linear) lost = std::max(lost, set.lost);
  }
  if (lost == 0) return;
  made.notes.push_back(fmt::format(
      "curves that are not pinned begin near their second point and end near the last "
      "but "
      "one, as USD draws them: up to {:.2g} % of a strand's length is lost at its root "
      "and tip (wrap = \"pinned\" in the file keeps it)",
      100 * lost));
}

void UsdCurves::finish_widths(GroomFile& made) {
  if (reading_.widths && std::ranges::any_of(sets_, &Set::unread)) {
    made.notes.emplace_back(
        "widths are read where there is one for all curves, one for each, or one for "
        "each control point; those of some curves have another number");
  }
  const bool none =
      std::ranges::all_of(lines_.widths, [](double x) { return std::isnan(x); });
  if (none) lines_.widths = {};
}

void UsdCurves::finish(GroomFile& made) {
  leave_out_hidden(made);
  judge_counts(made);
  note_lost_ends(made);
  finish_widths(made);
  made.lines = std::move(lines_);
}

}  // namespace tress::simulation
