#include "integrators/sundials/arkode_mri.h"

#include <algorithm>
#include <cmath>

#include "integrators/entry.h"
#include "integrators/position_based/position_sweeps.h"
#include "integrators/position_based/vbd_options.h"
#include "integrators/sundials/driver.h"
#include "linear/finite.h"

namespace tress::integrators {
namespace {

constexpr std::string_view mri_id = "arkode_mri";
constexpr Parameter own[] = {
    {.name = "fast_steps",
     .help = "explicit fast steps in a slow step, 0: the fewest that are stable",
     .number = 0,
     .min = 0,
     .max = 1e6,
     .whole = true}};

// |lambda| h of a stable step: the Runge-Kutta method of order 4 is stable to 2.83 on the
// imaginary and to 2.78 on the negative real axis.
constexpr double stable_product = 2.5;

struct FreeTable {
  void operator()(ARKodeButcherTable table) const { ARKodeButcherTable_Free(table); }
};
struct FreeCoupling {
  void operator()(MRIStepCoupling coupling) const { MRIStepCoupling_Free(coupling); }
};

void set_runge_kutta(const ArkstepMemory& memory) {
  double nodes[] = {0, 0.5, 0.5, 1}, weights[] = {1. / 6, 1. / 3, 1. / 3, 1. / 6};
  double stages[] = {0, 0, 0, 0, 0.5, 0, 0, 0, 0, 0.5, 0, 0, 0, 0, 1, 0};
  const std::unique_ptr<std::remove_pointer_t<ARKodeButcherTable>, FreeTable> table(
      require(ARKodeButcherTable_Create(4, 4, 0, nodes, stages, weights, nullptr),
              "ARKodeButcherTable_Create"));
  require(ARKStepSetTables(memory.get(), 4, 0, nullptr, table.get()), "ARKStepSetTables");
}

void set_coupling(const MristepMemory& memory, int order) {
  const std::unique_ptr<std::remove_pointer_t<MRIStepCoupling>, FreeCoupling> coupling(
      require(MRIStepCoupling_LoadTable(order == 3 ? ARKODE_MRI_GARK_ERK33a
                                                   : ARKODE_MRI_GARK_ERK45a),
              "MRIStepCoupling_LoadTable"));
  require(MRIStepSetCoupling(memory.get(), coupling.get()), "MRIStepSetCoupling");
}

MRIStepInnerStepper stepper_of(const ArkstepMemory& memory) {
  MRIStepInnerStepper made = nullptr;
  require(ARKStepCreateMRIStepInnerStepper(memory.get(), &made),
          "ARKStepCreateMRIStepInnerStepper");
  return made;
}

std::string flexible_energy(System& system, Formulation formulation) {
  std::string why = compliances(system, formulation);
  if (why.empty() && has_rigid_rows(*system.compliance_form())) {
    why = "splits forces, which rows without compliance have not";
  }
  return why;
}

}  // namespace

FastRows::FastRows(System& system)
    : form_(*system.compliance_form()),
      w_(static_cast<std::size_t>(system.layout().coordinates)),
      fast_(form_.blocks().size()) {
  std::vector<double> q(w_.size()), v(w_.size());
  system.initial_state(q, v);
  form_.inverse_mass(w_);
  std::vector<double> squares;  // of the frequencies
  const auto each = [&](const auto& visit) {
    for (std::size_t k = 0; k < fast_.size(); ++k) {
      const Block& block = form_.blocks()[k];
      look(0, k, q);
      for (int row = 0; row < block.rows; ++row) {
        const auto r = static_cast<std::size_t>(row);
        visit(k, block, r, inverse_inertia(block, r));
      }
    }
  };
  each([&](std::size_t, const Block& block, std::size_t r, double inverse) {
    ++rows_;
    if (inverse > 0) squares.push_back(inverse / block.alpha[r]);
  });
  std::ranges::sort(squares);
  double least = 0, largest_ratio = least_ratio * least_ratio;
  for (std::size_t i = 1; i < squares.size(); ++i) {
    if (squares[i] < largest_ratio * squares[i - 1]) continue;
    largest_ratio = squares[i] / squares[i - 1];
    least = squares[i];
  }
  // With x_r the coordinates of row r, x^T S x = sum_r (g_r x_r)^2/alpha_r <=
  // max_r (g_r g_r^T/alpha_r) sum_r |x_r|^2, and a coordinate is in at most `most_shared`
  // of these rows.
  std::vector<int> shared(w_.size());
  double elastic = 0, friction = 0;
  each([&](std::size_t k, const Block& block, std::size_t r, double inverse) {
    const double square = inverse / block.alpha[r];
    if (inverse <= 0 || square < least) return;
    ++fast_rows_;
    fast_[k] |= 1u << r;
    elastic = std::max(elastic, square);
    friction = std::max(friction, block.friction[r] * inverse);
    for (std::size_t i = 0; i < block.coordinates.size(); ++i) {
      if (value_.gradient[r][i] == 0) continue;
      ++shared[static_cast<std::size_t>(block.coordinates[i])];
    }
  });
  const double most_shared =
      shared.empty() ? 0 : static_cast<double>(std::ranges::max(shared));
  fastest_ = std::sqrt(most_shared * elastic) + most_shared * friction;
}

void FastRows::look(double t, std::size_t k, In q) noexcept {
  const Block& block = form_.blocks()[k];
  double x[ComplianceForm::most_coordinates];
  for (std::size_t i = 0; i < block.coordinates.size(); ++i) {
    x[i] = q[static_cast<std::size_t>(block.coordinates[i])];
  }
  form_.evaluate(t, k, {x, block.coordinates.size()}, value_);
}

double FastRows::inverse_inertia(const Block& block, std::size_t row) const {
  double sum = 0;
  for (std::size_t i = 0; i < block.coordinates.size(); ++i) {
    const double slope = value_.gradient[row][i];
    sum += slope * slope * w_[static_cast<std::size_t>(block.coordinates[i])];
  }
  return sum;
}

void FastRows::add(bool fast, double t, In q, In v, Out a) noexcept {
  for (std::size_t k = 0; k < fast_.size(); ++k) {
    const Block& block = form_.blocks()[k];
    const unsigned all = (1u << block.rows) - 1;
    const unsigned chosen = fast ? fast_[k] : all & ~fast_[k];
    if (chosen == 0) continue;
    look(t, k, q);
    for (std::size_t r = 0; chosen >> r != 0; ++r) {
      if ((chosen >> r & 1u) == 0) continue;
      const double* slope = value_.gradient[r];
      double rate = value_.drift[r];
      for (std::size_t i = 0; i < block.coordinates.size(); ++i) {
        rate += slope[i] * v[static_cast<std::size_t>(block.coordinates[i])];
      }
      const double stress = value_.c[r] / block.alpha[r] + block.friction[r] * rate;
      for (std::size_t i = 0; i < block.coordinates.size(); ++i) {
        const auto at = static_cast<std::size_t>(block.coordinates[i]);
        a[at] -= w_[at] * slope[i] * stress;
      }
    }
  }
}

ArkodeMri::ArkodeMri(System& system, const Options& options)
    : FixedStep(system, options),
      rows_(system),
      form_(*system.compliance_form()),
      y_(context_, 2 * system.layout().coordinates),
      fast_(require(
          ARKStepCreate(&fast_callback, nullptr, 0, y_.handle(), context_.handle()),
          "ARKStepCreate")),
      inner_(stepper_of(fast_)),
      slow_(require(MRIStepCreate(&slow_callback, nullptr, 0, y_.handle(), inner_.get(),
                                  context_.handle()),
                    "MRIStepCreate")),
      fast_steps_(own_options(options, own).whole("fast_steps")) {
  require(send_messages(fast_, context_.messages), "ARKStepSetErrHandlerFn");
  require(send_messages(slow_, context_.messages), "MRIStepSetErrHandlerFn");
  require(ARKStepSetUserData(fast_.get(), this), "ARKStepSetUserData");
  require(MRIStepSetUserData(slow_.get(), this), "MRIStepSetUserData");
  require(ARKStepSetMaxNumSteps(fast_.get(), -1), "ARKStepSetMaxNumSteps");
  set_runge_kutta(fast_);
  set_coupling(slow_, chosen_order(mri_id, options, 4, 3, 4));
}

int ArkodeMri::fast_callback(sunrealtype t, N_Vector y, N_Vector y_dot,
                             void* self) noexcept {
  return static_cast<ArkodeMri*>(self)->rate(true, t, y, y_dot);
}

int ArkodeMri::slow_callback(sunrealtype t, N_Vector y, N_Vector y_dot,
                             void* self) noexcept {
  return static_cast<ArkodeMri*>(self)->rate(false, t, y, y_dot);
}

int ArkodeMri::rate(bool fast, double t, N_Vector y, N_Vector y_dot) noexcept {
  const std::size_t n = q_.size();
  const In q = entries(y).first(n), v = entries(y).last(n);
  const Out q_dot = entries(y_dot).first(n), v_dot = entries(y_dot).last(n);
  Status status = Status::ok;
  ++dynamics_.stats.residuals;
  if (fast) {
    std::ranges::copy(v, q_dot.begin());
    std::ranges::fill(v_dot, 0.0);
  } else {
    std::ranges::fill(q_dot, 0.0);
    status = form_.rest(t, q, v, v_dot);
  }
  if (status == Status::ok) {
    rows_.add(fast, t, q, v, v_dot);
    if (!all_finite(v_dot)) status = Status::retry;
  }
  if (status != Status::ok && worst_ != Status::fatal) worst_ = status;
  return sundials_code(status);
}

Status ArkodeMri::step(double t, double h) {
  const double most = stable_product / rows_.fastest();
  const double fast = fast_steps_ > 0 ? h / fast_steps_ : std::min(h, most);
  worst_ = Status::ok;
  std::ranges::copy(q_, y_.values().begin());
  std::ranges::copy(v_, y_.values().begin() + static_cast<std::ptrdiff_t>(q_.size()));
  void* const slow = slow_.get();
  double end = t;
  const bool done = ARKStepSetFixedStep(fast_.get(), fast) >= 0 &&
                    MRIStepReset(slow, t, y_.handle()) >= 0 &&
                    MRIStepSetFixedStep(slow, h) >= 0 &&
                    MRIStepSetStopTime(slow, t + h) >= 0 &&
                    MRIStepEvolve(slow, t + h, y_.handle(), &end, ARK_ONE_STEP) >= 0;
  if (!done) return worst_ == Status::ok ? Status::retry : worst_;
  take(In(y_.values()).first(q_.size()), In(y_.values()).last(q_.size()));
  return Status::ok;
}

IntegratorEntry arkode_mri_entry() {
  return {.id = "arkode_mri",
          .summary = "MRI-GARK-ERK45a: stretch and twist in short steps inside each step",
          .source = "Sandu 2019, SUNDIALS ARKODE",
          .formulations = {{Formulation::parametric, 4}},
          .gaps = gaps_of_sweeps(),
          .parameters = own,
          .objection = flexible_energy,
          .make = make_method<ArkodeMri>};
}

}  // namespace tress::integrators
