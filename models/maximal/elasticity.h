#pragma once

#include <vector>

#include "models/maximal/groups.h"
#include "models/motion/root_motion.h"

namespace tress::models {

/// A strand of redundant coordinates as its internal forces see it: all coordinates
/// z = [held; q], those that the clamp prescribes first, their rates, and the clamp.
struct Placement {
  const RootPose& root;
  In z, rate;
};

/// The energy and friction of an Elasticity as those of strains s(z, clamp), for the
/// ComplianceForm of contract/system.h.
class StrainForm {
 public:
  virtual ~StrainForm() = default;
  /// In the order along the strand from the root; coordinates are places in z.
  virtual std::vector<ComplianceForm::Block> strain_blocks() const = 0;
  /// Of block k at z, the values of its coordinates. The drift is what a turning clamp
  /// makes of it.
  virtual void strain(std::size_t k, const RootPose& root, const double* z,
                      ComplianceForm::Value& value) noexcept = 0;
};

/// Internal forces of a strand: an elastic energy E(z, clamp) and friction. Groups are
/// sets of coordinates (places in z) that one term couples; the tangent comes group by
/// group, in the order of groups(), as square matrices.
class Elasticity {
 public:
  virtual ~Elasticity() = default;
  virtual std::vector<std::vector<int>> groups() const = 0;
  /// f += dE/dz + friction.
  virtual void add_force(const Placement& p, InOut f) noexcept = 0;
  /// s += pos df/dz + vel df/d(rate).
  virtual void add_tangent(const Placement& p, double pos, double vel,
                           GroupSum& s) noexcept = 0;
  virtual double energy(const Placement& p) noexcept = 0;  // J
  /// W: what friction takes (negative) and a turning clamp gives.
  virtual double power(const Placement& p) noexcept = 0;
  /// Angular momentum (kg m^2/s) of coordinates other than positions, of this inertia;
  /// 0 where the model neglects it.
  virtual Vec spin(const Placement&, In /*inertia*/) noexcept { return {}; }
  /// Largest |length/rest - 1| where nodes are not on the curve (see MaximalStrand).
  virtual double stretch(const Placement&) noexcept { return 0; }
  /// Frame of the last edge, or of the section at the tip. Empty: there is none.
  virtual std::optional<Frame> end_frame(const Placement&) noexcept { return {}; }
  /// After an accepted step: may move reference frames, and with them z and its rate.
  /// True: the equations changed.
  virtual bool rebase(InOut /*z*/, InOut /*rate*/) { return false; }
  virtual void reset() {}                                    // forgets every rebase()
  virtual std::vector<double> memory() const { return {}; }  // as System::memory()
  virtual void recall(In /*memory*/) {}
  /// Null where the energy is not that of strains.
  virtual StrainForm* strain_form() { return nullptr; }
};

}  // namespace tress::models
