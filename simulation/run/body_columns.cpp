#include "simulation/run/body_columns.h"

#include <fmt/format.h>

#include <algorithm>
#include <variant>

#include "math/quaternion.h"

namespace tress::simulation {
namespace {

using models::Bearing;
using models::DrivenBody;

Frame inverse(const Frame& f) {
  return {f.back({1, 0, 0}), f.back({0, 1, 0}), f.back({0, 0, 1})};
}

}  // namespace

std::vector<Reading> columns_of(const DrivenName& body) {
  const std::string& name = body.name;
  if (!body.free) {
    return {{fmt::format("angle_{}_rad", name),
             "angle by which strands have turned the body, about its axis"},
            {fmt::format("speed_{}_rad_per_s", name), "angular velocity of the body"}};
  }
  std::vector<Reading> all;
  const auto add = [&](const char* what, std::initializer_list<const char*> parts,
                       const char* unit, const char* help) {
    for (const char* part : parts) {
      all.push_back({fmt::format("{}_{}_{}{}", what, name, part, unit),
                     fmt::format("{}, {}", help, part)});
    }
  };
  add("position", {"x", "y", "z"}, "_m", "centre of mass of the body");
  add("orientation", {"w", "x", "y", "z"}, "",
      "quaternion that turns the world's axes to those of the body");
  add("velocity", {"x", "y", "z"}, "_m_per_s", "velocity of the centre of mass");
  add("spin", {"x", "y", "z"}, "_rad_per_s", "angular velocity of the body");
  return all;
}

void append_motion(const DrivenBody& body, const DrivenBodies::Motion& now,
                   std::vector<double>& row) {
  if (std::holds_alternative<Bearing>(body.drive())) {
    row.insert(row.end(), {now.angle, now.speed});
    return;
  }
  const Quaternion q = quaternion_of(now.turn * body.place().frame);
  for (const double x : {now.x.x, now.x.y, now.x.z, q.w, q.v.x, q.v.y, q.v.z, now.v.x,
                         now.v.y, now.v.z, now.omega.x, now.omega.y, now.omega.z}) {
    row.push_back(x);
  }
}

DrivenBodies::Motion place_in(const DrivenBody& body, const std::string& name,
                              const std::vector<Reading>& columns,
                              std::span<const double> row) {
  const bool free = std::holds_alternative<models::FreeBody>(body.drive());
  const auto first =
      std::ranges::find(columns, columns_of({name, free}).front().name, &Reading::name);
  const double* const at = &row[static_cast<std::size_t>(first - columns.begin())];
  DrivenBodies::Motion now = body.start();
  if (free) {
    now.x = load3(at);
    now.turn =
        axes(Quaternion{at[3], {at[4], at[5], at[6]}}) * inverse(body.place().frame);
  } else {
    now.turn = rotation(std::get<Bearing>(body.drive()).axis, at[0]);
  }
  return now;
}

}  // namespace tress::simulation
