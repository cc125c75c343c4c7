#include <algorithm>
#include <cmath>
#include <numbers>

#include "contract/input_error.h"
#include "simulation/groom/frames.h"
#include "simulation/groom/space_curve.h"
#include "simulation/scene/shapes.h"

namespace tress::simulation {
namespace {

constexpr std::size_t most_curve_points = 10'000;
constexpr int curve_parts =
    16;  // steps of a numerical integral between two points or joints

}  // namespace

PointCurve through_points(std::span<const double> points, int elements, double grading,
                          Vec normal, const std::string& where) {
  const std::size_t count = points.size() / 3;
  if (count < 3 || count > most_curve_points) {
    throw InputError("a curve through " + std::to_string(count) + " points", where,
                     "give 3 to " + std::to_string(most_curve_points) + " points");
  }
  std::vector<Vec> places;
  for (std::size_t i = 0; i < count; ++i) places.push_back(load3(&points[3 * i]));
  const SpaceCurve curve(places, curve_parts, where);
  PointCurve made;
  made.length = curve.length();
  made.position = curve.position(0);
  const Vec start = curve.tangent(0);
  const Vec e1 = across(start, normal);
  if (!is_finite(start) || dot(e1, e1) == 0) {
    throw InputError("normal is along the curve at its first point", where,
                     "give another normal");
  }
  made.frame = frame_of(start, e1);

  // Joints of a straight strand with the same discretisation.
  const Strand cut =
      make_strand({}, {}, {elements, made.length, grading}, [](double) { return Vec{}; });
  std::vector<double> ends;
  std::vector<Vec> darboux;
  Frame frame = made.frame;
  double from = 0, u = 0;
  for (const Segment& segment : cut.segments) {
    const double to = from + segment.length;
    Frame at = frame;
    double wound = 0;
    for (int j = 1; j <= curve_parts; ++j) {
      const double next =
          curve.parameter(std::lerp(from, to, static_cast<double>(j) / curve_parts));
      const Vec tangent = curve.tangent(next);
      wound += std::acos(std::clamp(dot(at.e0, tangent), -1.0, 1.0));
      at = carried(at, curve.position(next) - curve.position(u), tangent);
      u = next;
    }
    if (!(wound < std::numbers::pi)) {
      throw InputError("the points wind by more than half a turn in one element", where,
                       "give more elements, or fewer points");
    }
    darboux.push_back(1 / segment.length * rotation_between(frame, at));
    ends.push_back(to);
    frame = at;
    from = to;
  }
  made.shape = [ends, darboux](double s) {
    const auto i =
        static_cast<std::size_t>(std::ranges::upper_bound(ends, s) - ends.begin());
    return darboux[std::min(i, darboux.size() - 1)];
  };
  return made;
}

}  // namespace tress::simulation
