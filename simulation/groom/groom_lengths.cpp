#include "simulation/groom/groom_lengths.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace tress::simulation {
namespace {

constexpr double much_longer = 4, much_shorter = 0.1;  // than the median
constexpr double long_piece = 10;                      // than the median piece

/// Index of the last point of a piece that is longer than all others together; 0: none.
std::size_t long_piece_of(std::span<const Vec> x) {
  constexpr std::size_t fewest = 4;  // points of which one may stand out
  if (x.size() < fewest) return 0;
  std::vector<double> pieces;
  double whole = 0;
  for (std::size_t i = 1; i < x.size(); ++i) {
    pieces.push_back(norm(x[i] - x[i - 1]));
    whole += pieces.back();
  }
  const auto longest = std::ranges::max_element(pieces);
  const double most = *longest;
  const auto at = static_cast<std::size_t>(longest - pieces.begin()) + 1;
  if (!(most > whole / 2)) return 0;
  const auto middle = pieces.begin() + static_cast<std::ptrdiff_t>(pieces.size() / 2);
  std::ranges::nth_element(pieces, middle);
  return most > long_piece * *middle ? at : 0;
}

/// "lengths: median 0.1 m, half of the strands 0.09 m to 0.11 m, all 0.08 m to 0.12 m"
std::string lengths_in_words(double median, std::pair<double, double> half,
                             std::pair<double, double> all) {
  const auto text = [](double length) { return fmt::format("{:.3g} m", length); };
  const std::string shortest = text(all.first), longest = text(all.second);
  if (shortest == longest) return fmt::format("lengths: {} each", shortest);
  return fmt::format("lengths: median {}, half of the strands {} to {}, all {} to {}",
                     text(median), text(half.first), text(half.second), shortest,
                     longest);
}

}  // namespace

double polyline_length(std::span<const Vec> points) {
  double length = 0;
  for (std::size_t i = 1; i < points.size(); ++i) {
    length += norm(points[i] - points[i - 1]);
  }
  return length;
}

std::vector<std::string> notes_on_lengths(const Polylines& lines) {
  if (lines.size() == 0) return {};
  std::vector<double> lengths;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    lengths.push_back(polyline_length(lines.strand(k)));
  }
  std::vector<double> sorted = lengths;
  std::ranges::sort(sorted);
  const auto quantile = [&](double share) {
    return sorted[static_cast<std::size_t>(share *
                                           static_cast<double>(sorted.size() - 1))];
  };
  const double median = quantile(0.5);
  std::vector<std::string> notes{lengths_in_words(
      median, {quantile(0.25), quantile(0.75)}, {sorted.front(), sorted.back()})};
  const auto point_at = [&](const auto& stands_out, double limit, std::string_view how) {
    const auto count = std::ranges::count_if(lengths, stands_out);
    if (count == 0) return;
    const auto first = std::ranges::find_if(lengths, stands_out) - lengths.begin();
    const auto k = static_cast<std::size_t>(first);
    notes.push_back(fmt::format(
        "{} of {} strands are {} than {:g} times the median, the first of them strand "
        "{}: {:.3g} m",
        count, lines.size(), how, limit, lines.numbers[k], lengths[k]));
  };
  point_at([median](double l) { return l > much_longer * median; }, much_longer,
           "longer");
  point_at([median](double l) { return l < much_shorter * median; }, much_shorter,
           "shorter");
  std::size_t count = 0, first = 0, end = 0;
  for (std::size_t k = 0; k < lines.size(); ++k) {
    const std::size_t at = long_piece_of(lines.strand(k));
    if (at == 0) continue;
    if (count++ > 0) continue;
    first = k;
    end = at;
  }
  if (count > 0) {
    const std::span<const Vec> x = lines.strand(first);
    notes.push_back(fmt::format(
        "in {} of {} strands one piece is longer than all others together, the first of "
        "them strand {} from point {} to {}: {:.3g} m of {:.3g} m",
        count, lines.size(), lines.numbers[first], end - 1, end,
        norm(x[end] - x[end - 1]), lengths[first]));
  }
  return notes;
}

}  // namespace tress::simulation
