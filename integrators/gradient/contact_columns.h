#pragma once

#include <algorithm>
#include <limits>

#include "contract/forms/contact_form.h"
#include "integrators/gradient/contact_derivative.h"

namespace tress::integrators {

/// The contacts of the variational equations as a method of one implicit stage sees them:
/// it moves the derivatives of ContactForm::places() as it moves the columns. The forces
/// are found with the solution, so nothing is left to improve.
class ContactColumns final : public ContactForm {
 public:
  /// `form`: of the run's system. Both must outlive it.
  ContactColumns(ContactDerivative& contacts, ContactForm& form, std::size_t columns)
      : contacts_(contacts), form_(form), columns_(columns) {}

  void begin(double, double, In dq0, In dv0, In dx0) noexcept override {
    contacts_.begin_columns(dq0, dv0, dx0);
  }
  double improve(double, In, In) noexcept override { return 0; }
  double drive() const noexcept override { return 0; }
  void extrapolate() noexcept override {}
  double approach(double, In, In) noexcept override { return 0; }
  void release() noexcept override {}
  bool rebounds() const override { return form_.rebounds(); }
  std::vector<double> multipliers() const override { return {}; }
  void set_multipliers(In) override {}
  std::size_t tracked() const override { return columns_ * contacts_.tracked(); }
  void places(double, In dq, In, Out dx) noexcept override {
    const std::size_t n = dq.size() / columns_, tracked = contacts_.tracked();
    for (std::size_t k = 0; k < columns_; ++k) {
      contacts_.places(k, dq.subspan(k * n, n), dx.subspan(k * tracked, tracked));
    }
  }
  /// Methods of several stages ask for them.
  void slides(double, In, In, Out du) noexcept override {
    std::ranges::fill(du, std::numeric_limits<double>::quiet_NaN());
  }

 private:
  ContactDerivative& contacts_;
  ContactForm& form_;
  std::size_t columns_;
};

}  // namespace tress::integrators
