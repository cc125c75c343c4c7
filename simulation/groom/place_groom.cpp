#include "simulation/groom/place_groom.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "contract/input_error.h"
#include "simulation/groom/groom_lengths.h"
#include "simulation/groom/space_curve.h"

namespace tress::simulation {
namespace {

constexpr double farthest = 1e3;       // m
constexpr double usual_length = 0.15;  // m, of hair

/// The middle one of the lengths that are finite and not 0; 0: none is.
double middle_length(const Polylines& lines) {
  std::vector<double> lengths;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const double length = polyline_length(lines.strand(k));
    if (std::isfinite(length) && length > 0) lengths.push_back(length);
  }
  if (lengths.empty()) return 0;
  const auto middle = lengths.begin() + static_cast<std::ptrdiff_t>(lengths.size() / 2);
  std::ranges::nth_element(lengths, middle);
  return *middle;
}

std::string axis_name(const FileAxis& up) {
  return std::string(up.back ? "-" : "") + "xyz"[up.axis];
}

/// Among the decimal ones: hair in inches looks like hair in centimetres.
const FileUnit& guessed_unit(double length) {
  return *std::ranges::min_element(file_units, {}, [length](const FileUnit& unit) {
    const double ratio = std::abs(std::log(length * unit.metres / usual_length));
    return unit.name == "inch" ? std::numeric_limits<double>::infinity() : ratio;
  });
}

/// Sums over strands of directions of length 1.
struct Directions {
  Vec run;   // from root to tip
  Vec bend;  // of the last piece less that of the first
  double strands = 0;
};

Directions directions_of(const Polylines& lines) {
  const auto unit = [](const Vec& x) { return norm(x) > 0 ? 1 / norm(x) * x : Vec{}; };
  Directions sum;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const std::span<const Vec> x = lines.strand(k);
    if (x.size() < 2) continue;
    const Vec run = unit(x.back() - x.front());
    const Vec bend = unit(x.back() - x[x.size() - 2]) - unit(x[1] - x[0]);
    if (!is_finite(run) || !is_finite(bend)) continue;
    sum.run = sum.run + run;
    sum.bend = sum.bend + bend;
    sum.strands += 1;
  }
  return sum;
}

/// The axis against which hair hangs.
FileAxis guessed_up(const Polylines& lines, const std::string& file) {
  constexpr double least_bend = 0.2;  // of a strand, on average
  const Directions sum = directions_of(lines);
  const std::array<double, 3> run{sum.run.x, sum.run.y, sum.run.z},
      bend{sum.bend.x, sum.bend.y, sum.bend.z};
  const auto most = std::ranges::max_element(
      run, [](double a, double b) { return std::abs(a) < std::abs(b); });
  const auto axis = static_cast<std::size_t>(most - run.begin());
  const FileAxis against{static_cast<int>(axis), *most > 0};
  const double bends = *most > 0 ? bend[axis] : -bend[axis];
  if (bends > least_bend * sum.strands) return against;
  throw InputError(
      "the file has no axis that points up, and its strands do not show one", file,
      fmt::format("give up = \"{}\" if they hang, up = \"{}\" if they stand, or another "
                  "axis",
                  axis_name(against), axis_name({against.axis, !against.back})));
}

Vec upright(const Vec& x, const FileAxis& up) {
  const Vec y = up.axis == 0 ? Vec{x.y, x.z, x.x} : up.axis == 1 ? Vec{x.z, x.x, x.y} : x;
  return up.back ? Vec{y.x, -y.y, -y.z} : y;
}

/// Goes through the strands of a file and keeps those that are good.
class Cleaning {
 public:
  Cleaning(const GroomFile& read, const std::string& file, BadStrands bad)
      : read_(read), file_(file), bad_(bad) {}

  /// Strand k with these points and widths, which it may change. No widths: none are
  /// taken.
  void add(std::size_t k, std::vector<Vec>& x, std::vector<double>& widths) {
    const std::size_t before = x.size();
    if (before < 2) {
      return leave_out(k, fmt::format("has {} point{}", before, before == 1 ? "" : "s"),
                       few_);
    }
    for (std::size_t i = 0; i < before; ++i) {
      const bool finite = is_finite(x[i]);
      if (finite && norm(x[i]) <= farthest) continue;
      return leave_out(k,
                       finite ? fmt::format("has point {} {:.3g} m away", i, norm(x[i]))
                              : fmt::format("has point {} that is not finite", i),
                       far_);
    }
    for (std::size_t i = 0; i < widths.size(); ++i) {
      if (widths[i] > 0 && widths[i] <= farthest) continue;
      return leave_out(k, fmt::format("has width {:.3g} m at point {}", widths[i], i),
                       thin_);
    }
    const auto repeats = [](const Vec& a, const Vec& b) {
      return !(norm(b - a) >= 2 * SpaceCurve::least_step);
    };
    const auto twice = std::adjacent_find(x.begin(), x.end(), repeats);
    if (twice != x.end()) {
      if (bad_ == BadStrands::refuse) {
        refuse(k, fmt::format("has point {} twice", twice - x.begin()));
      }
      std::size_t kept = 1;
      for (std::size_t i = 1; i < before; ++i) {
        if (repeats(x[kept - 1], x[i])) continue;
        if (!widths.empty()) widths[kept] = widths[i];
        x[kept++] = x[i];
      }
      x.resize(kept);
      if (!widths.empty()) widths.resize(kept);
      repeated_ += before - x.size();
      if (x.size() < 2) return leave_out(k, "has one point, repeated", few_);
    }
    lines.points.insert(lines.points.end(), x.begin(), x.end());
    lines.widths.insert(lines.widths.end(), widths.begin(), widths.end());
    lines.end_strand(read_.lines.numbers[k], read_.lines.places[k]);
  }

  void note(std::vector<std::string>& notes) const {
    const auto say = [&](std::size_t count, const char* what) {
      if (count > 0) notes.push_back(fmt::format("{} {}", count, what));
    };
    say(few_, "strands of fewer than two points are left out");
    say(far_, "strands with points that are not finite, or far away, are left out");
    say(thin_, "strands with a width that is not above 0 are left out");
    say(repeated_, "repeated points are left out");
  }

  Polylines lines;

 private:
  [[noreturn]] void refuse(std::size_t k, const std::string& what) const {
    const std::uint64_t place = read_.lines.places[k];
    const std::string where =
        place == 0 ? file_
                   : fmt::format("{}: {} {}", file_, read_.text ? "line" : "byte", place);
    throw InputError(fmt::format("strand {} {}", read_.lines.numbers[k], what), where,
                     "mend the file, or give bad_strands = \"drop\" to leave such out");
  }
  void leave_out(std::size_t k, const std::string& what, std::size_t& count) const {
    if (bad_ == BadStrands::refuse) refuse(k, what);
    ++count;
  }

  const GroomFile& read_;
  const std::string& file_;
  BadStrands bad_;
  mutable std::size_t few_ = 0, far_ = 0, thin_ = 0;
  std::size_t repeated_ = 0;
};

/// Metres per unit.
double unit_of(const GroomFile& read, const std::string& file,
               const GroomPlacing& placing, std::vector<std::string>& notes) {
  if (placing.metres) return *placing.metres;
  if (read.metres) return *read.metres;
  if (read.format_metres) {
    notes.push_back(
        fmt::format("the file has no unit: {:g} m, the unit of its format (same as "
                    "unit_m = {:g})",
                    *read.format_metres, *read.format_metres));
    return *read.format_metres;
  }
  const double middle = middle_length(read.lines);
  if (middle == 0) {
    throw InputError("no strand has a length", file, "give a file with strands");
  }
  const FileUnit& unit = guessed_unit(middle);
  notes.push_back(
      fmt::format("the unit is guessed: {}, so that half of the strands are longer "
                  "than {:.3g} m (same as unit = \"{}\")",
                  unit.name, middle * unit.metres, unit.name));
  return unit.metres;
}

FileAxis axis_of(const GroomFile& read, const std::string& file,
                 const GroomPlacing& placing, std::vector<std::string>& notes) {
  if (placing.up) return *placing.up;
  if (read.up) return *read.up;
  const FileAxis up = read.format_up ? *read.format_up : guessed_up(read.lines, file);
  notes.push_back(
      read.format_up
          ? fmt::format(
                "the file has no axis that points up: {0}, the axis of its format "
                "(same as up = \"{0}\")",
                axis_name(up))
          : fmt::format(
                "the axis that points up is guessed: {0}, against which hair hangs "
                "(same as up = \"{0}\")",
                axis_name(up)));
  return up;
}

}  // namespace

PlacedGroom place_groom(GroomFile read, const std::string& file,
                        const GroomPlacing& placing) {
  PlacedGroom placed;
  placed.file = file;
  placed.notes = read.notes;
  const double metres = unit_of(read, file, placing, placed.notes);
  const FileAxis up = axis_of(read, file, placing, placed.notes);
  Cleaning cleaning(read, file, placing.bad);
  cleaning.lines.points.reserve(read.lines.points.size() / placing.every);
  refuse_if(
      placing.widths && read.lines.widths.empty(),
      "the file has no widths that can be read", file,
      "leave out widths = \"file\", or export one width, one for each curve, or one "
      "for each control point (attribute widths of a .usda)");
  std::vector<Vec> x;
  std::vector<double> widths;
  for (std::size_t k = 0; k < read.lines.size(); k += placing.every) {
    x.clear();
    widths.clear();
    for (const Vec& point : read.lines.strand(k)) {
      x.push_back(placing.position + metres * upright(point, up));
    }
    if (placing.widths) {
      for (const double width : read.lines.widths_of(k)) widths.push_back(metres * width);
    }
    cleaning.add(k, x, widths);
  }
  cleaning.note(placed.notes);
  placed.lines = std::move(cleaning.lines);
  if (placed.lines.size() == 0) {
    throw InputError("no strand is left", file, "give a file with strands");
  }
  for (std::string& note : notes_on_lengths(placed.lines)) {
    placed.notes.push_back(std::move(note));
  }
  return placed;
}

}  // namespace tress::simulation
