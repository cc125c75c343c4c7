#include "simulation/scene/support_path.h"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "models/effects/body.h"
#include "models/motion/signals.h"
#include "simulation/scene/driven_bodies.h"
#include "simulation/table/read_table.h"

namespace tress::simulation {

using models::RootMotion;

namespace {

/// Cosine of the angle from which the shorter way between two directions is not unique.
constexpr double opposite = -1 + 1e-9;

void check_ascending(const Table& table, const std::string& key,
                     const std::vector<double>& t) {
  for (std::size_t i = 1; i < t.size(); ++i) {
    if (t[i] > t[i - 1]) continue;
    throw InputError(
        fmt::format("{} not ascending in time: row {} at {:g} s after {:g} s", key, i + 1,
                    t[i], t[i - 1]),
        table.place(key), "give each a later time than the one before");
  }
}

/// Unit axis and angle of the shortest rotation between unit vectors.
struct Turn {
  Vec axis{1, 0, 0};
  double angle = 0;
};

Turn turn_between(const Vec& from, const Vec& to) {
  const Vec axis = cross(from, to);
  const double sine = norm(axis);
  if (sine == 0) return {};
  return {(1 / sine) * axis, std::atan2(sine, dot(from, to))};
}

std::vector<Vec> unit_directions(const Table& table, const std::vector<double>& x,
                                 const std::vector<double>& y,
                                 const std::vector<double>& z) {
  std::vector<Vec> all;
  for (std::size_t i = 0; i < x.size(); ++i) {
    const Vec d{x[i], y[i], z[i]};
    refuse_if(!(norm(d) > 0), fmt::format("row {} of directions has length 0", i + 1),
              table.place("directions"),
              "give each direction at least one component that is not 0");
    all.push_back((1 / norm(d)) * d);
    if (i > 0 && dot(all[i], all[i - 1]) < opposite) {
      throw InputError(
          fmt::format("directions of rows {} and {} are opposite: the way is not unique",
                      i, i + 1),
          table.place("directions"), "add a direction between them");
    }
  }
  return all;
}

/// Rotations from direction to direction on the shortest ways, each at rest at both ends.
void add_directions(const Table& table, RootMotion& path) {
  const auto [t, x, y, z] = columns<4>(table.values().numbers("directions"));
  check_ascending(table, "directions", t);
  const std::vector<Vec> all = unit_directions(table, x, y, z);
  if (all.empty()) return;
  refuse_if(dot(path.frame.e0, all.front()) < opposite,
            "the first direction is opposite to that of the strand at the start",
            table.place("directions"),
            "turn it a little, or give the strand another shape at the start");
  const Turn first = turn_between(path.frame.e0, all.front());
  path.frame = rotation(first.axis, first.angle) * path.frame;
  for (std::size_t i = 1; i < all.size(); ++i) {
    const Turn turn = turn_between(all[i - 1], all[i]);
    if (turn.angle == 0) continue;
    path.rotations.push_back(
        {turn.axis, models::smooth_step(turn.angle, t[i - 1], t[i] - t[i - 1])});
  }
}

/// A rotation about the first direction, which the others then turn.
void add_twist(const Table& table, RootMotion& path) {
  const auto [t, angle] = columns<2>(table.values().numbers("twist_rad"));
  check_ascending(table, "twist_rad", t);
  if (t.empty()) return;
  const models::Signal twist = models::rests(t, angle);
  const double begin = twist(0).value;
  if (std::abs(begin) > 0.9 * std::numbers::pi) {
    throw InputError(
        fmt::format("a strand that begins with a twist of {:.4g} rad", begin),
        table.place("twist_rad"),
        "begin with less than 2.8 rad, and twist it during the run");
  }
  path.rotations.insert(path.rotations.begin(), {path.frame.e0, twist});
}

}  // namespace

std::vector<Carrier> carriers(const Scene& scene) {
  std::vector<Carrier> all;
  all.push_back(
      {"head", scene.head, scene.head.fixed() ? Carrier::still : Carrier::moves});
  const std::vector<std::string> names = effect_names(scene);
  for (std::size_t i = 0; i < names.size(); ++i) {
    const EffectChoice& choice = scene.effects[i];
    if (choice.entry->id != "body") continue;
    if (auto motion = models::body_motion(choice.parameters, scene.head)) {
      all.push_back({names[i], *std::move(motion)});
    } else if (!driven(choice)) {
      all.push_back({names[i], {}, Carrier::still});
    }
  }
  return all;
}

RootMotion support_path(const Table& table, const models::StrandPlace& start,
                        const std::vector<Carrier>& carriers) {
  if (const std::string_view on = table.values().word("on"); !on.empty()) {
    std::string known;
    for (const Carrier& carrier : carriers) {
      if (carrier.name != on) {
        if (carrier.is != Carrier::moves) continue;
        known += (known.empty() ? "use \"" : ", \"") + carrier.name + "\"";
        continue;
      }
      refuse_if(carrier.is == Carrier::still,
                fmt::format("a support on \"{}\", which does not move", on),
                table.place("on"),
                on == "head" ? "leave on out, or give [root] a motion of the head"
                             : "leave on out, or give the body moves = \"keyframes\", "
                               "\"poses\", \"turns\" or \"free\"");
      return models::carried(carrier.motion, start);
    }
    throw InputError(fmt::format("a support on '{}', which is no body of the scene", on),
                     table.place("on"),
                     known.empty() ? "leave on out, or give a body that moves" : known);
  }
  const auto [t, x, y, z] = columns<4>(table.values().numbers("keyframes"));
  check_ascending(table, "keyframes", t);
  RootMotion path;
  path.position = t.empty() ? start.x : Vec{x[0], y[0], z[0]};
  path.frame = start.frame;
  const auto move = [&](const Vec& axis, const std::vector<double>& values) {
    if (t.size() < 2) return;
    std::vector<double> ways;
    for (const double value : values) ways.push_back(value - values.front());
    path.translations.push_back({axis, models::rests(t, ways)});
  };
  move({1, 0, 0}, x);
  move({0, 1, 0}, y);
  move({0, 0, 1}, z);
  add_directions(table, path);
  add_twist(table, path);
  return path;
}

void let_slide(const Table& table, models::Support& support) {
  const Vec along = table.values().vec("slide");
  const double length = norm(along);
  if (length == 0) return;
  const Vec unit = (1 / length) * along;
  std::vector<Vec>& axes = support.axes;
  Vec within;
  for (const Vec& axis : axes) within = within + dot(axis, unit) * axis;
  refuse_if(norm(within - unit) > 1e-9, "a slide out of the plane of the strand",
            table.place("slide"), "give a direction in its plane");
  // The others, made orthogonal to it and to each other.
  std::vector<Vec> kept;
  for (Vec axis : axes) {
    axis = axis - dot(axis, unit) * unit;
    for (const Vec& other : kept) axis = axis - dot(axis, other) * other;
    if (norm(axis) > 0.1 && kept.size() + 1 < axes.size()) {
      kept.push_back((1 / norm(axis)) * axis);
    }
  }
  axes = kept;
}

}  // namespace tress::simulation
