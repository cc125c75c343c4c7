// MuJoCo: soft contacts with an elliptic friction cone, solved as one convex problem
// (Newton's method), semi-implicit Euler.
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <string>

#include "experiments/other_simulators/mujoco_model.h"
#include "experiments/other_simulators/rubbing.h"

namespace tress::experiments::other_simulators {
namespace {

std::string options(double dt, const Vec& gravity) {
  return fmt::format(
      "<mujoco><compiler angle='radian'/><option timestep='{}' cone='elliptic' "
      "gravity='{} {} {}' impratio='100'/>",
      dt, gravity.x, gravity.y, gravity.z);
}

double slope(const Slope& slope, double dt) {
  const Vec moments = Slope::moments(), half = Slope::half;
  const MujocoModel model(
      options(dt, slope.gravity()) +
      fmt::format(
          "<default><geom friction='{0} 0 0' condim='3'/></default><worldbody>"
          "<geom type='plane' size='1000 1000 1'/><body pos='0 0 {3}'><freejoint/>"
          "<inertial pos='0 0 0' mass='{4}' diaginertia='{5} {6} {7}'/>"
          "<geom type='box' size='{1} {2} {3}'/></body></worldbody></mujoco>",
          slope.friction, half.x, half.y, half.z, Slope::mass, moments.x, moments.y,
          moments.z));
  double start = 0;
  for (int i = 0; i * dt < Slope::settling + Slope::watched; ++i) {
    if (i * dt < Slope::settling) start = model.data().qpos[0];
    mj_step(&model.model(), &model.data());
  }
  return model.data().qpos[0] - start;
}

/// Links nested from the first one on, which is free.
double capstan(const Capstan& capstan, double dt) {
  const double l = capstan.link_length(), moment = capstan.moment();
  std::string text =
      options(dt, {}) +
      fmt::format(
          "<default><geom friction='{0} 0 0' condim='3'/></default><worldbody>"
          "<geom type='capsule' size='{1} 25' euler='{2} 0 0' contype='1' "
          "conaffinity='0'/>",
          capstan.friction, Capstan::radius, std::numbers::pi / 2);
  for (int i = 0; i < capstan.links; ++i) {
    // The body's z axis is the link's.
    if (i == 0) {
      const Vec at = capstan.centre(0);
      text += fmt::format("<body pos='{} {} {}' euler='0 {} 0'><freejoint/>", at.x, at.y,
                          at.z, capstan.angle(0) + std::numbers::pi / 2);
    } else {
      text += fmt::format(
          "<body pos='{0} 0 {1}' euler='0 {2} 0'>"
          "<joint type='ball' pos='0 0 {3}'/>",
          l / 2 * std::sin(capstan.turn()), l / 2 * (1 + std::cos(capstan.turn())),
          capstan.turn(), -l / 2);
    }
    text += fmt::format(
        "<inertial pos='0 0 0' mass='{0}' diaginertia='{1} {1} {1}'/>"
        "<geom type='capsule' size='{2} {3}' contype='0' "
        "conaffinity='1'/>",
        Capstan::mass, moment, Capstan::link_radius, l / 2);
  }
  for (int i = 0; i < capstan.links; ++i) text += "</body>";
  const MujocoModel model(text + "</worldbody></mujoco>");
  mjData& data = model.data();
  const Vec start = capstan.centre(0);
  const auto pull = [&](int body, double force, double along) {
    const mjtNum down[3] = {0, 0, -force}, none[3] = {0, 0, 0};
    const mjtNum* const frame = data.xmat + 9 * body;
    mjtNum at[3];
    for (int k = 0; k < 3; ++k)
      at[k] = data.xpos[3 * body + k] + along * frame[3 * k + 2];
    mj_applyFT(&model.model(), &data, down, none, at, body, data.qfrc_applied);
  };
  for (int i = 0; i * dt < Capstan::watched; ++i) {
    mj_step1(&model.model(), &data);
    mju_zero(data.qfrc_applied, model.model().nv);
    pull(1, Capstan::pull, -l / 2);
    pull(capstan.links, capstan.ratio * Capstan::pull, l / 2);
    mj_step2(&model.model(), &data);
  }
  return norm(load3(data.qpos) - start);
}

constexpr RubbingMethod methods[] = {{"elliptic cone, impratio 100", slope, capstan}};

}  // namespace

std::span<const RubbingMethod> mujoco_rubbing() { return methods; }

}  // namespace tress::experiments::other_simulators
