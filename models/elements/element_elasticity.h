#pragma once

#include <memory>

#include "contract/forms/compliance_form.h"
#include "models/elements/rod_element.h"

namespace tress::models {

/// Sum of the energies of elements over the nodes z = (x_0, ..., x_n) of a strand. Node
/// -1 belongs to the clamp: it lies `behind` (m) the root on the clamp's tangent and
/// moves with the clamp. An element over nodes -1, 0, 1 therefore holds the direction of
/// the strand. O(elements).
class ElementElasticity final : public Elasticity, private StrainForm {
 public:
  /// Element and its place.
  struct Placed {
    int first;                            // node, >= -1
    std::unique_ptr<RodElement> element;  // element
  };
  /// Takes elements in order; `behind`: length of the clamp's edge, m.
  ElementElasticity(std::vector<Placed> elements, double behind);

  std::vector<std::vector<int>> groups() const override;
  void add_force(const Placement& p, InOut f) noexcept override;
  void add_tangent(const Placement& p, double pos, double vel,
                   GroupSum& s) noexcept override;
  double energy(const Placement& p) noexcept override;
  double power(const Placement& p) noexcept override;
  StrainForm* strain_form() override { return this; }
  bool takes_stresses() const override { return true; }

 private:
  /// An element's nodes, the first of which may be the clamp's.
  struct Local {
    double x[RodElement::most_coordinates], rate[RodElement::most_coordinates];
  };
  std::vector<ComplianceForm::Block> strain_blocks() const override;
  void strain(std::size_t k, const RootPose& root, const double* z,
              ComplianceForm::Value& value) noexcept override;
  void add_second(std::size_t k, const RootPose& root, const double* z, In stress,
                  ComplianceForm::Second& h) noexcept override;
  /// `z`, `rate`: of the element's first node that is not the clamp's.
  Local local(const Placed& at, const RootPose& root, const double* z,
              const double* rate) const noexcept;
  Local local(const Placed& at, const RootPose& root, In z, In rate) const noexcept;

  std::vector<Placed> elements_;  // along the strand
  double behind_;
};

}  // namespace tress::models
