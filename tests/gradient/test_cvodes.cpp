#include <cvodes/cvodes.h>
#include <gtest/gtest.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <array>
#include <memory>
#include <stdexcept>
#include <type_traits>

#include "contract/forms/explicit_form.h"
#include "tests/gradient/strand_runs.h"

/// Gradients of runs against forward sensitivities of CVODES, which integrates the
/// variational equations of y' = (v, a(q, v; p)) by its own multistep method, here with
/// derivatives from differences of accelerations. It shares nothing else with the methods
/// tested here. CVODES defines the symbols of CVODE: this program is
/// linked with the former in place of the latter.
namespace tress::test_cvodes {

using namespace testing_support;

constexpr double end_time = 0.05;  // s

StrandRun run_of(const std::string& model) {
  StrandRun run{&find_model(model), {}, {}, {}, {end_time}};
  // A soft thick strand, clamped, which starts out of its natural shape.
  run.settings = {{"elements", "2"},
                  {"radius_m", "1e-3"},
                  {"youngs_modulus_pa", "1e6"},
                  {"internal_friction_kg_m3_s", "1e-8"},
                  {"drag_kg_m_s", "2e-3"},
                  {"natural_curvature_per_m", "8"},
                  {"initial", model == "mass_spring" ? "natural" : "straight"},
                  {"motion", "shake"}};
  run.options.newton_tolerance = 1e-13;
  return run;
}

const std::array<Varied, 2>& varied() {
  static const std::array<Varied, 2> all{
      {{"youngs_modulus_pa", 1e6, 1e6}, {"drag_kg_m_s", 2e-3, 2e-3}}};
  return all;
}

template <auto destroy>
struct Destroy {
  template <class T>
  void operator()(T* x) const {
    destroy(x);
  }
};
using Vector = std::unique_ptr<std::remove_pointer_t<N_Vector>, Destroy<N_VDestroy>>;

void require(int code) {
  if (code < 0) throw std::runtime_error("CVODES: code " + std::to_string(code));
}

/// y' at relative changes p of the parameters. Accelerations are affine in both, on which
/// the mass does not depend.
class RightSide {
 public:
  explicit RightSide(const StrandRun& run) {
    systems_.push_back(run.make());
    for (const Varied& one : varied()) {
      systems_.push_back(run.make(one.key, one.value + one.unit));
    }
    part_.resize(static_cast<std::size_t>(systems_[0]->layout().coordinates));
    base_ = part_;
  }

  static int call(sunrealtype t, N_Vector y, N_Vector y_dot, void* self) {
    return static_cast<RightSide*>(self)->of(t, N_VGetArrayPointer(y), {0, 0},
                                             N_VGetArrayPointer(y_dot));
  }

  /// Of one sensitivity: the derivative along (s, p_k), a central difference.
  static int call(int, sunrealtype t, N_Vector y, N_Vector, int k, N_Vector s,
                  N_Vector s_dot, void* self, N_Vector at, N_Vector rate) {
    constexpr double e = 1e-5;  // 1e-10 of order, 1e-11 of rounding
    for (const double side : {e, -e}) {
      N_VLinearSum(1, y, side, s, at);
      const int code = static_cast<RightSide*>(self)->of(
          t, N_VGetArrayPointer(at), {k == 0 ? side : 0, k == 1 ? side : 0},
          N_VGetArrayPointer(rate));
      if (code != 0) return code;
      if (side > 0) {
        N_VScale(0.5 / side, rate, s_dot);
      } else {
        N_VLinearSum(0.5 / side, rate, 1, s_dot, s_dot);
      }
    }
    return 0;
  }

 private:
  int of(double t, double* y, std::array<double, 2> p, double* y_dot) {
    const std::size_t n = part_.size();
    std::copy(y + n, y + 2 * n, y_dot);
    for (std::size_t k = 0; k < systems_.size(); ++k) {
      const Status s = systems_[k]->explicit_form()->acceleration(t, {y, n}, {y + n, n},
                                                                  k == 0 ? base_ : part_);
      if (s != Status::ok) return s == Status::retry ? 1 : -1;
      for (std::size_t i = 0; i < n; ++i) {
        double& a = y_dot[n + i];
        a = k == 0 ? base_[i] : a + p[k - 1] * (part_[i] - base_[i]);
      }
    }
    return 0;
  }

  std::vector<std::unique_ptr<System>> systems_;  // the run's, at twice each parameter
  std::vector<double> base_, part_;
};

struct Sensitivities {
  std::vector<double> tip;
  std::array<std::vector<double>, 2> by;
};

/// Both parameters start in no state: their sensitivities begin at zero.
Sensitivities by_cvodes(const StrandRun& run) {
  constexpr double relative = 1e-8, absolute = 1e-10;  // over System::scale
  const auto system = run.make();
  const int n = system->layout().coordinates;
  const auto count = static_cast<std::size_t>(n);
  std::vector<double> q_typ(count), v_typ(count);
  system->scale(q_typ, v_typ);

  const sundials::Context context;
  const Vector y(N_VNew_Serial(2 * n, context)), tolerances(N_VClone(y.get()));
  double* const state = N_VGetArrayPointer(y.get());
  double* const typical = N_VGetArrayPointer(tolerances.get());
  system->initial_state({state, count}, {state + count, count});
  for (std::size_t i = 0; i < count; ++i) {
    typical[i] = absolute * q_typ[i];
    typical[count + i] = absolute * v_typ[i];
  }
  RightSide right(run);
  void* memory = CVodeCreate(CV_BDF, context);
  const std::unique_ptr<void, void (*)(void*)> owner(memory,
                                                     [](void* m) { CVodeFree(&m); });
  CVRhsFn of_state = &RightSide::call;
  CVSensRhs1Fn of_sensitivity = &RightSide::call;
  require(CVodeInit(memory, of_state, 0, y.get()));
  require(CVodeSetUserData(memory, &right));
  require(CVodeSVtolerances(memory, relative, tolerances.get()));
  require(CVodeSetMaxNumSteps(memory, 1'000'000));
  const std::unique_ptr<std::remove_pointer_t<SUNMatrix>, Destroy<SUNMatDestroy>> matrix(
      SUNDenseMatrix(2 * n, 2 * n, context));
  const std::unique_ptr<std::remove_pointer_t<SUNLinearSolver>, Destroy<SUNLinSolFree>>
      solver(SUNLinSol_Dense(y.get(), matrix.get(), context));
  require(CVodeSetLinearSolver(memory, solver.get(), matrix.get()));

  const Vector by_0(N_VClone(y.get())), by_1(N_VClone(y.get()));
  std::array<N_Vector, 2> by{by_0.get(), by_1.get()};
  std::array<N_Vector, 2> by_tolerances{tolerances.get(), tolerances.get()};
  for (N_Vector one : by) N_VConst(0, one);
  require(CVodeSensInit1(memory, 2, CV_STAGGERED, of_sensitivity, by.data()));
  require(CVodeSensSVtolerances(memory, relative, by_tolerances.data()));
  require(CVodeSetSensErrCon(memory, SUNTRUE));

  double t = 0;
  require(CVodeSetStopTime(memory, end_time));
  require(CVode(memory, end_time, y.get(), &t, CV_NORMAL));
  require(CVodeGetSens(memory, &t, by.data()));
  Sensitivities found;
  const In q{state, count};
  found.tip = tip(*system, end_time, q);
  // Derivatives of the tip along dq, by differences: it is smooth, and affine in nodes.
  for (std::size_t k = 0; k < by.size(); ++k) {
    constexpr double e = 1e-4;
    const In dq{N_VGetArrayPointer(by[k]), count};
    std::vector<double> plus(q.begin(), q.end()), minus(plus);
    for (std::size_t i = 0; i < count; ++i) {
      plus[i] += e * dq[i];
      minus[i] -= e * dq[i];
    }
    found.by[k] = tip(*system, end_time, plus);
    const std::vector<double> before = tip(*system, end_time, minus);
    for (std::size_t i = 0; i < 3; ++i) {
      found.by[k][i] = (found.by[k][i] - before[i]) / (2 * e);
    }
  }
  return found;
}

class CvodesGradient : public testing::TestWithParam<std::string> {};

// The error of a gradient falls with the order of the method, less a half where
// stretching is not yet resolved, down to what a tolerance of 1e-8 for each
// of CVODES' steps adds up to.
TEST_P(CvodesGradient, IsTheLimitOfGradientsOfRuns) {
  constexpr double left = 1e-6;
  const StrandRun strand = run_of(GetParam());
  const Sensitivities exact = by_cvodes(strand);
  for (const auto& by : exact.by) ASSERT_GT(largest_of(by), 1e-4);
  for (const std::string& method : stage_methods()) {
    const int order = method == "backward_euler" ? 1 : method == "esdirk43" ? 3 : 2;
    std::array<double, 2> before{};
    for (const int steps : {400, 800}) {
      StrandRun run = strand;
      run.method = method;
      run.options.step = end_time / steps;
      const TipGradient found =
          tip_gradient(run, std::vector<Varied>(varied().begin(), varied().end()));
      ASSERT_EQ(found.failure, "") << method;
      for (std::size_t k = 0; k < 2; ++k) {
        const double error = apart(found.by[k], exact.by[k]);
        if (steps == 800) {
          EXPECT_LT(error, std::max(left, before[k] / std::exp2(order - 0.5)))
              << method << " " << varied()[k].key << ", before " << before[k];
          EXPECT_LT(error, order == 1 ? 0.05 : 1e-2) << method;
        }
        before[k] = error;
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Models, CvodesGradient,
                         testing::Values("super_helix", "articulated_chain", "der",
                                         "mass_spring"),
                         [](const auto& c) { return c.param; });

}  // namespace tress::test_cvodes
