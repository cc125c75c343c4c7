// The matrix of held strands in O(n), loads and responses, against differences of the
// residual, the full matrix and runs with it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "contract/forms/bordered_form.h"
#include "contract/forms/support_forces.h"
#include "integrators/formulation/dynamics.h"
#include "linear/kkt.h"
#include "tests/models/supports/held_strand.h"
#include "tests/support/catalogue_cases.h"

namespace tress::test_bordered_supports {

using namespace testing_support;

constexpr double t = 0.013;  // s

struct Held {
  const char* name;
  const char* model;
  ModelSettings settings;
};
void PrintTo(const Held& c, std::ostream* out) { *out << c.name; }  // NOLINT

/// A strand on a ball joint in the middle and a clamp of the tip, which move; with a free
/// root, a clamp of the root as well.
std::unique_ptr<SupportedSystem> hold(const Held& of) {
  const ModelSettings settings = with(
      {{"elements", "6"}, {"motion", "shake_rotate"}, {"natural_curvature_per_m", "10"}},
      of.settings);
  auto strand = make_model(of.model, settings);
  const std::vector<Vec> x = places_at_start(*strand);
  Support tip =
      clamp_of_tip(*strand, of.model, settings, HeldPart::frame, {0.01, 0, 0.01}, 0.07);
  tip.path.rotations.push_back({{0, 1, 0}, rests({0, 0.05}, {0.1, 0.4})});
  tip.half_edge.friction = 1e-3 * tip.half_edge.stiffness;
  std::vector<Support> supports{support(3, x[3], {0.01, 0, 0.02}, 0.05), tip};
  if (std::ranges::find(settings, "free", &ModelSettings::value_type::second) !=
      settings.end()) {
    Support root = support(0, x[0], {0, 0.01, 0.02}, 0.05);
    if (sections(*strand)->section_kind(0).turning != Sections::Turning::nothing) {
      root.section = HeldPart::frame;
      root.path.frame = tip.path.frame;
    }
    supports.push_back(root);
  }
  return std::make_unique<SupportedSystem>(std::move(strand), supports);
}

class BorderedSupports : public testing::TestWithParam<Held> {
 protected:
  std::unique_ptr<SupportedSystem> system_ = hold(GetParam());
  States state_ = [this] {
    States made(*system_);
    made.shake(0.02);
    return made;
  }();
  /// Forces that turn a coordinate by its typical size in the typical time.
  std::vector<double> lambda_ = [this] {
    std::vector<double> of(state_.m);
    for (std::size_t k = 0; k < of.size(); ++k) {
      of[k] = (system_->rows().turns(int(k)) ? 1e-7 : 1e-5) * state_.uniform();
    }
    return of;
  }();

  /// r - G^T lambda at the state moved by s times w x.
  std::vector<double> residual(double s, Weights w, In x) {
    std::vector<double> q = state_.q, v = state_.v, a = state_.a, r(q.size());
    for (std::size_t i = 0; i < q.size(); ++i) {
      q[i] += s * w.pos * x[i];
      v[i] += s * w.vel * x[i];
      a[i] += s * w.acc * x[i];
    }
    EXPECT_EQ(system_->residual(t, q, v, a, r), Status::ok);
    const Pattern& pattern = system_->constraint_form()->pattern();
    std::vector<double> gt(std::size_t(pattern.nonzeros()));
    EXPECT_EQ(system_->constraint_form()->gradient(t, q, gt), Status::ok);
    for (std::size_t k = 0; k < lambda_.size(); ++k) {
      for (auto p = std::size_t(pattern.start[k]); p < std::size_t(pattern.start[k + 1]);
           ++p) {
        r[std::size_t(pattern.row[p])] -= lambda_[k] * gt[p];
      }
    }
    return r;
  }
};

/// S x = b for x = S^-1 b, with S x from differences of the residual. Steps change no
/// coordinate by more than 7e-4 of its typical size: the differences err by 1e-12 of
/// the terms, which cancel to b in stiff strands. Bar: 1e-8 of the largest term.
TEST_P(BorderedSupports, SolveWithTheDerivativeOfTheResidual) {
  ASSERT_TRUE(system_->bordered());
  double largest = 0;
  for (const double of : lambda_) largest = std::max(largest, std::abs(of));
  ASSERT_GT(largest, 0);
  for (const Weights w :
       {Weights{1, 1e-3, 1e-6}, Weights{1, 0, 1e-4}, Weights{1, 1e-2, 1e-4}}) {
    ASSERT_EQ(system_->linearize_bordered(t, state_.q, state_.v, state_.a, lambda_, w),
              Status::ok);
    std::vector<double> b = residual(0, w, state_.q), x(b.size());
    ASSERT_EQ(system_->solve(b, x), Status::ok);
    double size = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
      size = std::max({size, w.pos * std::abs(x[i]) / state_.q_typ[i],
                       w.vel * std::abs(x[i]) / state_.v_typ[i],
                       std::abs(x[i]) / state_.a_typ[i]});
    }
    const std::vector<double> found =
        central_difference(testing_support::difference_step / size,
                           [&](double s) { return residual(s, w, x); });
    double off = 0, terms = 0;
    for (std::size_t i = 0; i < b.size(); ++i) {
      off = std::max(off, state_.q_typ[i] * std::abs(found[i] - b[i]));
      terms = std::max(terms, state_.q_typ[i] * std::abs(b[i]));
    }
    std::printf("%s: %.1e of the residual\n", GetParam().name, off / terms);
    EXPECT_LE(off, 1e-8 * terms);
  }
}

/// Corrections of Newton's method against those of the full matrix, a sparse one with
/// constraints as rows. The full one is an inverse of solutions (1e-16 times a condition
/// of 1e6 in typical sizes) with second derivatives by differences (1e-10).
TEST_P(BorderedSupports, HaveTheCorrectionsOfTheFullMatrix) {
  SupportedSystem& system = *system_;
  Options options;
  options.formulation = Formulation::index3;
  integrators::Dynamics dynamics(system, options);
  SparseForm& form = *system.sparse_form();
  ConstraintForm& rows = *system.constraint_form();
  std::vector<double> s(std::size_t(form.pattern().nonzeros())),
      gt(std::size_t(rows.pattern().nonzeros()));
  Kkt kkt(LinearKind::automatic, form.pattern(), rows.pattern());
  for (const Weights w :
       {Weights{1, 0, 0}, Weights{1, 1e-3, 1e-6}, Weights{1, 0, 1e-4}}) {
    if (w.pos == 0 && !system.traits().regular_mass) continue;
    ASSERT_EQ(form.values(t, state_.q, state_.v, state_.a, w, s), Status::ok);
    if (w.pos != 0) {
      ASSERT_EQ(rows.add_curvature(t, state_.q, lambda_, -w.pos, s), Status::ok);
    }
    ASSERT_EQ(rows.gradient(t, state_.q, gt), Status::ok);
    ASSERT_EQ(kkt.factor(s, gt, gt), Status::ok);
    ASSERT_EQ(dynamics.linearize(t, state_.q, state_.v, state_.a, lambda_, w),
              Status::ok);
    EXPECT_EQ(dynamics.stats.solver, "bordered");
    EXPECT_EQ(dynamics.stats.rank_deficiency, 0);
    std::vector<double> b = residual(0, w, state_.q), c(state_.m);
    for (std::size_t k = 0; k < c.size(); ++k) {
      c[k] = (system.rows().turns(int(k)) ? 0.1 : 1e-3) * state_.uniform();
    }
    std::vector<double> x = b, y = c;
    for (double& entry : c) entry *= w.pos == 0 ? 1 : w.pos;  // as index 3 divides it
    ASSERT_EQ(dynamics.solve(b, c), Status::ok);
    ASSERT_EQ(kkt.solve(x, y), Status::ok);
    std::vector<double> sizes(y.size());
    for (std::size_t k = 0; k < y.size(); ++k) {
      sizes[k] = system.rows().turns(int(k)) ? system.rows().length() : 1;
    }
    std::printf("%s: x %.1e, y %.1e apart\n", GetParam().name,
                relative_difference(b, x, state_.a_typ),
                relative_difference(c, y, sizes));
    EXPECT_LE(relative_difference(b, x, state_.a_typ), 1e-7);
    EXPECT_LE(relative_difference(c, y, sizes), 1e-7);
  }
}

/// The forces at a frame take the mass matrix. A matrix that a method keeps is there
/// again afterwards, to the same bits.
TEST_P(BorderedSupports, KeepTheMatrixOfAMethodWhenTheirForcesAreRead) {
  ASSERT_EQ(system_->linearize_bordered(t, state_.q, state_.v, state_.a, lambda_,
                                        {1, 1e-3, 1e-6}),
            Status::ok);
  const std::vector<double> b = residual(0, {}, state_.q);
  std::vector<double> before(b.size()), after = before, forces(3 * system_->supports()),
                                        moments = forces;
  ASSERT_EQ(system_->solve(b, before), Status::ok);
  std::vector<double> q = state_.q, v = state_.v;
  system_->initial_state(q, v);
  ASSERT_EQ(system_->support_forces(0, q, v, forces, moments), Status::ok);
  ASSERT_EQ(system_->solve(b, after), Status::ok);
  EXPECT_EQ(after, before);
}

const ModelSettings none, free_root{{"motion", "free"}};
INSTANTIATE_TEST_SUITE_P(
    Models, BorderedSupports,
    testing::Values(Held{"super_helix", "super_helix", none},
                    Held{"super_helix_free", "super_helix", free_root},
                    Held{"super_helix_bend", "super_helix", {{"modes", "bend"}}},
                    Held{"super_clothoid", "super_clothoid", none},
                    Held{"super_clothoid_free", "super_clothoid", free_root},
                    Held{"articulated_chain", "articulated_chain", none},
                    Held{"articulated_chain_free", "articulated_chain", free_root},
                    Held{"force_transport", "force_transport", none}),
    [](const auto& test) { return std::string(test.param.name); });

/// The full matrix behind a system, instead of its own one.
class FullMatrix final : public System {
 public:
  explicit FullMatrix(SupportedSystem& of) : of_(of) {}
  Layout layout() const override { return of_.layout(); }
  Traits traits() const override { return of_.traits(); }
  void initial_state(Out q, Out v) const override { of_.initial_state(q, v); }
  void scale(Out q_typ, Out v_typ) const override { of_.scale(q_typ, v_typ); }
  Status residual(double s, In q, In v, In a, Out r) noexcept override {
    return of_.residual(s, q, v, a, r);
  }
  Status linearize(double s, In q, In v, In a, Weights w) noexcept override {
    return of_.linearize(s, q, v, a, w);
  }
  Status solve(In b, Out x) noexcept override { return of_.solve(b, x); }
  SparseForm* sparse_form() override { return of_.sparse_form(); }
  ConstraintForm* constraint_form() override { return of_.constraint_form(); }
  History* history() override { return of_.history(); }

 private:
  SupportedSystem& of_;
};

/// Runs of 20 steps with both matrices have the same solutions in the same number of
/// iterations. Corrections differ by 1e-9 of themselves (above). The last one of a stage
/// is below 1e-10, so rounding remains. A method with one correction a step changes q by
/// 0.1 of its typical size in it.
TEST(BorderedRuns, AreThoseOfTheFullMatrix) {
  for (const Held& of : {Held{"", "super_helix", none}, Held{"", "super_clothoid", none},
                         Held{"", "articulated_chain", none}}) {
    for (const auto& [method, formulation] :
         {std::pair{"backward_euler", Formulation::index3},
          std::pair{"bdf2", Formulation::index3},
          std::pair{"generalized_alpha", Formulation::index3},
          std::pair{"newmark", Formulation::index3},
          std::pair{"tr_bdf2", Formulation::index3},
          std::pair{"tr_bdf2", Formulation::projection},
          std::pair{"esdirk43", Formulation::projection},
          std::pair{"esdirk43", Formulation::baumgarte},
          std::pair{"implicit_midpoint", Formulation::projection},
          std::pair{"radau5", Formulation::projection},
          std::pair{"linearly_implicit_euler", Formulation::index3}}) {
      if (!integrators::find_integrator(method).order(formulation)) continue;
      const auto held = held_at_tip(of.model,
                                    {{"elements", "6"},
                                     {"radius_m", "1e-3"},
                                     {"youngs_modulus_pa", "1e6"},
                                     {"natural_curvature_per_m", "20"}},
                                    {-0.01, 0.02, 0.03}, 0.1);
      FullMatrix full(*held);
      State start{zeros(*held), zeros(*held)};
      held->initial_state(start.q, start.v);
      Options options;
      options.formulation = formulation;
      options.step = 1e-3;
      options.newton_tolerance = 1e-10;
      const Simulation fast = simulate(method, *held, options, start, 0.02),
                       slow = simulate(method, full, options, start, 0.02);
      ASSERT_EQ(fast.status, Status::ok) << method << fast.failure;
      ASSERT_EQ(slow.status, Status::ok) << method << slow.failure;
      std::vector<double> q_typ = zeros(*held), v_typ = q_typ;
      held->scale(q_typ, v_typ);
      const double apart = relative_difference(fast.state.q, slow.state.q, q_typ);
      std::printf("%s, %s, %s: %.1e apart, %ld and %ld iterations\n", of.model, method,
                  std::string(name(formulation)).c_str(), apart,
                  fast.stats.newton_iterations, slow.stats.newton_iterations);
      EXPECT_EQ(fast.stats.solver, "bordered");
      EXPECT_LE(apart, 1e-10) << of.model << ' ' << method;
      EXPECT_NEAR(double(fast.stats.newton_iterations),
                  double(slow.stats.newton_iterations),
                  0.02 * double(slow.stats.newton_iterations));
    }
  }
}

}  // namespace tress::test_bordered_supports
