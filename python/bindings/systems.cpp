// System and its optional forms.
#include <pybind11/stl.h>

#include "contract/forms/constraint_form.h"
#include "contract/forms/contact_form.h"
#include "contract/forms/energetics.h"
#include "contract/forms/explicit_form.h"
#include "contract/forms/history.h"
#include "contract/forms/material_points.h"
#include "contract/forms/sparse_form.h"
#include "contract/pattern.h"
#include "experiments/numerics/dense_form.h"
#include "models/catalogue.h"
#include "python/bindings/owned_system.h"
#include "simulation/run/simulation.h"

namespace tress::python {
namespace {

/// Raises what went wrong in a call at (t, q, v).
void require(Status status, OwnedSystem& owner, const char* what, double t = 0, In q = {},
             In v = {}) {
  raise_pending(*owner.system);
  if (status == Status::ok) return;
  std::string text = std::string(what) + " has no result";
  if (!q.empty()) {
    text += " at t = " + number_text(t) + " s";
    const std::string culprit = owner.system->not_finite(t, q, v);
    if (!culprit.empty()) text += ": not finite: " + culprit;
  }
  throw SolveError(text);
}

template <class Form>
Form& required(Form* form, const char* what) {
  if (form == nullptr) {
    throw InputError(std::string("the system has no ") + what, "System",
                     "ask System.has() before");
  }
  return *form;
}

/// (rows, columns) of compressed columns: data, row indices, starts, shape.
py::tuple columns(const Pattern& p, py::array_t<double> values) {
  return py::make_tuple(std::move(values), copy<int>(p.row), copy<int>(p.start),
                        py::make_tuple(p.rows, p.cols));
}

py::array_t<double> residual(OwnedSystem& s, double t, const Numbers& q, const Numbers& v,
                             const Numbers& a) {
  const In x = in(q, s.n(), "q"), u = in(v, s.n(), "v");
  auto r = array(s.n());
  require(s.free().residual(t, x, u, in(a, s.n(), "a"), out(r)), s, "residual", t, x, u);
  return r;
}

/// Returns compressed columns where the model provides them, else an (n, n) matrix by
/// differences.
py::object tangent(OwnedSystem& s, double t, const Numbers& q, const Numbers& v,
                   const Numbers& a, const Weights& w) {
  const In x = in(q, s.n(), "q"), u = in(v, s.n(), "v"), b = in(a, s.n(), "a");
  if (SparseForm* form = s.free().sparse_form()) {
    auto values = array(static_cast<std::size_t>(form->pattern().nonzeros()));
    require(form->values(t, x, u, b, w, out(values)), s, "tangent", t, x, u);
    return columns(form->pattern(), std::move(values));
  }
  const Eigen::MatrixXd all = experiments::tangent_of_residual(
      *s.system, {t, {x.begin(), x.end()}, {u.begin(), u.end()}, {b.begin(), b.end()}},
      w);
  const auto n = static_cast<py::ssize_t>(s.n());
  py::array_t<double, py::array::f_style> dense({n, n});
  std::copy_n(all.data(), all.size(), dense.mutable_data());
  return dense;
}

py::tuple energy(OwnedSystem& s, double t, const Numbers& q, const Numbers& v) {
  const Energy e = required(s.free().energetics(), "energies")
                       .energy(t, in(q, s.n(), "q"), in(v, s.n(), "v"));
  raise_pending(*s.system);
  return py::make_tuple(e.kinetic, e.potential);
}

py::object momentum(OwnedSystem& s, double t, const Numbers& q, const Numbers& v) {
  const auto p = required(s.free().energetics(), "energies")
                     .momentum(t, in(q, s.n(), "q"), in(v, s.n(), "v"));
  if (!p) return py::none();
  return py::make_tuple(copy(p->linear), copy(p->angular));
}

ConstraintForm& constraints(OwnedSystem& s) {
  return required(s.free().constraint_form(), "constraints");
}

MaterialPoints& points(OwnedSystem& s) {
  return required(s.free().material_points(), "material points");
}

py::array_t<double> by_points(py::array_t<double> x) {
  return x.reshape(std::vector<py::ssize_t>{x.size() / 3, 3});
}

std::vector<std::string> forms(OwnedSystem& s) {
  System& system = s.free();
  std::vector<std::string> all;
  if (system.sparse_form()) all.emplace_back("sparse");
  if (system.explicit_form()) all.emplace_back("explicit");
  if (system.constraint_form()) all.emplace_back("constraints");
  if (system.energetics()) all.emplace_back("energy");
  if (system.material_points()) all.emplace_back("points");
  if (system.history()) all.emplace_back("history");
  if (system.contact_form()) all.emplace_back("contact");
  return all;
}

py::list models() {
  py::list all;
  for (const models::ModelEntry& entry : models::model_catalogue()) {
    all.append(py::make_tuple(std::string(entry.id), std::string(entry.summary),
                              std::string(entry.source)));
  }
  return all;
}

py::list model_options(const std::string& id) {
  py::list all;
  for (const Parameter& p : models::setup_parameters(models::find_model(id))) {
    all.append(py::make_tuple(std::string(p.name), p.default_text(),
                              std::string(p.choices), std::string(p.help)));
  }
  return all;
}

}  // namespace

System& OwnedSystem::free() const {
  if (stepping != std::thread::id{} && stepping != std::this_thread::get_id()) {
    throw SolveError("another thread steps this system: give each thread its own");
  }
  return *system;
}

Stepping::Stepping(OwnedSystem& system) : system_(system), before_(system.stepping) {
  system_.free();
  system_.stepping = std::this_thread::get_id();
}

void add_systems(py::module_& m) {
  m.def("models", models);
  m.def("model_options", model_options);
  m.def("model", [](const std::string& id, const models::ModelSettings& settings) {
    return OwnedSystem{simulation::make_model(id, settings), {}};
  });
  py::class_<OwnedSystem, std::shared_ptr<OwnedSystem>>(m, "System")
      .def(py::init([](py::object model) {
        return std::make_shared<OwnedSystem>(user_system(std::move(model)));
      }))
      .def_property_readonly("coordinates", &OwnedSystem::n)
      .def_property_readonly("constraints", &OwnedSystem::m)
      .def_property_readonly("traits",
                             [](const OwnedSystem& s) {
                               const Traits traits = s.free().traits();
                               return py::dict(
                                   py::arg("constant_mass") = traits.constant_mass,
                                   py::arg("regular_mass") = traits.regular_mass);
                             })
      .def("forms", forms)
      .def("initial_state",
           [](const OwnedSystem& s) {
             auto q = array(s.n()), v = array(s.n());
             s.free().initial_state(out(q), out(v));
             return py::make_tuple(q, v);
           })
      .def("scale",
           [](const OwnedSystem& s) {
             auto q = array(s.n()), v = array(s.n());
             s.free().scale(out(q), out(v));
             return py::make_tuple(q, v);
           })
      .def("residual", residual)
      .def("tangent",
           [](OwnedSystem& s, double t, const Numbers& q, const Numbers& v,
              const Numbers& a, double acc, double vel, double pos) {
             return tangent(s, t, q, v, a, {acc, vel, pos});
           })
      .def("linearize",
           [](OwnedSystem& s, double t, const Numbers& q, const Numbers& v,
              const Numbers& a, double acc, double vel, double pos) {
             const In x = in(q, s.n(), "q"), u = in(v, s.n(), "v");
             require(
                 s.free().linearize(t, x, u, in(a, s.n(), "a"), Weights{acc, vel, pos}),
                 s, "linearize", t, x, u);
           })
      .def("solve",
           [](OwnedSystem& s, const Numbers& b) {
             auto x = array(s.n());
             require(s.free().solve(in(b, s.n(), "b"), out(x)), s, "solve");
             return x;
           })
      .def("acceleration",
           [](OwnedSystem& s, double t, const Numbers& q, const Numbers& v) {
             const In x = in(q, s.n(), "q"), u = in(v, s.n(), "v");
             auto a = array(s.n());
             require(required(s.free().explicit_form(), "explicit form")
                         .acceleration(t, x, u, out(a)),
                     s, "acceleration", t, x, u);
             return a;
           })
      .def("accept",
           [](OwnedSystem& s, double t, const Numbers& q, const Numbers& v) {
             auto x = copy(in(q, s.n(), "q")), u = copy(in(v, s.n(), "v"));
             const bool changed = s.free().accept(t, out(x), out(u));
             return py::make_tuple(changed, x, u);
           })
      .def("reset", [](OwnedSystem& s) { s.free().reset(); })
      .def("memory", [](OwnedSystem& s) { return copy(s.free().memory()); })
      .def("recall",
           [](OwnedSystem& s, const Numbers& memory) {
             const std::size_t size = s.free().memory().size();
             s.system->recall(in(memory, size, "memory"));
           })
      .def("next_breakpoint",
           [](const OwnedSystem& s, double t) { return s.free().next_breakpoint(t); })
      .def("energy", energy)
      .def("momentum", momentum)
      .def("power",
           [](OwnedSystem& s, double t, const Numbers& q, const Numbers& v) {
             return required(s.free().energetics(), "energies")
                 .power(t, in(q, s.n(), "q"), in(v, s.n(), "v"));
           })
      .def("g",
           [](OwnedSystem& s, double t, const Numbers& q) {
             auto g = array(s.m());
             require(constraints(s).value(t, in(q, s.n(), "q"), out(g)), s, "g");
             return g;
           })
      .def("g_rate",
           [](OwnedSystem& s, double t, const Numbers& q, const Numbers& v) {
             auto g = array(s.m());
             require(constraints(s).rate(t, in(q, s.n(), "q"), in(v, s.n(), "v"), out(g)),
                     s, "g_rate");
             return g;
           })
      .def("jacobian_transposed",
           [](OwnedSystem& s, double t, const Numbers& q) {
             ConstraintForm& form = constraints(s);
             auto values = array(static_cast<std::size_t>(form.pattern().nonzeros()));
             require(form.gradient(t, in(q, s.n(), "q"), out(values)), s, "jacobian");
             return columns(form.pattern(), std::move(values));
           })
      .def("points",
           [](OwnedSystem& s, double t, const Numbers& q) {
             MaterialPoints& form = points(s);
             auto x = array(3 * static_cast<std::size_t>(form.count()));
             form.positions(t, in(q, s.n(), "q"), out(x));
             return by_points(std::move(x));
           })
      .def("point_velocities",
           [](OwnedSystem& s, double t, const Numbers& q, const Numbers& v) {
             MaterialPoints& form = points(s);
             auto u = array(3 * static_cast<std::size_t>(form.count()));
             form.velocities(t, in(q, s.n(), "q"), in(v, s.n(), "v"), out(u));
             return by_points(std::move(u));
           })
      .def("before", [](OwnedSystem& s) {
        MaterialPoints& form = points(s);
        std::vector<int> all;
        for (int i = 0; i < form.count(); ++i) all.push_back(form.before(i));
        return copy<int>(all);
      });
}

}  // namespace tress::python
