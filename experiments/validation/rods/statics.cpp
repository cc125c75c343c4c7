#include "experiments/validation/rods/statics.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

#include "contract/forms/constraint_form.h"
#include "contract/forms/energetics.h"
#include "experiments/numerics/dense_algebra.h"
#include "experiments/numerics/dense_form.h"
#include "experiments/validation/rods/rod.h"

namespace tress::experiments::validation {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int iterations = 200;
constexpr double accuracy = 1e-11;  // of typical sizes: the attainable accuracy
// Where stretch is stiff or a motion is soft, rounding stops corrections from shrinking;
// below this size, after so many futile steps, they are accepted.
constexpr double rounding = 1e-5;
constexpr int in_vain = 3;
constexpr double far = 1e-3;         // corrections that change a section's curvature
constexpr double longest = 1.5;      // correction, in typical sizes
constexpr double largest_ratio = 3;  // of successive loads
constexpr double least_ratio = 1.003;
// Limit over all steps of one strand, in cubes of the number of unknowns: about half a
// minute.
constexpr double most_work = 2e11;

Effects loads(const Vec& gravity, std::shared_ptr<const Effect> tip, Effects others) {
  others.push_back(std::make_shared<Weight>(gravity));
  others.push_back(std::move(tip));
  return others;
}

VectorXd residual(System& system, double t, In q) {
  const std::vector<double> zero(q.size());
  VectorXd r(static_cast<Index>(q.size()));
  if (system.residual(t, q, zero, zero, {r.data(), q.size()}) != Status::ok) {
    throw std::runtime_error("the residual is not finite");
  }
  return r;
}

}  // namespace

/// Columns: effect of the conditions' forces on the residual; rows: effect of
/// displacements on the conditions. They agree for a residual that is the gradient of an
/// energy, not for one that is an acceleration.
struct Statics::Conditions {
  MatrixXd columns, rows;
  VectorXd compliance;
};

Statics::Statics(const ModelVariant& variant, const Strand& strand, const Vec& gravity,
                 End end, Effects others)
    : end_(std::move(end)),
      tip_force_(std::make_shared<TipForce>(static_cast<int>(strand.segments.size()))),
      system_(on_strand(variant, strand, loads(gravity, tip_force_, std::move(others)))),
      conditions_(std::make_unique<EndConditions>(*system_, end_)) {
  const Layout layout = system_->layout();
  q_.resize(static_cast<std::size_t>(layout.coordinates));
  q_typ_ = q_;
  std::vector<double> v = q_;
  system_->initial_state(q_, v);
  system_->scale(q_typ_, v);
  lambda_ = VectorXd::Zero(layout.constraints);
  holding_ = VectorXd::Zero(conditions_->rows());
}

void Statics::start_at(const Statics& other) {
  q_ = other.q_;
  system_->recall(other.system_->memory());
}

Statics::Conditions Statics::conditions() {
  const auto n = static_cast<Index>(q_.size());
  const Index m = lambda_.size(), rows = m + conditions_->rows();
  const Index places = conditions_->places(), sections = conditions_->rows() - places;
  Conditions all{MatrixXd(n, rows), MatrixXd(rows, n), VectorXd::Zero(rows)};
  all.columns.leftCols(m) = dense_gradient(*system_, t_, q_);
  const MatrixXd of_end = conditions_->gradient(t_, q_);
  all.rows << all.columns.leftCols(m).transpose(), of_end.transpose();
  // A force on the tip enters as the model's loads do.
  const Vec force = tip_force_->force;
  const VectorXd loaded = residual(*system_, t_, q_);
  for (Index i = 0; i < places; ++i) {
    constexpr double size = 1e-6;  // N, for a hair; r is linear in it
    tip_force_->force = force + size * end_.along[static_cast<std::size_t>(i)];
    all.columns.col(m + i) = (loaded - residual(*system_, t_, q_)) / size;
  }
  tip_force_->force = force;
  all.columns.rightCols(sections) = of_end.rightCols(sections);
  all.compliance.tail(conditions_->rows()) = conditions_->compliance();
  return all;
}

/// Derivative of r - G^T lambda - C^T e.
MatrixXd Statics::stiffness() {
  MatrixXd all = dense_stiffness(*system_, t_, q_);
  if (const auto m = static_cast<std::size_t>(lambda_.size()); m > 0) {
    all -= dense_curvature(*system_, t_, q_, {lambda_.data(), m});
  }
  return all - curvature_;
}

/// O(n^2) evaluations of the end frame: by far the most expensive part of a step.
void Statics::take_curvature() {
  const Index sections = conditions_->rows() - conditions_->places();
  curvature_ = conditions_->curvature(t_, q_, holding_.tail(sections));
}

/// The dead force and those that hold the position.
void Statics::load_tip() {
  Vec force = t_ * end_.force;
  for (std::size_t i = 0; i < end_.along.size(); ++i) {
    force = force + holding_[static_cast<Index>(i)] * end_.along[i];
  }
  tip_force_->force = force;
}

/// Sets lambda and e to those of the least residual in the current state. With those of
/// another load, or zero, the first corrections of a strand under tension would be those
/// of a slack one.
void Statics::guess_forces() {
  const Index m = lambda_.size(), rows = m + conditions_->rows();
  if (rows == 0) return;
  holding_.setZero();
  lambda_.setZero();
  load_tip();
  const Eigen::Map<const VectorXd> size(q_typ_.data(), static_cast<Index>(q_.size()));
  const MatrixXd columns = size.asDiagonal() * conditions().columns;
  const VectorXd r = size.cwiseProduct(residual(*system_, t_, q_));
  VectorXd unit(rows);
  for (Index j = 0; j < rows; ++j) unit[j] = 1 / columns.col(j).norm();
  const VectorXd forces =
      unit.cwiseProduct(least_squares_solution(columns * unit.asDiagonal(), r));
  lambda_ = forces.head(m);
  holding_ = forces.tail(conditions_->rows());
}

double Statics::newton_step() {
  load_tip();
  const Conditions now = conditions();
  const Index n = now.rows.cols(), m = lambda_.size(), rows = now.rows.rows();
  const Index sections = conditions_->rows() - conditions_->places();
  work_ += std::pow(static_cast<double>(n + rows), 3);
  if (work_ > most_work) throw std::runtime_error("it takes more work than it may");

  VectorXd right(n + rows);
  right.head(n) = residual(*system_, t_, q_);
  right.head(n) -= now.columns.leftCols(m) * lambda_;
  right.head(n) -= now.columns.rightCols(sections) * holding_.tail(sections);
  if (m > 0) {
    const Status s = system_->constraint_form()->value(
        t_, q_, {right.data() + n, static_cast<std::size_t>(m)});
    if (s != Status::ok) throw std::runtime_error("no value of the constraints");
  }
  right.tail(conditions_->rows()) = conditions_->value(t_, q_);
  right.tail(sections) +=
      now.compliance.tail(sections).cwiseProduct(holding_.tail(sections));

  MatrixXd all(n + rows, n + rows);
  all << stiffness(), -now.columns, now.rows, MatrixXd(now.compliance.asDiagonal());
  const MixedSolution correction =
      mixed_solution(std::move(all), std::move(right), q_typ_);
  if (!correction.scaled.allFinite()) throw std::runtime_error("no static correction");
  const double largest = correction.scaled.head(n).cwiseAbs().maxCoeff();
  const VectorXd moved = std::min(1.0, longest / largest) * correction.unknowns();
  for (Index j = 0; j < n; ++j) q_[static_cast<std::size_t>(j)] -= moved[j];
  lambda_ -= moved.segment(n, m);
  holding_ -= moved.tail(conditions_->rows());
  return largest;
}

void Statics::relax(double t) {
  const auto before = std::tuple(q_, lambda_, holding_, t_);
  const auto fail = [&](const std::string& why) {
    std::tie(q_, lambda_, holding_, t_) = before;
    throw std::runtime_error("no equilibrium at load " + std::to_string(t) + ": " + why);
  };
  t_ = t;
  guess_forces();
  take_curvature();
  double best = std::numeric_limits<double>::infinity();
  for (int i = 0, worse = 0; i < iterations; ++i) {
    double correction = 0;
    try {
      correction = newton_step();
    } catch (const std::runtime_error& error) {
      fail(error.what());
    }
    if (correction > far) take_curvature();
    worse = correction < best / 2 ? 0 : worse + 1;
    best = std::min(best, correction);
    if (correction <= accuracy || (correction <= rounding && worse >= in_vain)) {
      std::vector<double> v(q_.size());
      system_->accept(t_, q_, v);
      return;
    }
  }
  fail("corrections do not vanish");
}

void Statics::follow(double from, double to) {
  const auto cut = [](double ratio) { return std::sqrt(ratio); };
  // Reduces a first load that is too large.
  constexpr double less = 0.1, least_part = 1e-4;
  double at = from, ratio = largest_ratio;
  for (;;) {
    try {
      relax(at);
      break;
    } catch (const std::runtime_error&) {
      at *= less;
      if (at < least_part * from) throw;
    }
  }
  while (at != to) {
    const double left = to / at;
    const double by = left > 1 ? std::min(left, ratio) : std::max(left, 1 / ratio);
    const double next = by == left ? to : at * by;
    try {
      relax(next);
      at = next;
      ratio = std::min(ratio * cut(ratio), largest_ratio);
    } catch (const std::runtime_error&) {
      ratio = cut(ratio);
      if (ratio < least_ratio) throw;
    }
  }
}

std::vector<double> Statics::points() {
  MaterialPoints& points = *system_->material_points();
  std::vector<double> x(3 * static_cast<std::size_t>(points.count()));
  points.positions(t_, q_, x);
  return x;
}

Vec Statics::tip() {
  const std::vector<double> x = points();
  return load3(&x[x.size() - 3]);
}

double Statics::energy() {
  const std::vector<double> zero(q_.size());
  return system_->energetics()->energy(t_, q_, zero).potential;
}

struct Statics::Motion {
  MatrixXd mass, stiffness, columns, rows;
};

Statics::Motion Statics::motion() {
  take_curvature();
  const Conditions now = conditions();
  MatrixXd k = stiffness();
  // Compliant rows are springs, the others constraints.
  std::vector<Index> rigid;
  for (Index i = 0; i < now.rows.rows(); ++i) {
    if (now.compliance[i] > 0) {
      k += now.columns.col(i) / now.compliance[i] * now.rows.row(i);
    } else {
      rigid.push_back(i);
    }
  }
  return {dense_mass(*system_, t_, q_), std::move(k), now.columns(Eigen::all, rigid),
          now.rows(rigid, Eigen::all)};
}

std::vector<SmallMotion> Statics::motions() {
  const Motion of = motion();
  return small_motions(of.mass, of.stiffness, of.columns, of.rows, q_typ_);
}

std::vector<std::complex<double>> Statics::squares() {
  const Motion of = motion();
  return squares_of_motions(of.mass, of.stiffness, of.columns, of.rows, q_typ_);
}

std::vector<double> Statics::displacements(const SmallMotion& motion) {
  MaterialPoints& points = *system_->material_points();
  std::vector<double> u(3 * static_cast<std::size_t>(points.count()));
  points.velocities(t_, q_, {motion.shape.data(), q_.size()}, u);
  return u;
}

}  // namespace tress::experiments::validation
