#pragma once

#include <vector>

#include "contract/forms/compliance_form.h"
#include "models/supports/added_forces.h"
#include "models/supports/natural_motion.h"

namespace tress::models {

/// The ComplianceForm of a strand with the springs of compliant supports as blocks of
/// their own, after those of the strand, and with moments as part of all other forces.
class SupportedCompliance final : public ComplianceForm {
 public:
  /// Returns true if the form can be made: the strand has one, all springs hold single
  /// points of mass, and no joints are added.
  static bool available(System& strand, const AddedForces& forces);
  /// All arguments must outlive it. `natural` moves the natural strains of the strand.
  SupportedCompliance(System& strand, AddedForces& forces, NaturalMotion& natural);

  const std::vector<Block>& blocks() const override { return blocks_; }
  void inverse_mass(Out w) const override { form_.inverse_mass(w); }
  Status rest(double t, In q, In v, Out a) noexcept override;
  void evaluate(double t, std::size_t k, In x, Value& value) noexcept override;
  bool add_second(double t, std::size_t k, In x, In stress, Second& h) noexcept override;
  const std::vector<Orientation>& orientations() override { return form_.orientations(); }
  void orient(double t, double h, std::size_t k, In origin, InOut x) noexcept override;

 private:
  void prepare(double t) {
    if (natural_.any()) natural_.set(*strains_, t);
  }

  ComplianceForm& form_;
  NaturalStrains* strains_;
  AddedForces& forces_;
  NaturalMotion& natural_;
  std::size_t own_;            // blocks of the strand
  std::vector<Block> blocks_;  // all
  std::vector<double> weight_, w_, moments_;
};

}  // namespace tress::models
