#pragma once

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string_view>
#include <vector>

#include "contract/forms/compliance_form.h"
#include "contract/forms/energetics.h"
#include "contract/forms/sparse_form.h"
#include "contract/pattern.h"
#include "integrators/integrator_options.h"
#include "simulation/run/simulation.h"
#include "tests/support/drive.h"
#include "tests/support/small_systems.h"

/// Systems with a ComplianceForm.
namespace tress::testing_support {

using models::ModelSettings;
using simulation::make_model;

/// Equal masses (1 kg) on a line, joined by springs (1 m long) with friction; released
/// from a random state. Linear: backward Euler's step is one linear solve.
class MassLine final : public System,
                       private SparseForm,
                       private ComplianceForm,
                       private Energetics {
 public:
  MassLine(int masses, double stiffness, double friction)
      : n_(masses),
        k_(stiffness),
        c_(friction),
        pattern_(dense_pattern(masses)),
        solver_(make_linear_solver(LinearKind::dense, pattern_)),
        s_(static_cast<std::size_t>(masses * masses)) {
    for (int i = 0; i + 1 < masses; ++i) {
      blocks_.push_back({{i, i + 1}, 1, {1 / stiffness}, {friction}});
    }
  }

  Layout layout() const override { return {n_, 0}; }
  Traits traits() const override { return {true, true}; }
  void initial_state(Out q, Out v) const override {
    for (std::size_t i = 0; i < q.size(); ++i) {
      q[i] = static_cast<double>(i) + 0.3 * std::sin(7.0 * static_cast<double>(i));
      v[i] = std::cos(5.0 * static_cast<double>(i));
    }
  }
  void scale(Out q_typ, Out v_typ) const override {
    std::ranges::fill(q_typ, 1.0);
    std::ranges::fill(v_typ, 1.0);
  }
  Status residual(double, In q, In v, In a, Out r) noexcept override {
    std::ranges::copy(a, r.begin());
    for (std::size_t i = 0; i + 1 < q.size(); ++i) {
      const double force = k_ * (q[i + 1] - q[i] - 1) + c_ * (v[i + 1] - v[i]);
      r[i] -= force;
      r[i + 1] += force;
    }
    return Status::ok;
  }
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override {
    (void)values(t, q, v, a, w, s_);
    return solver_->factor(s_);
  }
  Status solve(In b, Out x) noexcept override {
    std::ranges::copy(b, x.begin());
    return solver_->solve(x);
  }
  SparseForm* sparse_form() override { return this; }
  ComplianceForm* compliance_form() override { return this; }
  Energetics* energetics() override { return this; }

 private:
  const Pattern& pattern() const override { return pattern_; }
  Status values(double, In q, In, In, Weights w, Out s) noexcept override {
    const std::size_t n = q.size();
    std::ranges::fill(s, 0.0);
    for (std::size_t i = 0; i < n; ++i) s[i * n + i] = w.acc;
    const double k = w.pos * k_ + w.vel * c_;
    for (std::size_t i = 0; i + 1 < n; ++i) {
      s[i * n + i] += k;
      s[(i + 1) * n + i + 1] += k;
      s[i * n + i + 1] -= k;
      s[(i + 1) * n + i] -= k;
    }
    return Status::ok;
  }
  const std::vector<Block>& blocks() const override { return blocks_; }
  void inverse_mass(Out w) const override { std::ranges::fill(w, 1.0); }
  Status rest(double, In, In, Out a) noexcept override {
    std::ranges::fill(a, 0.0);
    return Status::ok;
  }
  void evaluate(double, std::size_t, In x, Value& value) noexcept override {
    value.c[0] = x[1] - x[0] - 1;
    value.drift[0] = 0;
    value.gradient[0][0] = -1;
    value.gradient[0][1] = 1;
  }
  Energy energy(double, In q, In v) override {
    Energy e;
    for (std::size_t i = 0; i < q.size(); ++i) {
      e.kinetic += v[i] * v[i] / 2;
      if (i > 0) e.potential += k_ / 2 * std::pow(q[i] - q[i - 1] - 1, 2);
    }
    return e;
  }
  double power(double, In, In) override { return std::nan(""); }

  int n_;
  double k_, c_;
  Pattern pattern_;
  std::unique_ptr<LinearSolver> solver_;
  std::vector<double> s_;
  std::vector<Block> blocks_;
};

/// Where the system is after `t_end`.
inline std::vector<double> at_end(std::string_view id, System& system,
                                  const Options& options, double t_end) {
  Drive drive(id, system, options);
  EXPECT_EQ(drive.to(t_end), Status::ok) << drive.integrator->failure();
  return {drive.integrator->q().begin(), drive.integrator->q().end()};
}

/// As in test_strands.cpp, without drag, which position-based
/// methods take from the start of the step.
inline std::unique_ptr<System> soft_strand(std::string_view model) {
  ModelSettings settings = {{"elements", "3"},
                            {"radius_m", "1e-3"},
                            {"natural_curvature_per_m", "8"},
                            {"youngs_modulus_pa", "1e6"},
                            {"internal_friction_kg_m3_s", "1e-8"},
                            {"motion", "shake_rotate"}};
  if (model != "mass_spring") settings.emplace_back("norm", "1");
  if (model == "corde") settings.emplace_back("coupling", "1");
  if (model == "xpbd_cosserat") settings.emplace_back("edge_inertia", "0.5");
  return make_model(model, settings);
}

}  // namespace tress::testing_support
