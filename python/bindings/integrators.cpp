// One method on one system, stepped without the interpreter's lock.
#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <chrono>

#include "contract/forms/teleports.h"
#include "contract/input_error.h"
#include "integrators/catalogue.h"
#include "integrators/integrator_options.h"
#include "python/bindings/owned_system.h"

namespace tress::python {
namespace {

using integrators::find_integrator;
using integrators::IntegratorEntry;
using Texts = std::vector<std::pair<std::string, std::string>>;

class Stepper {
 public:
  Stepper(const std::string& id, std::shared_ptr<OwnedSystem> system, const Texts& texts)
      : id_(id), system_(std::move(system)) {
    for (const auto& [key, value] : texts) {
      const auto readers = integrators::readers_of_option(key);
      if (!readers.empty() &&
          std::ranges::count(readers, id, &IntegratorEntry::id) == 0) {
        throw InputError(
            "the option '" + key + "' is one of " + std::string(readers.front()->id), key,
            "leave it out");
      }
      integrators::apply(options_, key, value, key);
    }
    const IntegratorEntry& entry = find_integrator(id);
    if (options_.tolerance > 0) options_ = integrators::with_tolerance(entry, options_);
    method_ = integrators::make_integrator(id, system_->free(), options_);
  }

  void start(double t, const Numbers& q, const Numbers& v) {
    const Stepping mark(*system_);
    const In x = in(q, system_->n(), "q"), u = in(v, system_->n(), "v");
    const Status status = method_->start(t, x, u);
    raise_pending(*system_->system);
    if (status != Status::ok) throw SolveError(method_->failure());
    started_ = true;
  }

  /// Whether t_end was reached; not, if the observer has ended the run.
  bool advance(double t_end, const py::object& observer) {
    if (!started_) {
      throw InputError("the run has no state to begin with", "Integrator.advance",
                       "call start(t, q, v) first");
    }
    const Stepping mark(*system_);
    bool ended = false;
    std::exception_ptr raised;
    const auto locked = [&](const auto& call) {
      const py::gil_scoped_acquire lock;
      try {
        return call();
      } catch (...) {
        raised = std::current_exception();
        return false;
      }
    };
    auto looked = Clock::now();
    const auto each_step = [&](double t, In q, In v) {
      if (const auto now = Clock::now(); now - looked > between_signals) {
        looked = now;
        const bool go_on = locked([] {
          if (PyErr_CheckSignals() != 0) throw py::error_already_set();
          return true;
        });
        if (!go_on) return false;
      }
      if (observer.is_none()) return true;
      return locked([&] {
        const py::object answer = observer(t, copy(q), copy(v));
        ended = answer.is(py::bool_(false));
        return !ended;
      });
    };
    const Teleports* const jumps = teleports(*system_->system);
    refuse_if(jumps != nullptr && jumps->next_teleport(method_->time()) <= t_end,
              "a root that teleports, which an integrator alone does not follow",
              "advance", "use Scene.run, or one row for each time");
    Status status = Status::ok;
    {
      const py::gil_scoped_release release;
      status = method_->advance(t_end, each_step);
    }
    if (raised) std::rethrow_exception(raised);
    raise_pending(*system_->system);
    if (ended) return false;
    if (status != Status::ok) throw SolveError(method_->failure());
    return true;
  }

  double time() const { return method_->time(); }
  In q() const { return method_->q(); }
  In v() const { return method_->v(); }
  const std::string& id() const { return id_; }

  py::dict stats() const {
    const Stats s = method_->stats();
    py::dict all;
    const auto put = [&](const char* key, auto value) { all[key] = value; };
    put("steps", s.steps);
    put("rejected", s.rejected);
    put("rejected_by_error", s.rejected_by_error);
    put("rejected_by_newton", s.rejected_by_newton);
    put("replaced", s.replaced);
    put("smallest_step_s", s.smallest_step);
    put("residuals", s.residuals);
    put("linearizations", s.linearizations);
    put("solves", s.solves);
    put("newton_iterations", s.newton_iterations);
    put("sweeps", s.sweeps);
    put("contact_iterations", s.contact_iterations);
    put("contact_unfinished", s.contact_unfinished);
    put("contact_violation_m_s", s.contact_violation);
    put("condition", s.condition);
    put("rank_deficiency", s.rank_deficiency);
    put("solver", std::string(s.solver));
    return all;
  }

 private:
  using Clock = std::chrono::steady_clock;
  /// Reading the clock takes about 30 ns, the interpreter's lock more.
  static constexpr std::chrono::milliseconds between_signals{50};

  std::string id_;
  std::shared_ptr<OwnedSystem> system_;
  Options options_;
  std::unique_ptr<Integrator> method_;
  bool started_ = false;
};

py::list methods() {
  py::list all;
  for (const IntegratorEntry& entry : integrators::integrator_catalogue()) {
    all.append(py::make_tuple(std::string(entry.id), entry.order(),
                              std::string(entry.summary), std::string(entry.source)));
  }
  return all;
}

py::list options() {
  py::list all;
  for (const Parameter& p : integrators::integrator_options()) {
    std::string readers;
    for (const IntegratorEntry* reader : integrators::readers_of_option(p.name)) {
      readers += (readers.empty() ? "" : "|") + std::string(reader->id);
    }
    all.append(py::make_tuple(std::string(p.name), p.default_text(),
                              std::string(p.choices), std::string(p.help), readers));
  }
  return all;
}

}  // namespace

void add_integrators(py::module_& m) {
  m.def("integrators", methods);
  m.def("integrator_options", options);
  m.def("refusal", [](const std::string& id, OwnedSystem& system,
                      const std::string& formulation) {
    Options wanted;
    integrators::apply(wanted, "formulation", formulation, "formulation");
    return integrators::refusal(find_integrator(id), system.free(), wanted.formulation);
  });
  py::class_<Stepper>(m, "Integrator")
      .def(py::init<const std::string&, std::shared_ptr<OwnedSystem>, const Texts&>())
      .def("start", &Stepper::start)
      .def("advance", &Stepper::advance)
      .def_property_readonly("id", &Stepper::id)
      .def_property_readonly("time", &Stepper::time)
      .def_property_readonly(
          "q",
          [](const py::object& self) { return view(self.cast<Stepper&>().q(), self); })
      .def_property_readonly(
          "v",
          [](const py::object& self) { return view(self.cast<Stepper&>().v(), self); })
      .def_property_readonly("stats", &Stepper::stats);
}

}  // namespace tress::python
