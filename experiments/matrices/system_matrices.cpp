#include "experiments/matrices/system_matrices.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <complex>
#include <limits>
#include <numbers>
#include <stdexcept>

#include "contract/input_error.h"
#include "experiments/numerics/dense_algebra.h"
#include "models/driven/driven_system.h"
#include "simulation/run/world.h"
#include "simulation/scene/joint_table.h"
#include "simulation/scene/support_table.h"
#include "simulation/scene_changes/changes.h"

namespace tress::experiments::matrices {
namespace {

using simulation::Snapshot;
using simulation::World;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

std::unique_ptr<System> system_of(const Scene& scene, std::size_t strand) {
  if (scene.strands.empty()) return scene.model->make(scene.model_options);
  refuse_if(simulation::SceneJoints(scene).any(),
            "matrices of joined strands, which are one system", "scene " + scene.name,
            "leave out [joints]");
  refuse_if(!simulation::SceneSupports(scene).on_bodies().empty(),
            "matrices of a strand that is fixed to a body that it drives",
            "scene " + scene.name, "give the body another motion");
  const models::Effects effects = simulation::make_effects(scene);
  auto alone =
      scene.model->on_strand(scene.strands[strand], scene.model_options, effects);
  return models::with_driven_bodies(simulation::SceneSupports(scene).on(
                                        std::move(alone), scene.strands[strand], strand),
                                    effects);
}

Snapshot snapshot_at(const Scene& scene, double time) {
  World world(scene);
  if (time > 0 && world.advance(time) != Status::ok) {
    throw std::runtime_error(world.failure());
  }
  return world.snapshot();
}

/// a and the multipliers of M a - G^T lambda = f, G a = -bias: lambda solves
/// (G M^-1 G^T) lambda = -bias - G M^-1 f; where constraints are redundant, the shortest
/// one.
void accelerate(Moment& moment) {
  System& system = *moment.system;
  Instant& at = moment.at;
  const std::size_t n = at.q.size();
  Eigen::MatrixXd right(static_cast<Eigen::Index>(n), 1);
  Status status = system.residual(at.t, at.q, at.v, at.a, {right.data(), n});
  const Eigen::MatrixXd mass = dense_mass(system, at.t, at.q);
  Eigen::VectorXd a = -solution(mass, right);
  const Eigen::MatrixXd gradient = dense_gradient(system, at.t, at.q);
  if (const Eigen::Index m = gradient.cols(); m > 0 && status == Status::ok) {
    Eigen::VectorXd bias(m);
    status = system.constraint_form()->bias(at.t, at.q, at.v,
                                            {bias.data(), static_cast<std::size_t>(m)});
    const Eigen::MatrixXd response = solution(mass, gradient);
    const auto [values, vectors] = symmetric_eigenpairs(gradient.transpose() * response,
                                                        Eigen::MatrixXd::Identity(m, m));
    const double least = 1e-12 * values.maxCoeff();
    const Eigen::VectorXd wanted =
        vectors.transpose() * (-bias - gradient.transpose() * a);
    const Eigen::VectorXd lambda =
        vectors *
        (values.array() > least).select(wanted.array() / values.array(), 0).matrix();
    a += response * lambda;
    moment.multipliers.assign(lambda.begin(), lambda.end());
  }
  if (status != Status::ok || !a.allFinite()) {
    throw std::runtime_error(
        "accelerations are not determined: a load is not finite, or "
        "the mass matrix is singular");
  }
  at.a.assign(a.begin(), a.end());
}

Named part(Moment& moment, std::string_view name, std::string_view what, Weights w) {
  const Instant& at = moment.at;
  SparseForm* form = moment.system->sparse_form();
  if (form == nullptr) {
    const Eigen::MatrixXd dense = tangent_of_residual(*moment.system, at, w);
    return {name, what, entries_of(dense), w.vel == 0 && w.pos == 0};
  }
  std::vector<double> values(static_cast<std::size_t>(form->pattern().nonzeros()));
  if (form->values(at.t, at.q, at.v, at.a, w, values) != Status::ok) {
    throw std::runtime_error(fmt::format("{} cannot be evaluated", name));
  }
  return {name, what, on_pattern(form->pattern(), values)};
}

void add_constraints(Moment& moment, std::vector<Named>& all) {
  System& system = *moment.system;
  const Instant& at = moment.at;
  all.push_back({"G", "dg/dq, gradients of the constraints by rows",
                 entries_of(dense_gradient(system, at.t, at.q).transpose())});
  all.push_back({"C", "d(G^T lambda)/dq; K - C is the stiffness of r - G^T lambda",
                 entries_of(dense_curvature(system, at.t, at.q, moment.multipliers))});
}

}  // namespace

Moment moment(const Scene& scene, std::size_t strand, double time) {
  const std::size_t count = std::max<std::size_t>(1, scene.strands.size());
  if (strand >= count) {
    throw InputError(fmt::format("there is no strand {}", strand + 1),
                     "scene " + scene.name, fmt::format("strands are 1 to {}", count));
  }
  const bool alone = !scene.strands.empty() && !scene.strands_touch();
  const Snapshot snapshot =
      snapshot_at(alone ? simulation::only(scene, {strand}) : scene, time);
  const Snapshot::OfStrand& state = snapshot.strands[alone ? 0 : strand];
  Moment found{system_of(scene, strand), {time, state.q, state.v, {}}, {}};
  found.at.a.assign(state.q.size(), 0);
  found.system->recall(state.memory);
  accelerate(found);
  return found;
}

std::vector<Named> matrices_of(Moment& moment, double h) {
  std::vector<Named> all;
  all.push_back(part(moment, "M", "dr/da, mass", {1, 0, 0}));
  all.push_back(part(moment, "D", "dr/dv, damping and gyroscopic terms", {0, 1, 0}));
  all.push_back(part(moment, "K", "dr/dq, stiffness", {0, 0, 1}));
  all.push_back(part(moment, "S",
                     "M + h D + h^2 K, the matrix of a step of backward Euler",
                     {1, h, h * h}));
  if (moment.system->layout().constraints > 0) add_constraints(moment, all);
  return all;
}

Spectrum spectrum(const Matrix& matrix) {
  const Eigen::MatrixXd dense = matrix.dense();
  const Eigen::VectorXcd values = eigenvalues(dense);
  Spectrum found{values.real().minCoeff(), values.real().maxCoeff(),
                 values.imag().cwiseAbs().maxCoeff(), 0};
  const Eigen::MatrixXd inverse =
      solution(dense, Eigen::MatrixXd::Identity(dense.rows(), dense.cols()));
  const auto norm = [](const Eigen::MatrixXd& a) {
    return a.cwiseAbs().colwise().sum().maxCoeff();
  };
  found.condition = norm(dense) * norm(inverse);
  if (!(found.condition * std::numeric_limits<double>::epsilon() < 1)) {
    found.condition = std::numeric_limits<double>::infinity();
  }
  return found;
}

double asymmetry(const Matrix& matrix) {
  const Eigen::MatrixXd dense = matrix.dense();
  const double largest = dense.cwiseAbs().maxCoeff();
  return largest > 0 ? (dense - dense.transpose()).cwiseAbs().maxCoeff() / largest : 0;
}

std::pair<double, double> frequencies_hz(const Matrix& mass, const Matrix& stiffness) {
  const Eigen::VectorXcd values = eigenvalues(solution(mass.dense(), stiffness.dense()));
  double least = unknown, largest = unknown;
  for (const std::complex<double>& value : values) {
    if (value.real() <= 0) continue;
    const double hz = std::sqrt(value.real()) / (2 * std::numbers::pi);
    least = std::isnan(least) ? hz : std::min(least, hz);
    largest = std::isnan(largest) ? hz : std::max(largest, hz);
  }
  return {least, largest};
}

}  // namespace tress::experiments::matrices
