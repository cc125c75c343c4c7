#include "experiments/other_simulators/mujoco_strand.h"

#include <fmt/format.h>

namespace tress::experiments::other_simulators {
namespace {

std::string joints(MujocoJoint joint, double stiffness) {
  if (joint == MujocoJoint::ball) {
    return fmt::format("<joint type='ball' stiffness='{}'/>", stiffness);
  }
  return fmt::format(
      "<joint type='hinge' axis='0 1 0' stiffness='{0}'/>"
      "<joint type='hinge' axis='0 0 1' stiffness='{0}'/>",
      stiffness);
}

}  // namespace

std::string mujoco_strand(const Swing& swing, double dt, MujocoJoint joint,
                          std::string_view integrator) {
  std::string text = fmt::format(
      "<mujoco><compiler angle='radian'/><option timestep='{}' integrator='{}'>"
      "<flag constraint='disable' contact='disable'/></option><worldbody>",
      dt, integrator);
  const double l = swing.link_length();
  for (int i = 0; i < swing.links; ++i) {
    text += fmt::format("<body pos='{} 0 0'>{}", i == 0 ? 0 : l,
                        joints(joint, swing.stiffness(i)));
    text += fmt::format("<inertial pos='{0} 0 0' mass='{1}' diaginertia='{2} {2} {2}'/>",
                        l / 2, swing.mass(), swing.moment());
  }
  for (int i = 0; i < swing.links; ++i) text += "</body>";
  return text + "</worldbody></mujoco>";
}

}  // namespace tress::experiments::other_simulators
