#include "models/contact/distance_grid.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>
#include <type_traits>

#include "contract/decimal.h"
#include "contract/input_error.h"
#include "contract/read_file.h"

namespace tress::models {
namespace {

constexpr std::size_t most_points = 20'000'000;
constexpr std::size_t most_bytes = 1 << 29;  // of a file, some 25 for each point

/// Weights of the four points around a place u in [0, 1] between the middle two, and
/// their derivatives by u [Keys 1981, eq. 15].
struct Weights {
  std::array<double, 4> w, slope, curvature;
};

Weights weights(double u) {
  const double u2 = u * u, u3 = u2 * u;
  return {
      {-0.5 * u3 + u2 - 0.5 * u, 1.5 * u3 - 2.5 * u2 + 1, -1.5 * u3 + 2 * u2 + 0.5 * u,
       0.5 * u3 - 0.5 * u2},
      {-1.5 * u2 + 2 * u - 0.5, 4.5 * u2 - 5 * u, -4.5 * u2 + 4 * u + 0.5, 1.5 * u2 - u},
      {-3 * u + 2, 9 * u - 5, -9 * u + 4, 3 * u - 1}};
}

/// The numbers of a file, one after the other.
class Numbers {
 public:
  explicit Numbers(const std::string& file)
      : file_(file), text_(read_file(file, most_bytes)), rest_(text_) {}

  template <class T>
  T next(const char* what) {
    const std::string_view word = next_word();
    const std::optional<T> x = read<T>(word);
    if (word.empty()) {
      throw InputError(std::string("the file ends before ") + what, where(),
                       "give nx ny nz, the origin, the spacing and nx ny nz values");
    }
    if (!x) {
      throw InputError("'" + std::string(word.substr(0, 40)) + "' is not " + what,
                       where(), "give numbers, separated by blanks");
    }
    return *x;
  }
  /// Throws when there is more.
  void finish() {
    if (next_word().empty()) return;
    throw InputError("more than nx ny nz values", where(),
                     "check nx ny nz in the first line");
  }
  std::string where() const {
    // Trailing line ends do not start a new line.
    const std::size_t end = text_.find_last_not_of(" \t\r\n") + 1;
    const auto read =
        static_cast<std::ptrdiff_t>(std::min(end, text_.size() - rest_.size()));
    const auto lines = std::count(text_.begin(), text_.begin() + read, '\n');
    return file_ + ":" + std::to_string(lines + 1);
  }

 private:
  template <class T>
  static std::optional<T> read(std::string_view word) {
    if constexpr (std::is_floating_point_v<T>) {
      return decimal(word);
    } else {
      T x{};
      const char* const last = word.data() + word.size();
      const auto [end, error] = std::from_chars(word.data(), last, x);
      return error == std::errc{} && end == last ? std::optional(x) : std::nullopt;
    }
  }
  std::string_view next_word() {
    rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size()));
    while (rest_.starts_with('#')) {
      rest_.remove_prefix(std::min(rest_.find('\n'), rest_.size()));
      rest_.remove_prefix(std::min(rest_.find_first_not_of(" \t\r\n"), rest_.size()));
    }
    const std::string_view word = rest_.substr(0, rest_.find_first_of(" \t\r\n#"));
    rest_.remove_prefix(word.size());
    return word;
  }

  std::string file_, text_;
  std::string_view rest_;  // of the text: what is not read yet
};

}  // namespace

/// The 4 x 4 x 4 points around a position; `first` is empty if the grid lacks them.
struct DistanceGrid::Cell {
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();
  std::size_t first = none;
  Weights x, y, z;

  /// sum of values times one weight of each direction
  double sum(const Samples& s, const std::array<double, 4>& wx,
             const std::array<double, 4>& wy, const std::array<double, 4>& wz) const {
    double all = 0;
    for (std::size_t k = 0; k < 4; ++k) {
      for (std::size_t j = 0; j < 4; ++j) {
        const double* row = &s.value[first + s.nx * (j + s.ny * k)];
        all += wz[k] * wy[j] *
               (wx[0] * row[0] + wx[1] * row[1] + wx[2] * row[2] + wx[3] * row[3]);
      }
    }
    return all;
  }
};

DistanceGrid::DistanceGrid(Samples samples, const std::string& where)
    : s_(std::move(samples)) {
  if (std::min({s_.nx, s_.ny, s_.nz}) < 4 ||
      std::max({s_.nx, s_.ny, s_.nz}) > most_points || s_.nx * s_.ny > most_points ||
      s_.nx * s_.ny * s_.nz > most_points) {
    throw InputError("the grid is too small or too large", where,
                     "give at least 4 points each way and at most 2e7 in all");
  }
  if (s_.value.size() != s_.nx * s_.ny * s_.nz) {
    throw InputError("not nx ny nz values", where, "give one value per point");
  }
  const auto finite = [](double x) { return std::isfinite(x); };
  if (!(s_.spacing > 0) || !finite(s_.spacing) || !is_finite(s_.origin) ||
      !std::ranges::all_of(s_.value, finite)) {
    throw InputError("spacing is not positive or a number is not finite", where,
                     "give spacing > 0 and finite numbers in m");
  }
}

DistanceGrid::Cell DistanceGrid::cell(const Vec& x) const {
  const Vec at = (1 / s_.spacing) * (x - s_.origin);
  Cell cell;
  // With the point before and the two after it; NaN is not inside.
  const auto inside = [](double place, std::size_t n) {
    return place >= 1 && place <= static_cast<double>(n - 2);
  };
  if (!inside(at.x, s_.nx) || !inside(at.y, s_.ny) || !inside(at.z, s_.nz)) return cell;
  const auto before = [](double place, std::size_t n) {
    return std::min(static_cast<std::size_t>(place), n - 3);
  };
  const std::size_t i = before(at.x, s_.nx), j = before(at.y, s_.ny),
                    k = before(at.z, s_.nz);
  cell.first = (i - 1) + s_.nx * ((j - 1) + s_.ny * (k - 1));
  cell.x = weights(at.x - static_cast<double>(i));
  cell.y = weights(at.y - static_cast<double>(j));
  cell.z = weights(at.z - static_cast<double>(k));
  return cell;
}

Distance DistanceGrid::distance(const Vec& x) const {
  const Cell c = cell(x);
  if (c.first == Cell::none) return {std::numeric_limits<double>::infinity(), {}};
  return {c.sum(s_, c.x.w, c.y.w, c.z.w),
          (1 / s_.spacing) * Vec{c.sum(s_, c.x.slope, c.y.w, c.z.w),
                                 c.sum(s_, c.x.w, c.y.slope, c.z.w),
                                 c.sum(s_, c.x.w, c.y.w, c.z.slope)}};
}

Mat3 DistanceGrid::curvature(const Vec& x) const {
  const Cell c = cell(x);
  if (c.first == Cell::none) return {};
  const double xx = c.sum(s_, c.x.curvature, c.y.w, c.z.w);
  const double yy = c.sum(s_, c.x.w, c.y.curvature, c.z.w);
  const double zz = c.sum(s_, c.x.w, c.y.w, c.z.curvature);
  const double xy = c.sum(s_, c.x.slope, c.y.slope, c.z.w);
  const double xz = c.sum(s_, c.x.slope, c.y.w, c.z.slope);
  const double yz = c.sum(s_, c.x.w, c.y.slope, c.z.slope);
  return (1 / (s_.spacing * s_.spacing)) * Mat3{{xx, xy, xz}, {xy, yy, yz}, {xz, yz, zz}};
}

double DistanceGrid::clearance() const {
  const auto outer = [](std::size_t i, std::size_t n) { return i < 2 || i + 2 >= n; };
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < s_.nz; ++k) {
    for (std::size_t j = 0; j < s_.ny; ++j) {
      for (std::size_t i = 0; i < s_.nx; ++i) {
        if (outer(i, s_.nx) || outer(j, s_.ny) || outer(k, s_.nz)) {
          least = std::min(least, s_.value[i + s_.nx * (j + s_.ny * k)]);
        }
      }
    }
  }
  return least;
}

DistanceGrid read_distance_grid(const std::string& file) {
  Numbers numbers(file);
  DistanceGrid::Samples s;
  for (std::size_t* n : {&s.nx, &s.ny, &s.nz}) {
    *n = numbers.next<std::size_t>("a number of points (nx ny nz)");
    if (*n < 4 || *n > most_points) {
      throw InputError("the grid is too small or too large", numbers.where(),
                       "give at least 4 points each way and at most 2e7 in all");
    }
  }
  if (s.nx * s.ny > most_points || s.nx * s.ny * s.nz > most_points) {
    throw InputError("the grid is too large", numbers.where(),
                     "give at most 2e7 points in all");
  }
  for (double* x : {&s.origin.x, &s.origin.y, &s.origin.z}) {
    *x = numbers.next<double>("a number of the origin");
  }
  s.spacing = numbers.next<double>("the spacing");
  if (!(s.spacing > 0)) {
    throw InputError("the spacing is not positive", numbers.where(), "give it in m, > 0");
  }
  // No reserve(): the header may announce more values than the file holds.
  for (std::size_t i = 0; i < s.nx * s.ny * s.nz; ++i) {
    s.value.push_back(numbers.next<double>("a distance"));
    if (!std::isfinite(s.value.back())) {
      throw InputError("a distance is not finite", numbers.where(), "give numbers in m");
    }
  }
  numbers.finish();
  return DistanceGrid(std::move(s), file);
}

}  // namespace tress::models
