#include "simulation/scene/support_reach.h"

#include <fmt/format.h>

#include <cmath>

#include "contract/input_error.h"

namespace tress::simulation {

using models::Strand;
using models::Support;

namespace {

/// Distances are compared at this number of instants of the run.
constexpr int instants = 1000;
/// Share of the length below which slack is rounding.
constexpr double rounding = 1e-13;
/// Largest distance over the length for models whose strands stretch.
constexpr double most_stretch = 1.1;

/// Returns the location of a support's keyframes, or of its table.
std::string place_of_path(const Table& table) {
  return table.given("keyframes") ? table.place("keyframes") : table.place();
}

}  // namespace

void check_reach(const SupportedEnd& a, const SupportedEnd& b, bool inextensible,
                 double duration, const Table& table) {
  const double arc = std::abs(b.arc - a.arc);
  if (arc == 0) return;  // two supports of one point are refused elsewhere
  double farthest = 0, at = 0;
  for (int i = 0; i <= instants; ++i) {
    const double t = duration * i / instants;
    const double distance = norm(b.path->at(t).x - a.path->at(t).x);
    if (!(distance <= farthest)) {
      farthest = distance;
      at = t;
    }
  }
  const std::string where = place_of_path(table);
  if (farthest > (inextensible ? 1 + rounding : most_stretch) * arc) {
    throw InputError(
        fmt::format(
            "a support {:g} m from the {} at t = {:g} s, where the strand between "
            "them is {:g} m long",
            farthest, a.name, at, arc),
        where, "move the support closer, or make the strand longer");
  }
  if (inextensible && farthest >= (1 - rounding) * arc) {
    throw InputError(
        fmt::format("the strand is inextensible, and {:g} m long between its support and "
                    "the {}, which are as far apart at t = {:g} s",
                    farthest, a.name, at),
        where, "move the support closer, give slack, or use [model] id = \"der\"");
  }
}

void stay_in_plane(const Parameters& options, double duration, const Strand& strand,
                   const Table& table, Support& support) {
  if (!options.knows("modes") || options.word("modes") != "bend_planar") return;
  const Frame& plane = strand.root.frame;
  if (!support.axes.empty()) support.axes = {plane.e0, plane.e2};
  for (int i = 0; i <= instants; ++i) {
    const double t = duration * i / instants;
    const auto root = strand.root.at(t);
    const models::RootPose pose = support.path.at(t);
    const double off = support.axes.empty() ? 0 : dot(plane.e1, pose.x - root.x);
    if (std::abs(off) > 1e-9 * strand.length() || norm(root.frame.e1 - plane.e1) > 1e-9) {
      throw InputError(
          fmt::format("a support {:.3g} m outside the plane of the strand at t = {:g} s",
                      std::abs(off), t),
          place_of_path(table),
          "keep it in the plane, or give [model] modes = \"bend_twist\"");
    }
    if (support.section == models::HeldPart::nothing ||
        norm(pose.frame.e1 - plane.e1) <= 1e-9) {
      continue;
    }
    throw InputError(
        fmt::format("a support turned out of the plane of the strand at t = {:g} s", t),
        table.given("directions") ? table.place("directions") : table.place(),
        "keep it in the plane, or give [model] modes = \"bend_twist\"");
  }
}

}  // namespace tress::simulation
