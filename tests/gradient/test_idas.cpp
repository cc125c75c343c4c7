#include <gtest/gtest.h>
#include <idas/idas.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>

#include <array>
#include <memory>
#include <stdexcept>
#include <type_traits>

#include "integrators/sundials/dae_form.h"
#include "tests/gradient/strand_runs.h"

/// Gradients of runs with constraints against staggered forward sensitivities of IDAS,
/// which integrates the variational equations of F(t, y, y'; p) = 0 in the stabilised
/// form of index 2 by its own multistep method. The methods tested here solve index 3:
/// neither the form nor the derivatives are shared. IDAS defines the symbols of IDA: this
/// program is linked with the former in place of the latter.
namespace tress::test_idas {

using namespace testing_support;

constexpr double end_time = 0.1;  // s
// Of the parameter's unit. Central differences leave 1e-6 of third derivatives, and g is
// quadratic. Rounding of g over this distance and over the step is noise of mu, which
// must stay below its tolerance.
constexpr double distance = 1e-3;

struct Case {
  std::string model;
  Varied varied;
  ModelSettings settings;
};

std::vector<Case> cases() {
  return {{"inextensible_chain", {"length_m", 1, 1}, {{"links", "4"}}},
          {"tinkertoys", {"length_m", 1, 1}, {{"structure", "net"}}},
          {"bead_on_wire", {"pitch_m", 0.5, 0.5}, {{"curve", "helix"}}}};
}

StrandRun run_of(const Case& c) {
  StrandRun run{&find_model(c.model), c.settings, {}, {}, {end_time}};
  run.settings.emplace_back(c.varied.key, number_text(c.varied.value));
  run.options.newton_tolerance = 1e-13;
  run.options.formulation = Formulation::index3;
  return run;
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
  if (code < 0) throw std::runtime_error("IDAS: code " + std::to_string(code));
}

/// F at the parameter and at both sides of it.
class Equations {
 public:
  Equations(const StrandRun& run, const Varied& varied) {
    Options options;
    options.formulation = Formulation::index2_ggl;
    for (const double side : {0.0, 1.0, -1.0}) {
      systems_.push_back(
          run.make(varied.key, varied.value + side * distance * varied.unit));
      forms_.push_back(std::make_unique<DaeForm>(*systems_.back(), options));
    }
    const DaeForm& form = *forms_.front();
    count_ = 2 * (form.n + form.m);
  }

  std::size_t count() const { return count_; }
  DaeForm& form() { return *forms_.front(); }
  System& system() { return *systems_.front(); }

  /// Consistent y and y' at the start, and their derivatives by the parameter.
  void start(Out y, Out y_dot, Out s, Out s_dot) {
    std::array<std::vector<double>, 3> at, rate;
    for (std::size_t k = 0; k < 3; ++k) {
      at[k].resize(count_), rate[k].resize(count_);
      const std::size_t n = forms_[k]->n;
      systems_[k]->initial_state(Out(at[k]).first(n), Out(at[k]).subspan(n, n));
      if (forms_[k]->consistent(0, at[k], rate[k]) != Status::ok) require(-1);
    }
    for (std::size_t i = 0; i < count_; ++i) {
      y[i] = at[0][i], y_dot[i] = rate[0][i];
      s[i] = (at[1][i] - at[2][i]) / (2 * distance);
      s_dot[i] = (rate[1][i] - rate[2][i]) / (2 * distance);
    }
  }

  static int call(sunrealtype t, N_Vector y, N_Vector y_dot, N_Vector f, void* self) {
    return static_cast<Equations*>(self)->of(0, t, y, y_dot, f);
  }

  /// Of the sensitivity: the derivative along (s, s', p), a central difference.
  static int call(int, sunrealtype t, N_Vector y, N_Vector y_dot, N_Vector, N_Vector* s,
                  N_Vector* s_dot, N_Vector* f, void* self, N_Vector at, N_Vector rate,
                  N_Vector part) {
    for (const double side : {distance, -distance}) {
      N_VLinearSum(1, y, side, s[0], at);
      N_VLinearSum(1, y_dot, side, s_dot[0], rate);
      const int code =
          static_cast<Equations*>(self)->of(side > 0 ? 1 : 2, t, at, rate, part);
      if (code != 0) return code;
      if (side > 0) {
        N_VScale(0.5 / side, part, f[0]);
      } else {
        N_VLinearSum(0.5 / side, part, 1, f[0], f[0]);
      }
    }
    return 0;
  }

 private:
  int of(std::size_t k, double t, N_Vector y, N_Vector y_dot, N_Vector f) {
    const Status s = forms_[k]->residual(t, {N_VGetArrayPointer(y), count_},
                                         {N_VGetArrayPointer(y_dot), count_},
                                         {N_VGetArrayPointer(f), count_});
    return s == Status::ok ? 0 : s == Status::retry ? 1 : -1;
  }

  std::vector<std::unique_ptr<System>> systems_;
  std::vector<std::unique_ptr<DaeForm>> forms_;
  std::size_t count_ = 0;
};

/// dq/dp at the end.
std::vector<double> by_idas(const Case& c) {
  constexpr double relative = 1e-8, absolute = 1e-9;  // over typical sizes
  Equations equations(run_of(c), c.varied);
  const std::size_t n = equations.form().n, m = equations.form().m;
  const auto count = static_cast<sunindextype>(equations.count());
  const sundials::Context context;
  const Vector y(N_VNew_Serial(count, context)), y_dot(N_VClone(y.get())),
      s(N_VClone(y.get())), s_dot(N_VClone(y.get())), tolerances(N_VClone(y.get())),
      id(N_VClone(y.get()));
  const auto all = [&](const Vector& x) {
    return Out(N_VGetArrayPointer(x.get()), equations.count());
  };
  equations.start(all(y), all(y_dot), all(s), all(s_dot));
  equations.form().differential(all(id));
  const Out typical = all(tolerances);
  equations.system().scale(typical.first(n), typical.subspan(n, n));
  if (equations.form().multiplier_scale(0, all(y), typical.last(2 * m)) != Status::ok) {
    require(-1);
  }
  for (double& one : typical) one *= absolute;
  // Multipliers are not part of the error test. In short steps, rounding moves them more.
  for (double& one : typical.last(2 * m)) one *= 1e5;

  void* memory = IDACreate(context);
  const std::unique_ptr<void, void (*)(void*)> owner(memory,
                                                     [](void* x) { IDAFree(&x); });
  IDAResFn of_state = &Equations::call;
  IDASensResFn of_sensitivity = &Equations::call;
  require(IDAInit(memory, of_state, 0, y.get(), y_dot.get()));
  require(IDASetUserData(memory, &equations));
  require(IDASVtolerances(memory, relative, tolerances.get()));
  require(IDASetId(memory, id.get()));
  require(IDASetSuppressAlg(memory, SUNTRUE));
  require(IDASetMaxNumSteps(memory, 1'000'000));
  // Its own first step, half a tolerance over y', is so short that rounding of v over the
  // step is all of v'.
  require(IDASetInitStep(memory, 1e-6));
  const std::unique_ptr<std::remove_pointer_t<SUNMatrix>, Destroy<SUNMatDestroy>> matrix(
      SUNDenseMatrix(count, count, context));
  const std::unique_ptr<std::remove_pointer_t<SUNLinearSolver>, Destroy<SUNLinSolFree>>
      solver(SUNLinSol_Dense(y.get(), matrix.get(), context));
  require(IDASetLinearSolver(memory, solver.get(), matrix.get()));
  std::array<N_Vector, 1> by{s.get()}, by_dot{s_dot.get()}, by_typical{tolerances.get()};
  require(
      IDASensInit(memory, 1, IDA_STAGGERED, of_sensitivity, by.data(), by_dot.data()));
  require(IDASensSVtolerances(memory, relative, by_typical.data()));
  require(IDASetSensErrCon(memory, SUNTRUE));
  require(IDASetStopTime(memory, end_time));
  double t = 0;
  require(IDASolve(memory, end_time, &t, y.get(), y_dot.get(), IDA_NORMAL));
  require(IDAGetSens(memory, &t, by.data()));
  const Out found = all(s).first(n);
  return {found.begin(), found.end()};
}

class IdasGradient : public testing::TestWithParam<Case> {};

// The error of a gradient falls with the order of the method, less a half, down to what a
// tolerance of 1e-8 for each of IDAS' steps adds up to.
TEST_P(IdasGradient, IsTheLimitOfGradientsOfRuns) {
  constexpr double left = 1e-6;
  const Case& c = GetParam();
  const std::vector<double> exact = by_idas(c);
  ASSERT_GT(largest_of(exact), 1e-3);
  const StrandRun base = run_of(c);
  for (const std::string& method : stage_methods()) {
    if (method == "implicit_midpoint") continue;  // unstable on index 3
    const int order = method == "backward_euler" ? 1 : 2;
    double before = 0;
    for (const int steps : {200, 400}) {
      StrandRun run = base;
      run.method = method;
      run.options.step = end_time / steps;
      const auto system = run.make();
      const std::vector<RunParameter> parameters{run.parameter(c.varied)};
      GradientRun gradient(*system, run.make(), parameters, {run.method, run.options});
      ASSERT_EQ(gradient.start(), Status::ok) << method << ": " << gradient.failure();
      ASSERT_EQ(gradient.advance(end_time), Status::ok) << gradient.failure();
      const In dq = gradient.dq(0);
      const double error = apart({dq.begin(), dq.end()}, exact);
      if (steps == 400) {
        EXPECT_LT(error, std::max(left, before / std::exp2(order - 0.5)))
            << method << ", before " << before;
        EXPECT_LT(error, order == 1 ? 0.05 : 1e-3) << method;
      }
      before = error;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Systems, IdasGradient, testing::ValuesIn(cases()),
                         [](const auto& c) { return c.param.model; });

}  // namespace tress::test_idas
