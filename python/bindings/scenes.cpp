// Scenes as values, and their runs frame by frame: strands one by one, or one batch of
// hair.
#include <pybind11/stl.h>

#include <cmath>
#include <optional>

#include "python/bindings/owned_system.h"
#include "simulation/head/head_classes.h"
#include "simulation/head/head_run.h"
#include "simulation/head/scene_head.h"
#include "simulation/rest/supported_start.h"
#include "simulation/run/readout.h"
#include "simulation/scene/joint_table.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene/support_table.h"
#include "simulation/scene_text/schema.h"
#include "simulation/scene_text/write_scene.h"

namespace tress::python {
namespace {

using namespace simulation;
using ScenePtr = std::shared_ptr<const Scene>;

double radius_of(const Segment& segment) {
  return std::sqrt(segment.section.a1 * segment.section.a2);
}

/// Returns the radius (m) of the circle of the section's area at each point. It is that
/// at the tip of each segment where a strand has one point more than segments, otherwise
/// that of its root.
std::vector<double> radii(const Scene& scene, const std::vector<int>& points) {
  std::vector<double> all;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const auto count = static_cast<std::size_t>(points[k]);
    if (scene.strands.empty()) {
      all.insert(all.end(), count, std::nan(""));
      continue;
    }
    const std::vector<Segment>& segments = scene.strands[k].segments;
    for (std::size_t i = 0; i < count; ++i) {
      const bool tips = count == segments.size() + 1 && i > 0;
      all.push_back(radius_of(segments[tips ? i - 1 : 0]));
    }
  }
  return all;
}

std::vector<std::string> names(const std::vector<Reading>& readings) {
  std::vector<std::string> all;
  for (const Reading& reading : readings) all.push_back(reading.name);
  return all;
}

py::array_t<double> by_points(In x) {
  return copy(x).reshape(
      std::vector<py::ssize_t>{static_cast<py::ssize_t>(x.size()) / 3, 3});
}

/// Lets Ctrl-C end a run between two of its parts.
void look_for_signals() {
  if (PyErr_CheckSignals() != 0) throw py::error_already_set();
}

/// World in Python.
class StrandsRun {
 public:
  StrandsRun(ScenePtr scene, int threads)
      : scene_(std::move(scene)), world_(*scene_, threads), readout_(*scene_, world_) {}

  void advance(double t_end) {
    Status status = Status::ok;
    {
      const py::gil_scoped_release release;
      status = world_.advance(t_end);
    }
    look_for_signals();
    if (status == Status::ok) return;
    const Breach* breach = world_.breach();
    throw SolveError(breach != nullptr ? breach->message() : world_.failure());
  }

  /// Returns the frame of World with the quantities of Readout.
  py::dict frame() {
    const Frame3d read = readout_.read(world_);
    py::dict all;
    all["positions"] = by_points(world_.positions());
    all["velocities"] = by_points(world_.velocities());
    all["series"] = copy(read.series);
    const auto channels = static_cast<py::ssize_t>(readout_.channels().size());
    all["channels"] = copy<float>(read.channels)
                          .reshape(std::vector<py::ssize_t>{
                              channels, static_cast<py::ssize_t>(readout_.points())});
    all["contacts"] = copy<float>(read.contacts)
                          .reshape(std::vector<py::ssize_t>{
                              static_cast<py::ssize_t>(read.contacts.size() / 6), 6});
    return all;
  }

  const Scene& scene() const { return *scene_; }
  World& world() { return world_; }
  const Readout& readout() const { return readout_; }

 private:
  ScenePtr scene_;
  World world_;
  Readout readout_;
};

/// BatchRun in Python, with the guard that simulate has.
class BatchRun {
 public:
  BatchRun(ScenePtr scene, SceneOutline outline, int precision, int threads)
      : scene_(std::move(scene)), outline_(std::move(outline)) {
    refuse_if(precision != 64 && precision != 32,
              "precision = " + std::to_string(precision) + " is not available",
              "precision", "give 64 or 32");
    const models::HeadNumber number =
        precision == 64 ? models::HeadNumber::float64 : models::HeadNumber::float32;
    if (const auto no = no_single_head(outline_, number)) {
      throw InputError(no->reason, scene_->name, no->remedy);
    }
    run_.emplace(make_head(outline_, models::widest_pack(number), threads), threads);
    run_->energies(0, energies_);
  }

  /// In equal steps of at most dt_s; with a tolerance, in those that each strand needs.
  void advance(double t_end) {
    const double begin = t_, count = std::max(
                                 1.0, std::ceil((t_end - begin) /
                                                    longest_step(*scene_, run_->lanes()) -
                                                1e-9));
    const double h = (t_end - begin) / count;
    for (double i = 0; i < count; ++i) {
      {
        const py::gil_scoped_release release;
        run_->step(begin + i * h, h);
      }
      look_for_signals();
      t_ = begin + (i + 1) * h;
    }
    t_ = t_end;
    const py::gil_scoped_release release;
    run_->judge(t_);
    run_->energies(t_, energies_);
  }

  double time() const { return t_; }
  py::array_t<double> positions() {
    {
      const py::gil_scoped_release release;
      run_->positions(t_, x_);
    }
    return by_points(x_);
  }
  std::vector<std::size_t> failed() const {
    std::vector<std::size_t> all;
    for (std::size_t k = 0; k < strands(); ++k) {
      if (run_->head().lost(k)) all.push_back(k);
    }
    return all;
  }
  std::size_t strands() const { return run_->head().strands(); }
  std::size_t points() const { return run_->head().numbers() / 3; }
  /// Sums over the strands, J: kinetic, elastic, gravity.
  py::tuple energy() const {
    double kinetic = 0, elastic = 0, gravity = 0;
    for (const models::HeadEnergy& one : energies_) {
      kinetic += one.kinetic;
      elastic += one.elastic;
      gravity += one.gravity;
    }
    return py::make_tuple(kinetic, elastic, gravity);
  }
  std::vector<double> radii() const {
    std::vector<double> all;
    for (std::size_t k = 0; k < strands(); ++k) {
      const double root = radius_of(outline_.series->strand(k).segments.front());
      all.insert(all.end(), points(), root);
    }
    return all;
  }

 private:
  ScenePtr scene_;
  SceneOutline outline_;
  std::optional<HeadRun> run_;
  std::vector<models::HeadEnergy> energies_;
  std::vector<double> x_;
  double t_ = 0;
};

/// Strand i of the scene, or its mechanism, with the effects on it alone.
OwnedSystem system_of(const ScenePtr& scene, std::size_t strand) {
  if (scene->model->on_strand == nullptr) {
    return {scene->model->make(scene->model_options), scene};
  }
  if (strand >= scene->strands.size()) {
    throw InputError(
        "there is no strand " + std::to_string(strand), scene->name,
        "the scene has " + std::to_string(scene->strands.size()) + ", the first is 0");
  }
  std::unique_ptr<System> system = scene->model->on_strand(
      scene->strands[strand], scene->model_options, make_effects(*scene));
  refuse_if(SceneJoints(*scene).of(strand) != nullptr,
            "a strand with joints is no system of its own", scene->name,
            "run the scene, or leave out [joints]");
  const SceneSupports supports(*scene);
  system = supports.on(std::move(system), scene->strands[strand], strand);
  if (supports.hold(strand)) {
    static_cast<void>(begin_on_supports(*system, supports.place(strand)));
  }
  return {std::move(system), scene};
}

template <class T>
py::array_t<int> strand_of(const std::vector<T>& points) {
  std::vector<int> all;
  for (std::size_t k = 0; k < points.size(); ++k) {
    all.insert(all.end(), static_cast<std::size_t>(points[k]), static_cast<int>(k));
  }
  return copy<int>(all);
}

}  // namespace

void add_scenes(py::module_& m) {
  m.def("scene_schema", scene_schema);
  m.def("scene_defaults", scene_defaults);
  py::class_<Scene, std::shared_ptr<Scene>>(m, "Scene")
      .def(py::init([](const std::string& text, const std::string& file) {
        return std::make_shared<Scene>(parse_scene(text, file));
      }))
      .def_readonly("name", &Scene::name)
      .def_readonly("title", &Scene::title)
      .def_readonly("source", &Scene::source)
      .def_readonly("duration", &Scene::duration)
      .def_readonly("frame_rate", &Scene::frame_rate)
      .def_readonly("integrator", &Scene::integrator)
      .def_property_readonly("step", [](const Scene& s) { return s.options.step; })
      .def_property_readonly("model",
                             [](const Scene& s) { return std::string(s.model->id); })
      .def_property_readonly("strands", [](const Scene& s) { return s.strands.size(); })
      .def_property_readonly("effects", effect_names)
      .def("times",
           [](const Scene& s) {
             std::vector<double> all;
             for (std::size_t k = 0; k <= s.last_frame(); ++k)
               all.push_back(s.time_of(k));
             return copy(all);
           })
      .def("text", scene_text)
      .def("system", [](const std::shared_ptr<Scene>& s, std::size_t strand) {
        return system_of(s, strand);
      });
  py::class_<StrandsRun>(m, "StrandsRun")
      .def(py::init([](const std::shared_ptr<Scene>& scene, int threads) {
        return std::make_unique<StrandsRun>(scene, threads);
      }))
      .def("advance", &StrandsRun::advance)
      .def("frame", &StrandsRun::frame)
      .def_property_readonly("time", [](StrandsRun& r) { return r.world().time(); })
      // The world's own numbers: read anew by each access, valid until advance().
      .def_property_readonly(
          "positions",
          [](const py::object& self) {
            World& world = self.cast<StrandsRun&>().world();
            return view(world.positions(), self).attr("reshape")(-1, 3);
          })
      .def_property_readonly(
          "velocities",
          [](const py::object& self) {
            World& world = self.cast<StrandsRun&>().world();
            return view(world.velocities(), self).attr("reshape")(-1, 3);
          })
      .def_property_readonly("strand",
                             [](StrandsRun& r) { return strand_of(r.world().points()); })
      .def_property_readonly("before",
                             [](StrandsRun& r) { return copy<int>(r.world().before()); })
      .def_property_readonly(
          "radii",
          [](StrandsRun& r) { return copy(radii(r.scene(), r.world().points())); })
      .def_property_readonly("lines",
                             [](StrandsRun& r) { return copy<int>(r.readout().lines()); })
      .def_property_readonly("series",
                             [](StrandsRun& r) { return names(r.readout().series()); })
      .def_property_readonly("channels",
                             [](StrandsRun& r) { return names(r.readout().channels()); })
      .def_property_readonly("units",
                             [](StrandsRun& r) {
                               py::dict all;
                               for (const Reading& c : r.readout().channels()) {
                                 all[py::str(c.name)] = c.help;
                               }
                               return all;
                             })
      .def_property_readonly("stretch", [](StrandsRun& r) { return r.world().stretch(); })
      .def_property_readonly("energies", [](StrandsRun& r) {
        const Energies e = r.world().energies();
        return py::make_tuple(e.kinetic, e.elastic, e.effects);
      });
  py::class_<BatchRun>(m, "BatchRun")
      .def(py::init([](const std::string& text, const std::string& file, int precision,
                       int threads) {
        // As a file is: an outline, since all strands may be too many to be held.
        SceneOutline outline = parse_outline(text, file);
        auto scene = std::make_shared<Scene>(outline.scene);
        return std::make_unique<BatchRun>(std::move(scene), std::move(outline), precision,
                                          threads);
      }))
      .def("advance", &BatchRun::advance)
      .def_property_readonly("time", &BatchRun::time)
      .def("positions", &BatchRun::positions)
      .def("failed", &BatchRun::failed)
      .def("energy", &BatchRun::energy)
      .def("radii", [](const BatchRun& h) { return copy(h.radii()); })
      .def_property_readonly("strands", &BatchRun::strands)
      .def_property_readonly("points", &BatchRun::points);
}

}  // namespace tress::python
