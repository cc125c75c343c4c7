#include "models/motion/skin.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "contract/input_error.h"
#include "models/motion/signals.h"

namespace tress::models {
namespace {

using std::numbers::pi;

/// Axes along an edge of a triangle, its normal and their product.
Frame triangle_axes(const Vec& a, const Vec& b, const Vec& c) {
  const Vec e0 = (1 / norm(b - a)) * (b - a), area = cross(b - a, c - a);
  const Vec e2 = (1 / norm(area)) * area;
  return {e0, cross(e2, e0), e2};
}

/// Weights of the corners at a place of a triangle; their sum is 1.
Vec shares_of(const Vec& a, const Vec& b, const Vec& c, const Vec& x) {
  const Vec area = cross(b - a, c - a);
  const double all = dot(area, area);
  const double of_b = dot(cross(x - a, c - a), area) / all,
               of_c = dot(cross(b - a, x - a), area) / all;
  return {1 - of_b - of_c, of_b, of_c};
}

/// Three angles about the axes first, first + 1 and first + 2 (of x, y, z in turn),
/// the first turned first.
struct Angles {
  double one, two, three;
};
Angles angles_of(const Frame& turn, std::size_t first) {
  const Vec columns[] = {turn.e0, turn.e1, turn.e2};
  const auto at = [&](std::size_t row, std::size_t column) {
    const Vec& of = columns[(first + column) % 3];
    const std::array all{of.x, of.y, of.z};
    return all[(first + row) % 3];
  };
  return {std::atan2(at(2, 1), at(2, 2)), std::asin(std::clamp(-at(2, 0), -1.0, 1.0)),
          std::atan2(at(1, 0), at(0, 0))};
}

/// The angle that differs from `angle` by full turns and is nearest to `before`.
double nearest_turn(double angle, double before) {
  return angle + 2 * pi * std::round((before - angle) / (2 * pi));
}

const std::vector<TriangleMesh>& checked(const std::vector<TriangleMesh>& frames,
                                         const std::vector<double>& times,
                                         const std::string& where) {
  refuse_if(frames.size() != times.size() || times.size() < 2,
            std::to_string(frames.size()) + " meshes for " +
                std::to_string(times.size()) + " times",
            where, "give a time for each mesh, and two meshes or more");
  for (std::size_t i = 0; i < frames.size(); ++i) {
    const std::string of = "mesh " + std::to_string(i) + " of the skin";
    const bool third = i > 1 && times[i] == times[i - 2];
    refuse_if(!std::isfinite(times[i]) || (i > 0 && times[i] < times[i - 1]) || third,
              "times that do not ascend", where,
              "sort the meshes by time; two with the same time are a teleport");
    refuse_if(frames[i].triangle.empty(), of + " has no triangle", where,
              "write it again with its faces");
    refuse_if(frames[i].triangle != frames[0].triangle ||
                  frames[i].corner.size() != frames[0].corner.size(),
              of + " has other triangles than the first one", where,
              "write all meshes of the skin with the same faces in the same order");
    for (const auto& [a, b, c] : frames[i].triangle) {
      const std::vector<Vec>& x = frames[i].corner;
      const double area = norm(cross(x[b] - x[a], x[c] - x[a]));
      refuse_if(!(area > 0 && std::isfinite(area)), of + " has a triangle without area",
                where, "remove the triangle from all meshes");
    }
  }
  return frames;
}

}  // namespace

Skin::Skin(std::vector<TriangleMesh> frames, std::vector<double> times,
           const std::string& where)
    : tree_(checked(frames, times, where).front()),
      times_(std::move(times)),
      where_(where) {
  for (TriangleMesh& frame : frames) corners_.push_back(std::move(frame.corner));
}

StrandPlace Skin::axes(std::size_t frame, const NearestOnMesh& on,
                       const Vec& share) const {
  const auto& [ia, ib, ic] = tree_.mesh().triangle[on.triangle];
  const std::vector<Vec>& x = corners_[frame];
  return {share.x * x[ia] + share.y * x[ib] + share.z * x[ic],
          triangle_axes(x[ia], x[ib], x[ic])};
}

RootMotion Skin::motion(const Vec& position, const Frame& frame) const {
  const NearestOnMesh on = tree_.nearest(position);
  const auto& [ia, ib, ic] = tree_.mesh().triangle[on.triangle];
  const std::vector<Vec>& x = corners_.front();
  const Vec share = shares_of(x[ia], x[ib], x[ic], on.at);
  const StrandPlace rest = axes(0, on, share);
  const Vec offset = rest.frame.back(position - rest.x);
  constexpr double widest = 80 * pi / 180;
  for (std::size_t first = 0; first < 3; ++first) {
    std::vector<double> rows;
    Angles before{0, 0, 0};
    double turned = 0;
    for (std::size_t i = 0; i < times_.size(); ++i) {
      const StrandPlace now = axes(i, on, share);
      const Vec moved = now.x + now.frame * offset - position;
      const auto turn = [&](const Vec& e) { return now.frame * rest.frame.back(e); };
      Angles angles =
          angles_of({turn({1, 0, 0}), turn({0, 1, 0}), turn({0, 0, 1})}, first);
      angles.one = nearest_turn(angles.one, before.one);
      angles.three = nearest_turn(angles.three, before.three);
      before = angles;
      turned = std::max(turned, std::abs(angles.two));
      rows.insert(rows.end(), {times_[i], moved.x, moved.y, moved.z, angles.one,
                               angles.two, angles.three});
    }
    if (turned > widest) continue;
    const Vec axes[] = {world_axes[first], world_axes[(first + 1) % 3],
                        world_axes[(first + 2) % 3]};
    RootMotion motion = keyframe_motion(rows, axes, position);
    motion.position = position;
    motion.frame = frame;
    return motion;
  }
  throw InputError("a part of the skin turns by more than 80 degrees about every axis",
                   where_, "turn the whole head by less, or its camera instead");
}

}  // namespace tress::models
