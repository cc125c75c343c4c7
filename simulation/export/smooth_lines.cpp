#include "simulation/export/smooth_lines.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace tress::simulation {
namespace {

constexpr double error_over_length = 1e-3;
constexpr int most_pieces = 32;
/// Near half a turn per element the points no longer determine the sense of rotation.
constexpr double most_turn = 150 * std::numbers::pi / 180;

/// One element of a line: its ends and its bending.
struct Element {
  Vec from, to;
  Vec at_from, at_to;  // h^2 a
  double theta = 0;

  double weight(double u) const {
    // Below, the two terms of w cancel to fewer than eight digits.
    if (theta < 1e-4) return u * (1 - u * u) / 6;
    return (std::sin(theta * u) / std::sin(theta) - u) / (2 - 2 * std::cos(theta));
  }
  Vec at(double u) const {
    return (1 - u) * from + u * to - weight(1 - u) * at_from - weight(u) * at_to;
  }
  /// Bound of |x''|.
  double bend() const {
    const double most = std::max(norm(at_from), norm(at_to));
    if (theta < 1e-4) return most;
    return most * theta * theta / ((2 - 2 * std::cos(theta)) * std::cos(theta / 2));
  }
};

double turn_of(double cosine) {
  return std::clamp(std::acos(std::clamp(cosine, -1.0, 1.0)), 0.0, most_turn);
}

/// Second divided differences at all points; at the ends by continuing the helix.
struct Bends {
  std::vector<Vec> a;
  std::vector<double> theta;  // of each element

  explicit Bends(std::span<const Vec> x) : a(x.size()), theta(x.size() - 1) {
    const std::size_t n = theta.size();
    for (std::size_t i = 1; i < n; ++i) {
      const Vec before = x[i] - x[i - 1], after = x[i + 1] - x[i];
      const double h = norm(before), k = norm(after);
      if (h > 0 && k > 0) a[i] = 2 / (h + k) * (1 / k * after - 1 / h * before);
    }
    if (n < 2) return;
    if (n == 2) {
      const Vec before = x[1] - x[0], after = x[2] - x[1];
      const double chords = norm(before) * norm(after);
      const double turn = chords > 0 ? turn_of(dot(before, after) / chords) : 0;
      theta = {turn, turn};
      a[0] = a[2] = a[1];
      return;
    }
    for (std::size_t j = 0; j < n; ++j) theta[j] = turn_of(cosine(j));
    a[0] = 2 * std::cos(theta[0]) * a[1] - a[2];
    a[n] = 2 * std::cos(theta[n - 1]) * a[n - 1] - a[n - 2];
  }

 private:
  /// Returns the cosine of the turn of element j, by least squares of a_{i-1} + a_{i+1} =
  /// 2 cos(theta) a_i. The equations are those at its two ends, or at the nearest points
  /// that have two neighbours. With three elements: the cosine of the angle between the
  /// only two a_i.
  double cosine(std::size_t j) const {
    const std::size_t n = theta.size();
    if (n == 3) {
      const double sizes = norm(a[1]) * norm(a[2]);
      return sizes > 0 ? dot(a[1], a[2]) / sizes : 1;
    }
    double product = 0, square = 0;
    for (const std::size_t end : {j, j + 1}) {
      const std::size_t i = std::clamp<std::size_t>(end, 2, n - 2);
      product += dot(a[i - 1] + a[i + 1], a[i]);
      square += 2 * dot(a[i], a[i]);
    }
    return square > 0 ? product / square : 1;
  }
};

std::vector<Element> elements(const float* x, std::size_t points) {
  std::vector<Vec> place(points);
  for (std::size_t i = 0; i < points; ++i) {
    place[i] = {static_cast<double>(x[3 * i]), static_cast<double>(x[3 * i + 1]),
                static_cast<double>(x[3 * i + 2])};
  }
  std::vector<Element> all;
  if (points < 2) return all;
  const Bends bends(place);
  for (std::size_t j = 0; j + 1 < points; ++j) {
    const Vec chord = place[j + 1] - place[j];
    const double square = dot(chord, chord);
    all.push_back({place[j], place[j + 1], square * bends.a[j], square * bends.a[j + 1],
                   bends.theta[j]});
  }
  return all;
}

std::size_t sized(int count) { return static_cast<std::size_t>(count); }

}  // namespace

SmoothLines::SmoothLines(std::span<const int> lines, std::span<const Frame3d> frames)
    : lines_(lines.begin(), lines.end()) {
  for (const int line : lines_) pieces_.insert(pieces_.end(), sized(line) - 1, 1);
  std::vector<double> longest_error;  // of each line
  std::size_t first = 0;
  for (const int line : lines_) {
    double length = 0;
    if (!frames.empty()) {
      for (const Element& e : elements(&frames[0].positions[3 * first], sized(line))) {
        length += norm(e.to - e.from);
      }
    }
    longest_error.push_back(error_over_length * length);
    first += sized(line);
  }
  for (const Frame3d& frame : frames) cut(frame, longest_error);
  std::size_t element = 0;
  for (const int line : lines_) {
    smooth_.push_back(1);
    for (int j = 0; j + 1 < line; ++j) smooth_.back() += pieces_[element++];
    points_ += sized(smooth_.back());
  }
}

void SmoothLines::cut(const Frame3d& frame, std::span<const double> longest_error) {
  std::size_t first = 0, element = 0;
  for (std::size_t k = 0; k < lines_.size(); ++k) {
    for (const Element& e : elements(&frame.positions[3 * first], sized(lines_[k]))) {
      const double wanted = std::ceil(std::sqrt(e.bend() / (8 * longest_error[k])));
      int& pieces = pieces_[element++];
      // False if values are not finite, as in a frame of a diverged run.
      if (wanted > pieces) pieces = static_cast<int>(std::min(wanted, 1.0 * most_pieces));
    }
    first += sized(lines_[k]);
  }
}

std::vector<float> SmoothLines::positions(const Frame3d& frame) const {
  std::vector<float> all;
  all.reserve(3 * points_);
  const auto add = [&all](const Vec& x) {
    for (const double c : {x.x, x.y, x.z}) all.push_back(static_cast<float>(c));
  };
  std::size_t first = 0, element = 0;
  for (const int line : lines_) {
    const float* x = &frame.positions[3 * first];
    all.insert(all.end(), x, x + 3);
    for (const Element& e : elements(x, sized(line))) {
      const int pieces = pieces_[element++];
      for (int p = 1; p < pieces; ++p) add(e.at(static_cast<double>(p) / pieces));
      add(e.to);
    }
    first += sized(line);
  }
  return all;
}

std::vector<float> SmoothLines::channels(const Frame3d& frame) const {
  std::vector<float> all;
  for (std::size_t i = 0; i < frame.channels.size();) {
    std::size_t element = 0;
    for (const int line : lines_) {
      all.push_back(frame.channels[i]);
      for (int j = 0; j + 1 < line; ++j, ++i) {
        const int pieces = pieces_[element++];
        for (int p = 1; p <= pieces; ++p) {
          all.push_back(std::lerp(frame.channels[i], frame.channels[i + 1],
                                  static_cast<float>(p) / static_cast<float>(pieces)));
        }
      }
      ++i;
    }
  }
  return all;
}

}  // namespace tress::simulation
