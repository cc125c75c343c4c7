#pragma once

#include <vector>

#include "contract/forms/compliance_form.h"
#include "integrators/fixed_step.h"
#include "integrators/sundials/sundials.h"

namespace tress::integrators {

/// Rows of a ComplianceForm in two parts: the fast ones oscillate at high frequencies. A
/// row with the gradient G has the frequency omega^2 = G W G^T/alpha of its constraint
/// alone, with everything else held. The frequencies at the start of a run, in ascending
/// order, are split where the ratio of neighbours is largest. Stretch is fast and bending
/// is slow where positions alone describe a strand. Where frames have an inertia of their
/// own, their bending is about as fast as stretch. Where no ratio reaches `least_ratio`,
/// all rows are fast.
class FastRows {
 public:
  static constexpr double least_ratio = 2;  // of frequencies of both parts

  /// Sorts the rows of the system at the start of its motion. Rows must have a compliance
  /// above 0; the system must outlive this.
  explicit FastRows(System& system);

  /// Adds the acceleration by the fast or the slow rows to a. [Macklin, Mueller &
  /// Chentanez 2016, eqs. 4 and 26]
  void add(bool fast, double t, In q, In v, Out a) noexcept;
  /// Upper bound of the rates |lambda| of the fast part (1/s), at the start of the
  /// motion.
  double fastest() const { return fastest_; }
  /// Returns the number of fast rows.
  int fast_rows() const { return fast_rows_; }
  /// Returns the number of rows.
  int rows() const { return rows_; }

 private:
  using Block = ComplianceForm::Block;

  /// Evaluates block k at q.
  void look(double t, std::size_t k, In q) noexcept;
  /// G W G^T of a row of the block that was evaluated last.
  double inverse_inertia(const Block& block, std::size_t row) const;

  ComplianceForm& form_;
  std::vector<double> w_;       // (n) the diagonal of W
  std::vector<unsigned> fast_;  // for each block, a bit for each fast row
  ComplianceForm::Value value_ = {};
  double fastest_ = 0;
  int fast_rows_ = 0, rows_ = 0;
};

/// Multirate infinitesimal steps of ARKODE: explicit slow steps of length `dt_s` around
/// explicit fast steps. The fast part has the rates q' = v and the acceleration of
/// FastRows, the slow part the other rows and all other forces. The slow method is
/// MRI-GARK-ERK45a of order 4, or ERK33a with `max_order` 3; the fast one is the
/// Runge-Kutta method of order 4. Conditionally stable in both parts. [Sandu 2019]
class ArkodeMri final : public FixedStep {
 public:
  /// Binds the method to a system with a compliance form, which must outlive it.
  ArkodeMri(System& system, const Options& options);

 private:
  static int fast_callback(sunrealtype t, N_Vector y, N_Vector y_dot,
                           void* self) noexcept;
  static int slow_callback(sunrealtype t, N_Vector y, N_Vector y_dot,
                           void* self) noexcept;
  int rate(bool fast, double t, N_Vector y, N_Vector y_dot) noexcept;
  Status step(double t, double h) override;

  FastRows rows_;
  ComplianceForm& form_;
  SundialsContext context_;
  SundialsVector y_;
  ArkstepMemory fast_;
  InnerStepper inner_;
  MristepMemory slow_;
  const int fast_steps_;       // in a slow step, 0: by fastest()
  Status worst_ = Status::ok;  // of the evaluations of a step
};

}  // namespace tress::integrators
