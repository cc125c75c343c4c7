// A System whose equations are Python functions. Its calls take the interpreter's lock;
// an exception ends the step and is raised again by the call that was made from Python.
#include <exception>
#include <limits>
#include <stdexcept>

#include "contract/forms/energetics.h"
#include "contract/forms/sparse_form.h"
#include "contract/pattern.h"
#include "experiments/numerics/dense_form.h"
#include "linear/dense_lu.h"
#include "python/bindings/owned_system.h"

namespace tress::python {
namespace {

std::vector<double> numbers(const py::handle& x) {
  const auto all = Numbers::ensure(x);
  if (!all) throw py::error_already_set();
  return {all.data(), all.data() + all.size()};
}

class UserSystem final : public System, public SparseForm, public Energetics {
 public:
  explicit UserSystem(py::object model) : model_(std::move(model)) {
    const py::tuple start = model_.attr("initial_state")();
    if (start.size() != 2) refuse("initial_state", "return (q, v)");
    q_ = numbers(start[0]);
    v_ = numbers(start[1]);
    n_ = q_.size();
    if (n_ == 0 || v_.size() != n_) refuse("initial_state", "return q and v of one size");
    q_typ_.assign(n_, 1);
    v_typ_.assign(n_, 1);
    if (py::hasattr(model_, "scale")) {
      const py::tuple typical = model_.attr("scale")();
      q_typ_ = numbers(typical[0]);
      v_typ_ = numbers(typical[1]);
      const auto positive = [&](const std::vector<double>& x) {
        return x.size() == n_ && std::ranges::all_of(x, [](double s) { return s > 0; });
      };
      if (!positive(q_typ_) || !positive(v_typ_)) {
        refuse("scale", "return typical sizes of q and v, all above 0");
      }
    }
    has_tangent_ = py::hasattr(model_, "tangent");
    has_energy_ = py::hasattr(model_, "energy");
    has_power_ = py::hasattr(model_, "power");
    if (py::hasattr(model_, "constant_mass")) {
      traits_.constant_mass = model_.attr("constant_mass").cast<bool>();
    }
    const auto n = static_cast<int>(n_);
    pattern_ = {n, n, {0}, {}};
    for (int j = 0; j < n; ++j) {
      for (int i = 0; i < n; ++i) pattern_.row.push_back(i);
      pattern_.start.push_back(static_cast<int>(pattern_.row.size()));
    }
    matrix_.resize(n, n);
    lu_.emplace(n);
  }

  Layout layout() const override { return {static_cast<int>(n_), 0}; }
  Traits traits() const override { return traits_; }
  void initial_state(Out q, Out v) const override {
    std::ranges::copy(q_, q.begin());
    std::ranges::copy(v_, v.begin());
  }
  void scale(Out q_typ, Out v_typ) const override {
    std::ranges::copy(q_typ_, q_typ.begin());
    std::ranges::copy(v_typ_, v_typ.begin());
  }

  Status residual(double t, In q, In v, In a, Out r) noexcept override {
    return guarded([&] {
      // Copies: a function may keep what it is given.
      const auto answer =
          Numbers::ensure(model_.attr("residual")(t, copy(q), copy(v), copy(a)));
      if (!answer) throw py::error_already_set();
      std::ranges::copy(in(answer, n_, "residual"), r.begin());
    });
  }

  const Pattern& pattern() const override { return pattern_; }
  Status values(double t, In q, In v, In a, Weights w, Out s) noexcept override {
    const Status filled = fill(t, q, v, a, w);
    if (filled == Status::ok) std::copy_n(matrix_.data(), n_ * n_, s.begin());
    return filled;
  }
  Status linearize(double t, In q, In v, In a, Weights w) noexcept override {
    const Status filled = fill(t, q, v, a, w);
    if (filled != Status::ok) return filled;
    if (!matrix_.allFinite()) return Status::retry;
    return lu_->factor(matrix_) > 0 ? Status::ok : Status::retry;
  }
  Status solve(In b, Out x) noexcept override {
    if (x.data() != b.data()) std::ranges::copy(b, x.begin());
    lu_->solve(Eigen::Map<Eigen::VectorXd>(x.data(), static_cast<Eigen::Index>(n_)));
    return Status::ok;
  }

  SparseForm* sparse_form() override { return this; }
  Energetics* energetics() override { return has_energy_ ? this : nullptr; }

  Energy energy(double t, In q, In v) override {
    Energy now;
    static_cast<void>(guarded([&] {
      const py::tuple answer = model_.attr("energy")(t, copy(q), copy(v));
      now = {answer[0].cast<double>(), answer[1].cast<double>()};
    }));
    return now;
  }
  double power(double t, In q, In v) override {
    double p = 0;
    if (!has_power_) return p;
    static_cast<void>(
        guarded([&] { p = model_.attr("power")(t, copy(q), copy(v)).cast<double>(); }));
    return p;
  }

  void raise() {
    if (pending_) std::rethrow_exception(std::exchange(pending_, {}));
  }

 private:
  [[noreturn]] static void refuse(const char* function, const char* remedy) {
    throw InputError("not what a System needs", function, remedy);
  }

  template <class Call>
  Status guarded(const Call& call) noexcept {
    if (pending_) return Status::fatal;
    const py::gil_scoped_acquire lock;
    try {
      call();
      return Status::ok;
    } catch (...) {
      pending_ = std::current_exception();
      return Status::fatal;
    }
  }

  Status fill(double t, In q, In v, In a, Weights w) noexcept {
    if (has_tangent_) {
      return guarded([&] {
        py::object s =
            model_.attr("tangent")(t, copy(q), copy(v), copy(a), w.acc, w.vel, w.pos);
        if (py::hasattr(s, "toarray")) s = s.attr("toarray")();
        const auto rows = Numbers::ensure(s);
        if (!rows) throw py::error_already_set();
        const auto n = static_cast<Eigen::Index>(n_);
        matrix_ = Eigen::Map<
            const Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>>(
            in(rows, n_ * n_, "tangent").data(), n, n);
      });
    }
    try {
      matrix_ = experiments::tangent_of_residual(
          *this, {t, {q.begin(), q.end()}, {v.begin(), v.end()}, {a.begin(), a.end()}},
          w);
      return Status::ok;
    } catch (const std::exception&) {
      return Status::fatal;  // the residual has failed, whose exception is pending
    }
  }

  py::object model_;
  std::vector<double> q_, v_, q_typ_, v_typ_;
  std::size_t n_ = 0;
  Traits traits_;
  bool has_tangent_ = false, has_energy_ = false, has_power_ = false;
  Pattern pattern_;
  Eigen::MatrixXd matrix_;
  std::optional<DenseLu> lu_;
  std::exception_ptr pending_;
};

}  // namespace

std::unique_ptr<System> user_system(py::object model) {
  return std::make_unique<UserSystem>(std::move(model));
}

void raise_pending(System& system) {
  if (auto* user = dynamic_cast<UserSystem*>(&system)) user->raise();
}

}  // namespace tress::python
