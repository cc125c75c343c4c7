#include "simulation/groom/curve_basis.h"

#include <array>

namespace tress::simulation {
namespace {

constexpr std::size_t parts_of_piece = 4;

/// Weights of the four control points of a piece at u in [0, 1].
std::array<double, 4> weights(CurveBasis basis, double u) {
  const double v = 1 - u;
  if (basis == CurveBasis::bezier) {
    return {v * v * v, 3 * u * v * v, 3 * u * u * v, u * u * u};
  }
  if (basis == CurveBasis::bspline) {
    return {v * v * v / 6, (3 * u * u * u - 6 * u * u + 4) / 6,
            (3 * v * v * v - 6 * v * v + 4) / 6, u * u * u / 6};
  }
  return {-0.5 * u * v * v, (3 * u * u * u - 5 * u * u + 2) / 2,
          (3 * v * v * v - 5 * v * v + 2) / 2, -0.5 * u * u * v};
}

}  // namespace

std::optional<CurveBasis> curve_basis(std::string_view type, std::string_view basis) {
  if (type == "linear") return CurveBasis::linear;
  if (type != "cubic") return std::nullopt;
  if (basis == "bezier") return CurveBasis::bezier;
  if (basis == "bspline") return CurveBasis::bspline;
  if (basis == "catmullRom") return CurveBasis::catmull_rom;
  return std::nullopt;
}

std::size_t points_of_curve(std::size_t control, CurveBasis basis, bool pinned) {
  if (basis == CurveBasis::linear) return control < 2 ? 0 : control;
  if (basis == CurveBasis::bezier) {
    return control < 4 || (control - 4) % 3 != 0 ? 0
                                                 : (control - 1) / 3 * parts_of_piece + 1;
  }
  const std::size_t least = pinned ? 2 : 4;
  return control < least ? 0 : (control - (least - 1)) * parts_of_piece + 1;
}

std::string counts_in_words(CurveBasis basis, bool pinned) {
  if (basis == CurveBasis::linear) return "linear curves need 2 points or more";
  if (basis == CurveBasis::bezier) return "bezier curves need 4, 7, 10, ... points";
  const std::string name = basis == CurveBasis::bspline ? "bspline" : "catmullRom";
  return pinned ? "pinned " + name + " curves need 2 points or more"
                : name + " curves that are not pinned need 4 points or more";
}

std::vector<Vec> points_on(std::span<const Vec> control, CurveBasis basis, bool pinned) {
  std::vector<Vec> on;
  const std::size_t count = points_of_curve(control.size(), basis, pinned);
  if (count == 0) return on;
  if (basis == CurveBasis::linear) return {control.begin(), control.end()};
  const std::size_t step = basis == CurveBasis::bezier ? 3 : 1;
  std::vector<Vec> points(control.begin(), control.end());
  if (basis != CurveBasis::bezier && pinned) {
    // Phantom points: the end pieces then begin and end at the outer points.
    const std::size_t n = points.size();
    const Vec first = 2.0 * points[0] - points[1];
    const Vec last = 2.0 * points[n - 1] - points[n - 2];
    points.insert(points.begin(), first);
    points.push_back(last);
  }
  on.reserve(count);
  const auto add = [&](std::size_t i, double u) {
    const std::array<double, 4> w = weights(basis, u);
    on.push_back(w[0] * points[i] + w[1] * points[i + 1] + w[2] * points[i + 2] +
                 w[3] * points[i + 3]);
  };
  std::size_t i = 0;
  for (; i + 3 < points.size(); i += step) {
    for (std::size_t k = 0; k < parts_of_piece; ++k) {
      add(i, static_cast<double>(k) / parts_of_piece);
    }
  }
  add(i - step, 1);
  return on;
}

}  // namespace tress::simulation
