#include "integrators/esdirk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>

#include "integrators/control/error_controlled.h"
#include "integrators/controlled_stage.h"
#include "integrators/fixed_step.h"
#include "linear/vector_ops.h"

namespace tress::integrators {
namespace {

/// Accelerations of this many stages before give the guess of the next: a parabola.
/// Higher polynomials amplify what the fast modes left in them.
constexpr std::size_t guessed_from = 3;

class FixedEsdirk final : public FixedStep {
 public:
  FixedEsdirk(System& system, const Options& options, const EsdirkTable& table)
      : FixedStep(system, options), stages_(dynamics_, options, table, {}) {}

  std::vector<InOut> state() override { return {q_, v_, a_}; }

 private:
  Status reset(double t) override { return dynamics_.accelerate(t, q_, v_, a_, lambda_); }

  Status step(double t, double h) override {
    const Status s = stages_.step(t, h, q_, v_, a_, lambda_, Stage::gentle_speed(h));
    take_end(stages_);
    return s;
  }

  EsdirkStages stages_;
};

/// A jump of velocities below this part of what the tolerance sees needs no step of its
/// own.
constexpr double unseen_part = 0.1;
/// Part of the tolerance that the error of an impact may be: a strand lands in tens of
/// them.
constexpr double impact_part = 0.1;
/// Steps of this part of the typical time, in which the laws of contact hold, are not
/// rejected. They move the impact of a strand that falls from its own height by 1e-6 of
/// its length.
constexpr double shortest_in_contact = 1e-6;

class ControlledEsdirk final : public ErrorControlled {
 public:
  ControlledEsdirk(System& system, const Options& options, const EsdirkTable& table)
      : ErrorControlled(system, options, 1 + std::min(table.order, table.embedded_order),
                        threshold(options, table)),
        of_impact_(
            std::min(1.0, threshold(options, table) / (impact_part * options.tolerance))),
        stages_(dynamics(), controlled_options(dynamics(), options), table,
                controlled_ending(dynamics())) {}

 private:
  static double threshold(const Options& options, const EsdirkTable& table) {
    return table.share * std::pow(options.tolerance, table.power);
  }

  Status try_step(const State& from, double h, Effort effort, State& to, Out error_q,
                  Out error_v) override {
    const long unfinished = dynamics().stats.contact_unfinished;
    const Status s = stages_.step(from.t, h, from.q, from.v, from.a, from.lambda,
                                  unseen_part * seen_speed(), effort);
    if (s != Status::ok) return s;
    to.take_end(stages_);
    stages_.difference(h, error_q, error_v);
    // Errors of smooth steps add up over a run, of which an impact is one event. Its
    // error falls with h only.
    if (stages_.impact()) {
      for (double& error : error_q) error *= of_impact_;
    }
    // The law of a rigid contact divides gaps by h: in shorter steps rounding, not the
    // motion, is what the estimate sees.
    if (dynamics().system().contact_form() != nullptr &&
        dynamics().stats.contact_unfinished == unfinished &&
        h <= shortest_in_contact * typical_time()) {
      std::ranges::fill(error_q, 0.0);
      std::ranges::fill(error_v, 0.0);
    }
    return s;
  }
  void forget_steps() override { stages_.forget(); }

  double of_impact_;  // part of an impact's error that the control sees
  EsdirkStages stages_;
};

}  // namespace

double EsdirkTable::c(std::size_t i) const {
  return std::accumulate(a[i].begin(), a[i].end(), 0.0);
}

EsdirkStages::EsdirkStages(Dynamics& dynamics, const Options& options,
                           const EsdirkTable& table, Stage::Ending ending)
    : table_(table),
      dynamics_(dynamics),
      stage_(dynamics, options, ending),
      v_(table.stages, std::vector<double>(static_cast<std::size_t>(dynamics.n()))),
      a_(v_),
      q_bar_(v_.front()),
      v_bar_(q_bar_),
      lambda_(static_cast<std::size_t>(dynamics.m())),
      slides_(table.stages, std::vector<double>(stage_.place_bar().size())),
      place_(slides_.front()),
      a_before_(q_bar_),
      a_begun_(q_bar_),
      stuck_(options.tolerance > 0 ? options.contact_tolerance : 0) {}

/// By the polynomial through the last stages, of which the start of the step before is
/// one.
void EsdirkStages::guess(std::size_t i, double h) noexcept {
  struct Node {
    double c;
    const std::vector<double>* a;
  };
  std::array<Node, guessed_from> nodes;
  std::size_t count = 0;
  for (std::size_t j = i; j-- > 0 && count < guessed_from;) {
    nodes[count++] = {table_.c(j), &a_[j]};
  }
  if (count < guessed_from && steps_.before() > 0) {
    nodes[count++] = {-steps_.before() / h, &a_before_};
  }
  std::ranges::fill(a_[i], 0.0);
  for (std::size_t j = 0; j < count; ++j) {
    double weight = 1;
    for (std::size_t k = 0; k < count; ++k) {
      if (k != j) weight *= (table_.c(i) - nodes[k].c) / (nodes[j].c - nodes[k].c);
    }
    add(a_[i], weight, *nodes[j].a);
  }
}

/// Whether a point that slid at the step's start faster than `gently` sticks in a stage.
bool EsdirkStages::sticks(std::size_t stage, double gently) const noexcept {
  if (stuck_ == 0) return false;
  const auto speed = [](const std::vector<double>& u, std::size_t k) {
    return std::hypot(u[k], u[k + 1], u[k + 2]);
  };
  for (std::size_t k = 0; k < slides_[0].size(); k += 3) {
    if (speed(slides_[0], k) > std::max(gently, stuck_) &&
        speed(slides_[stage], k) <= stuck_) {
      return true;
    }
  }
  return false;
}

/// Solves a backward Euler step, from where step() and backward_euler() have left the
/// stage.
Status EsdirkStages::euler(double t, double h, In q, In v, Effort effort) noexcept {
  shifted(q_bar_, q, h, v);
  std::ranges::copy(place_, stage_.place_bar().begin());
  std::ranges::fill(a_[last()], 0.0);
  return stage_.solve(t + h, q_bar_, v, {1, h, h * h}, a_[last()], lambda_,
                      Stage::Matrix::own, effort);
}

Status EsdirkStages::step(double t, double h, In q, In v, In a, In lambda, double gently,
                          Effort effort) noexcept {
  const StepSequence::Start start = steps_.begin(t, h);
  if (start == StepSequence::Start::next) a_before_.swap(a_[0]);
  if (start != StepSequence::Start::again) begun_ = false;
  stage_.leave(t, q);
  stage_.places(t, q, v, place_);
  stage_.slides(t, q, v, slides_[0]);
  power_ = 0;
  impact_ = stage_.stops(t, q, v, gently);
  if (impact_) return damped(t, h, q, v, gently, Effort::whole);
  std::ranges::copy(lambda, lambda_.begin());
  // Where steps begin, accelerations include no forces of contacts, which are found in
  // stages only. Those of a backward Euler step, which is not taken, are near.
  if (start == StepSequence::Start::anew &&
      dynamics_.system().contact_form() != nullptr &&
      euler(t, h, q, v, Effort::whole) == Status::ok) {
    impact_ = stage_.stops(t, q, v, gently);
    if (impact_) return take_euler(t, h, q, v, gently);
    begun_ = dynamics_.accelerate(t, q, v, a_begun_, lambda_) == Status::ok;
    std::ranges::copy(lambda, lambda_.begin());
  }
  std::ranges::copy(v, v_[0].begin());
  std::ranges::copy(begun_ ? In(a_begun_) : a, a_[0].begin());
  const double hg = h * table_.gamma();
  for (std::size_t i = 1; i < table_.stages; ++i) {
    std::ranges::copy(v, v_bar_.begin());
    std::ranges::copy(q, q_bar_.begin());
    for (std::size_t j = 0; j < i; ++j) {
      add(v_bar_, h * table_.a[i][j], a_[j]);
      add(q_bar_, h * table_.a[i][j], v_[j]);
    }
    std::ranges::copy(place_, stage_.place_bar().begin());
    for (std::size_t j = 0; j < i; ++j) {
      add(stage_.place_bar(), h * table_.a[i][j], slides_[j]);
    }
    add(q_bar_, hg, v_bar_);
    guess(i, h);
    const Status s = stage_.solve(
        t + h * table_.c(i), q_bar_, v_bar_, {1, hg, hg * hg}, a_[i], lambda_,
        i == 1 ? Stage::Matrix::own : Stage::Matrix::shared, effort);
    if (s != Status::ok) return s;
    std::ranges::copy(stage_.v(), v_[i].begin());
    const double now = t + h * table_.c(i);
    stage_.slides(now, stage_.q(), stage_.v(), slides_[i]);
    // The last stage is the end of the step, unless an impact follows.
    if (energetics_ != nullptr &&
        (i < last() || dynamics_.system().contact_form() != nullptr)) {
      power_ = std::max(power_, energetics_->power(now, stage_.q(), stage_.v()));
    }
    // A later stage may open the contact again, thrown back by this one's impulse.
    impact_ = stage_.stops(t, q, v, gently) || sticks(i, gently);
    if (impact_) return damped(t, h, q, v, gently, Effort::whole);
  }
  return Status::ok;
}

Status EsdirkStages::backward_euler(double t, double h, In q, In v, double gently,
                                    Effort effort) noexcept {
  stage_.leave(t, q);
  stage_.places(t, q, v, place_);
  return damped(t, h, q, v, gently, effort);
}

Status EsdirkStages::damped(double t, double h, In q, In v, double gently,
                            Effort effort) noexcept {
  const Status s = euler(t, h, q, v, effort);
  return s == Status::ok ? take_euler(t, h, q, v, gently) : s;
}

/// Ends the step with the solution of euler().
Status EsdirkStages::take_euler(double t, double h, In q, In v, double gently) noexcept {
  forget();
  for (std::size_t i = 0; i < q.size(); ++i) v_[0][i] = stage_.q()[i] - q_bar_[i];
  std::ranges::copy(stage_.v(), v_[last()].begin());
  // Forces of an impulse over h do not act on. Those of contacts without one do: without
  // them the next step would start from a free acceleration, and could slip.
  if (stage_.stops(t, q, v, gently)) dynamics_.system().contact_form()->release();
  return dynamics_.accelerate(t + h, stage_.q(), stage_.v(), a_[last()], lambda_);
}

void EsdirkStages::difference(double h, Out dq, Out dv) const noexcept {
  std::ranges::fill(dq, 0.0);
  std::ranges::fill(dv, 0.0);
  if (impact_) {
    std::ranges::copy(v_[0], dq.begin());
    return;
  }
  for (std::size_t i = 0; i < table_.stages; ++i) {
    const double weight = h * (table_.a[last()][i] - table_.embedded[i]);
    add(dq, weight, v_[i]);
    add(dv, weight, a_[i]);
  }
}

std::unique_ptr<Integrator> make_esdirk(const EsdirkTable& table, System& system,
                                        const Options& options) {
  if (options.tolerance > 0) {
    check_controlled(system, options);
    return std::make_unique<ControlledEsdirk>(system, options, table);
  }
  return std::make_unique<FixedEsdirk>(system, options, table);
}

}  // namespace tress::integrators
