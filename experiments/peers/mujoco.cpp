// MuJoCo: joint coordinates, composite inertia with a sparse L^T D L factor;
// semi-implicit Euler, or implicit in velocity. Ball joints, or universal joints as two
// hinges.
#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "experiments/peers/mujoco_model.h"
#include "experiments/peers/peer.h"

namespace tress::experiments::peers {
namespace {

enum class Joint { ball, universal };

std::string joints(Joint joint, double stiffness) {
  if (joint == Joint::ball) {
    return fmt::format("<joint type='ball' stiffness='{}'/>", stiffness);
  }
  return fmt::format(
      "<joint type='hinge' axis='0 1 0' stiffness='{0}'/>"
      "<joint type='hinge' axis='0 0 1' stiffness='{0}'/>",
      stiffness);
}

/// The strand in MuJoCo's own format: links nested from the clamp outwards.
std::string description(const Swing& swing, double dt, Joint joint,
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

class Mujoco : public Peer {
 public:
  Mujoco(const Swing& swing, double dt, Joint joint, std::string_view integrator)
      : swing_(swing),
        made_(description(swing, dt, joint, integrator)),
        model_(&made_.model()),
        data_(&made_.data()),
        momentum_(static_cast<std::size_t>(model_->nv)) {}

  void step(double t) override {
    const Vec g = Swing::gravity(t);
    store3(g, model_->opt.gravity);
    mj_step1(model_, data_);
    // Damping of every body by its mass and moment is damping by the mass matrix.
    mj_mulM(model_, data_, momentum_.data(), data_->qvel);
    mju_scl(data_->qfrc_applied, momentum_.data(), -Swing::damping, model_->nv);
    mj_step2(model_, data_);
  }

  Motion motion() override {
    if (gave_up()) return {.tip = {std::numeric_limits<double>::quiet_NaN(), 0, 0}};
    mj_fwdPosition(model_, data_);
    mj_mulM(model_, data_, momentum_.data(), data_->qvel);
    const double energy = mju_dot(momentum_.data(), data_->qvel, model_->nv) / 2;
    const mjtNum end[3] = {swing_.link_length(), 0, 0};
    mjtNum tip[3];
    mju_rotVecMat(tip, end, data_->xmat + 9 * swing_.links);  // body 0 is the world
    mju_addTo3(tip, data_->xpos + 3 * swing_.links);
    return {load3(tip), energy};
  }

 private:
  /// On bad numbers MuJoCo warns and starts over from the initial state.
  bool gave_up() const {
    for (const int kind : {mjWARN_BADQPOS, mjWARN_BADQVEL, mjWARN_BADQACC}) {
      if (data_->warning[kind].number > 0) return true;
    }
    return false;
  }

  const Swing swing_;
  const MujocoModel made_;
  mjModel* model_;
  mjData* data_;
  std::vector<mjtNum> momentum_;
};

template <Joint joint, bool implicit>
std::unique_ptr<Peer> make(const Swing& swing, double dt) {
  return std::make_unique<Mujoco>(swing, dt, joint, implicit ? "implicit" : "Euler");
}

constexpr Method methods[] = {
    {"ball joints: Euler", 1, make<Joint::ball, false>},
    {"universal joints: Euler", 1, make<Joint::universal, false>},
    {"universal joints: implicit", 1, make<Joint::universal, true>},
};

}  // namespace

std::span<const Method> mujoco_methods() { return methods; }

}  // namespace tress::experiments::peers
