#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>

#include "simulation/gradient/scene_gradient.h"
#include "simulation/scene/root_table.h"

namespace tress::test_root_gradient {

using namespace simulation;

constexpr std::size_t strand_count = 5;

/// Strands whose roots all have different poses, none of them the default one.
constexpr const char* strands = R"(
[material]
internal_friction_kg_m3_s = 1e-10
[[strand]]
length_m = 0.1
elements = 2
shape = "helix"
root_tangent = [1, 0.2, -0.1]
normal = [0.1, 0.3, 1]
position_m = [0.02, -0.01, 0.03]
[[strand]]
length_m = 0.08
elements = 2
root_tangent = [-0.3, 0.4, 1]
normal = [1, 0.2, 0]
position_m = [-0.03, 0.02, 0.01]
[[strand]]
points = [[0, 0.01, 0.02], [0.03, 0.03, 0.03], [0.06, 0.03, 0.06], [0.09, 0.02, 0.06]]
elements = 2
[[groom]]
count = 2
elements = 2
length_m = 0.1
[effects.gravity]
[effects.linear_drag]
drag_kg_m_s = 1e-4
)";

/// Values that let every number of every motion act within the run.
const std::map<std::string, Vec> values = {
    {"direction", {0.3, 1, 0.2}},     {"axis", {0.2, -0.1, 1}},
    {"centre_m", {-0.05, 0.02, 0.1}}, {"velocity_m_s", {0.2, -0.1, 0.3}},
    {"spin_rad_s", {3, -2, 1}},       {"amplitude_m", {0.01, 0, 0}},
    {"angle_rad", {0.4, 0, 0}},       {"frequency_hz", {20, 0, 0}},
    {"speed_m_s", {0.3, 0, 0}},       {"distance_m", {0.01, 0, 0}},
    {"time_s", {0.035, 0, 0}},        {"torque_n_m", {2, 0, 0}},
    {"inertia_kg_m2", {0.02, 0, 0}},  {"damping_n_m_s", {0.1, 0, 0}},
    {"stiffness_n_m", {2, 0, 0}},
};

/// A number of [root], or one of its three components.
struct Number {
  std::string key;
  std::optional<std::size_t> component = {};

  std::string name() const {
    return "root." + key + (component ? fmt::format(".{}", "xyz"[*component]) : "");
  }
};

using Motions = std::map<std::string, std::vector<Number>>;

/// All motions with numbers, from the tables of the program.
Motions motions() {
  Motions all;
  for (const Use& use : root_uses()) {
    for (const std::string_view key : words_of(use.keys)) {
      const auto p = std::ranges::find(root_table_parameters(), key, &Parameter::name);
      if (p->rows || p->text || p->whole || use.word == "skin") continue;
      for (std::size_t k = 0; k < (p->components == 3 ? 3u : 1u); ++k) {
        Number one{std::string(key)};
        if (p->components == 3) one.component = k;
        all[std::string(use.word)].push_back(one);
      }
    }
  }
  return all;
}

/// The scene with `changed` greater by `by`.
std::string text(const std::string& motion, const std::vector<Number>& numbers,
                 const std::string& by_name, const std::string& changed, double by) {
  std::string root = "[root]\nmotion = \"" + motion + "\"\n";
  if (motion == "keyframes") {
    root += "keyframes = [[0, 0, 0, 0, 0], [0.04, 0, 0.01, 0.02, 0.4]]\n";
  }
  if (motion == "poses") {
    root += "poses = [[0, 0, 0, 0, 0, 0, 0], [0.04, 0, 0.01, 0, 0.1, 0.3, 0.4]]\n";
  }
  for (const Number& number : numbers) {
    Vec v = values.at(number.key);
    if (number.component.value_or(0) > 0) continue;
    if (!number.component) {
      root += fmt::format("{} = {:.17g}\n", number.key,
                          v.x + (changed == number.name() ? by : 0));
      continue;
    }
    for (std::size_t k = 0; k < 3; ++k) {
      if (changed == Number{number.key, k}.name()) v = v + by * axis_of(k);
    }
    root += fmt::format("{} = [{:.17g}, {:.17g}, {:.17g}]\n", number.key, v.x, v.y, v.z);
  }
  return "title = \"t\"\nduration_s = 0.03\nframes_per_s = 100\n[integrator]\nid = "
         "\"backward_euler\"\ndt_s = 0.002\nnewton_tolerance = 1e-13\n" +
         root + "[gradient]\nstart = \"as_run\"\nby = [" + by_name + "]\n" + strands;
}

// The differences are of scenes that are read again with another number in their text.
TEST(RootGradient, OfEveryMotionIsThatOfScenesWithAnotherNumber) {
  std::size_t checked = 0;
  for (const auto& [motion, numbers] : motions()) {
    std::string names;
    for (const Number& one : numbers) {
      names += (names.empty() ? "\"" : ", \"") + one.name() + "\"";
    }
    const SceneGradient found =
        scene_gradient(parse_scene(text(motion, numbers, names, "", 0), "s.toml"));
    ASSERT_EQ(found.strands.size(), strand_count);
    for (std::size_t n = 0; n < numbers.size(); ++n) {
      const std::string name = numbers[n].name();
      SCOPED_TRACE(motion + ", " + name);
      constexpr double part = 1e-3;
      const double h = part * found.parameters[n].measure;
      std::vector<SceneGradient> at;
      for (const double s : {1, -1, 2, -2}) {
        at.push_back(scene_gradient(
            parse_scene(text(motion, numbers, "\"linear_drag.drag_kg_m_s\"", name, s * h),
                        "s.toml")));
      }
      for (std::size_t k = 0; k < strand_count; ++k) {
        double worst = 0, most = 0;
        const std::vector<double>& by = found.strands[k].by[n].back();
        ASSERT_EQ(found.strands[k].unfinished, "");
        for (std::size_t i = 0; i < by.size(); ++i) {
          const auto x = [&](std::size_t s) { return at[s].strands[k].points.back()[i]; };
          const double d = (8 * (x(0) - x(1)) - (x(2) - x(3))) / (12 * h);
          worst = std::max(worst, std::abs(by[i] - d));
          most = std::max(most, std::abs(d));
        }
        EXPECT_GT(most * found.parameters[n].measure, 1e-6) << "strand " << k;
        // Numbers that place the root are differenced over 2e-10 m, where positions are
        // rounded at 1e-17 m: 2e-7 of 1 m per m.
        const double rounding = found.parameters[n].unit == "m" ? 2e-7 : 0;
        // Newton's tolerance, 1e-13 of the typical sizes in each of 15 steps, is 1e-9 of
        // them over 2 h; the numbers move points by more than 1e-4 of these sizes.
        EXPECT_LT(worst, 1e-5 * most + rounding) << "strand " << k;
        ++checked;
      }
    }
  }
  EXPECT_GE(checked, 40 * strand_count);
}

}  // namespace tress::test_root_gradient
