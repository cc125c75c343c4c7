#include "experiments/statics/static_strand.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "contract/forms/energetics.h"
#include "contract/input_error.h"
#include "experiments/numerics/dense_algebra.h"
#include "experiments/numerics/dense_form.h"
#include "simulation/rest/held_shape.h"
#include "simulation/rest/supported_start.h"
#include "simulation/scene/joint_table.h"
#include "simulation/scene/support_table.h"

namespace tress::experiments::statics {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using models::SupportedSystem;
using simulation::EffectChoice;
using simulation::Scene;
using simulation::SceneSupports;

namespace {

/// Step of by_parameter(), over the range.
constexpr double parameter_step = 1e-6;
/// Skew part of the stiffness under dead loads over its largest entry: at most 3e-16 for
/// the matrices of models, and 1e-10 for differences of residuals.
constexpr double matrix_rounding = 1e-13, difference_rounding = 1e-8;

In values_of(const VectorXd& x) { return {x.data(), static_cast<std::size_t>(x.size())}; }
Out values_of(VectorXd& x) { return {x.data(), static_cast<std::size_t>(x.size())}; }

void need(Status s) {
  if (s != Status::ok) throw std::runtime_error("the forces are not finite");
}

/// Refuses scenes whose loads do not determine the equilibria of one strand.
void check_loads(const Scene& scene, const std::string& where) {
  refuse_if(
      scene.model->on_strand == nullptr || scene.strands.empty(),
      fmt::format("model {} has a geometry of its own and no strand", scene.model->id),
      where, "use a model of a strand, such as super_helix");
  refuse_if(simulation::SceneJoints(scene).any(),
            "the strands are joined: none has equilibria of its own", where,
            "leave out [joints]");
  refuse_if(scene.strands_touch(),
            "the strands touch each other: none has equilibria of its own", where,
            "leave out the effects between strands");
  refuse_if(scene.rest == simulation::RestStrains::inverse,
            "rest = \"inverse\" fits the natural shape to one load", where,
            "leave out rest");
  for (const EffectChoice& effect : scene.effects) {
    const bool rubs =
        effect.parameters.knows("friction") && effect.parameters.number("friction") > 0;
    refuse_if(rubs,
              fmt::format("friction of [effects.{}] at rest depends on how the strand "
                          "came there: the loads do not determine its equilibria",
                          effect.entry->id),
              where, "give friction = 0");
    const bool moves = effect.parameters.knows("moves") &&
                       effect.parameters.word("moves") != "fixed" &&
                       effect.parameters.word("moves") != "head";
    refuse_if(moves,
              fmt::format("[effects.{}] moves, which a strand at rest does not follow",
                          effect.entry->id),
              where, "give moves = \"fixed\"");
  }
}

void check_held(const Scene& scene, std::size_t number, const std::string& where) {
  refuse_if(scene.strands.front().free_root && !SceneSupports(scene).hold(number),
            "a strand that nothing holds has no equilibrium", where,
            "leave out motion = \"free\", or give [[supports]]");
}

}  // namespace

StaticStrand::StaticStrand(Scene scene, std::size_t number, Varied varied)
    : scene_(simulation::still(std::move(scene))),
      number_(number),
      varied_(std::move(varied)) {
  const std::string where = "scene " + scene_.name;
  check_loads(scene_, where);
  scene_.strands = {models::Strand(scene_.strands.at(number_))};
  check_held(scene_, number_, where);
  // Newton's method needs all terms.
  if (scene_.model_options.knows("jacobian"))
    scene_.model_options.set("jacobian", "exact");
  system_ = make(varied_.from);
  value_ = varied_.from;
  const Layout layout = system_->layout();
  typical_.resize(static_cast<std::size_t>(layout.coordinates));
  zero_ = typical_;
  std::vector<double> rates = typical_;
  system_->scale(typical_, rates);
  constraints_ = layout.constraints;
  const models::Segment& first = strand().segments.front();
  length_ = strand().length();
  bending_ = models::stiffness(strand(), first).y / length_;
  const Eigen::Map<const VectorXd> size(typical_.data(), coordinates());
  std::vector<double> begin = typical_;
  system_->initial_state(begin, rates);
  const double square = bending_ / (this->strand().mass() * std::pow(length_, 2));
  units_ = dense_mass(*system_, 0, begin).isIdentity(0)
               ? VectorXd(square * size)
               : VectorXd(bending_ * size.cwiseInverse());
  static_cast<void>(make(varied_.to));  // refuses a value that the model does not admit
}

double StaticStrand::time(double value) const {
  return varied_.kind == Varied::Kind::supports ? value : 0;
}

std::unique_ptr<SupportedSystem> StaticStrand::make(double value) const {
  const Scene scene = at_value(scene_, varied_, value);
  std::unique_ptr<System> strand = scene.model->on_strand(
      scene.strands.front(), scene.model_options, simulation::make_effects(scene));
  refuse_if(strand->contact_form() != nullptr,
            "exact contact has jumps of forces, which a path cannot follow",
            "scene " + scene.name, "give friction_law = \"regularised\"");
  const SceneSupports supports(scene);
  if (!supports.change(number_)) {
    return std::make_unique<SupportedSystem>(std::move(strand),
                                             std::vector<models::Support>{});
  }
  auto held = supports.on(std::move(strand), scene.strands.front(), number_);
  return std::unique_ptr<SupportedSystem>(
      &dynamic_cast<SupportedSystem&>(*held.release()));
}

SupportedSystem& StaticStrand::at(double value) {
  if (varied_.kind == Varied::Kind::supports || value == value_) return *system_;
  system_ = make(value);
  value_ = value;
  if (!memory_.empty()) static_cast<System&>(*system_).recall(memory_);
  return *system_;
}

void StaticStrand::recall(std::vector<double> memory) {
  memory_ = std::move(memory);
  if (!memory_.empty()) static_cast<System&>(*system_).recall(memory_);
}

Balance StaticStrand::start() {
  SupportedSystem& system = at(varied_.from);
  const SceneSupports supports(scene_);
  if (supports.hold(number_)) {
    simulation::begin_on_supports(system, supports.place(number_));
  }
  Balance begin{VectorXd::Zero(coordinates()), VectorXd::Zero(constraints_),
                varied_.from};
  VectorXd rates = begin.q;
  system.initial_state(values_of(begin.q), values_of(rates));
  if (!come_to_rest(system, values_of(begin.q))) {
    throw std::runtime_error("the strand does not come to rest at the first value");
  }
  memory_ = static_cast<System&>(system).memory();
  if (constraints_ > 0) {
    const VectorXd r = residual(begin).head(coordinates());
    const auto size = Eigen::Map<const VectorXd>(typical_.data(), coordinates());
    begin.lambda = least_squares_solution(
        size.asDiagonal() * dense_gradient(system, 0, values_of(begin.q)),
        size.cwiseProduct(r));
  }
  return begin;
}

VectorXd StaticStrand::residual(const Balance& state) {
  SupportedSystem& system = at(state.value);
  const double t = time(state.value);
  VectorXd all(coordinates() + constraints_);
  const Out r = values_of(all).first(typical_.size());
  need(system.residual(t, values_of(state.q), zero_, zero_, r));
  if (constraints_ == 0) return all;
  all.head(coordinates()) -= dense_gradient(system, t, values_of(state.q)) * state.lambda;
  need(system.constraint_form()->value(t, values_of(state.q),
                                       values_of(all).subspan(typical_.size())));
  return all;
}

VectorXd StaticStrand::by_parameter(const Balance& state) {
  const double step = parameter_step * varied_.range();
  Balance ahead = state, behind = state;
  ahead.value += step;
  behind.value -= step;
  if (varied_.kind == Varied::Kind::number) {
    ahead.value = std::min(ahead.value, varied_.number.max);
    behind.value = std::max(behind.value, varied_.number.min);
  }
  const VectorXd change = residual(ahead) - residual(behind);
  static_cast<void>(at(state.value));
  return change / (ahead.value - behind.value);
}

StaticStrand::Slopes StaticStrand::slopes(const Balance& state) {
  SupportedSystem& system = at(state.value);
  const double t = time(state.value);
  const In q = values_of(state.q);
  // A model that only solves with its matrix cannot where the matrix is singular.
  const bool by_model = system.strand().sparse_form() != nullptr;
  MatrixXd stiffness =
      by_model ? dense_stiffness(system, t, q)
               : tangent_of_residual(system, {t, {q.begin(), q.end()}, zero_, zero_},
                                     {0, 0, 1});
  if (constraints_ > 0) {
    stiffness -= dense_curvature(system, t, q, values_of(state.lambda));
  }
  return {std::move(stiffness), dense_gradient(system, t, q),
          by_model ? matrix_rounding : difference_rounding};
}

MatrixXd StaticStrand::mass(const Balance& state) {
  return dense_mass(at(state.value), time(state.value), values_of(state.q));
}

void StaticStrand::accept(Balance& state) {
  System& system = at(state.value);
  std::vector<double> v = zero_;
  static_cast<void>(system.accept(time(state.value), values_of(state.q), v));
  memory_ = system.memory();
}

std::vector<double> StaticStrand::points(const Balance& state) {
  MaterialPoints& points = *at(state.value).material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(points.count()));
  points.positions(time(state.value), values_of(state.q), x);
  return x;
}

std::vector<double> StaticStrand::displacements(const Balance& state,
                                                const VectorXd& change) {
  MaterialPoints& points = *at(state.value).material_points();
  std::vector<double> u(3 * static_cast<std::size_t>(points.count()));
  points.velocities(time(state.value), values_of(state.q), values_of(change), u);
  return u;
}

double StaticStrand::energy(const Balance& state) {
  SupportedSystem& system = at(state.value);
  if (system.energetics() == nullptr) return std::nan("");
  return system.energetics()
      ->energy(time(state.value), values_of(state.q), zero_)
      .potential;
}

const std::vector<models::Support>& StaticStrand::supports() {
  return system_->rows().supports();
}

Vec StaticStrand::support_force(const Balance& state, std::size_t support) {
  SupportedSystem& system = at(state.value);
  std::vector<double> forces(3 * supports().size()), moments = forces;
  system.loads_of(time(state.value), values_of(state.q), zero_, values_of(state.lambda),
                  forces, moments);
  return load3(&forces[3 * support]);
}

}  // namespace tress::experiments::statics
