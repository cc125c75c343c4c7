// MuJoCo: joint coordinates, composite inertia with a sparse L^T D L factor;
// semi-implicit Euler, or implicit in velocity. Ball joints, or universal joints as two
// hinges.
#include <mujoco/mujoco.h>

#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "experiments/other_simulators/mujoco_model.h"
#include "experiments/other_simulators/mujoco_strand.h"
#include "experiments/other_simulators/simulator.h"

namespace tress::experiments::other_simulators {
namespace {

class Mujoco : public Simulator {
 public:
  Mujoco(const Swing& swing, double dt, MujocoJoint joint, std::string_view integrator)
      : swing_(swing),
        made_(mujoco_strand(swing, dt, joint, integrator)),
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

template <MujocoJoint joint, bool implicit>
std::unique_ptr<Simulator> make(const Swing& swing, double dt) {
  return std::make_unique<Mujoco>(swing, dt, joint, implicit ? "implicit" : "Euler");
}

constexpr Method methods[] = {
    {"ball joints: Euler", 1, make<MujocoJoint::ball, false>},
    {"universal joints: Euler", 1, make<MujocoJoint::universal, false>},
    {"universal joints: implicit", 1, make<MujocoJoint::universal, true>},
};

}  // namespace

std::span<const Method> mujoco_methods() { return methods; }

}  // namespace tress::experiments::other_simulators
