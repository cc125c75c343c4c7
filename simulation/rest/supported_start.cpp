#include "simulation/rest/supported_start.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "contract/input_error.h"
#include "integrators/formulation/dynamics.h"
#include "integrators/formulation/projection.h"
#include "models/supports/point_force.h"
#include "models/supports/supported_system.h"
#include "simulation/rest/tethered_system.h"

namespace tress::simulation {

using models::SupportedSystem;

namespace {

/// Gap, over the length, up to which a strand is projected onto its supports, and at
/// which a point counts as being on its support.
constexpr double near_support = 1e-6, on_support = 64 * 2.2e-16;
constexpr double most_lead = 0.05;      // of the length, by which supports lead in a step
constexpr double first_share = 1e-5;    // of that lead, for strands that stretch
constexpr double slight_bend = 0.3;     // of the typical sizes of the coordinates
constexpr double longest_step = 1e4;    // of the typical time
constexpr double first_tether = 100;    // of the loads of the bent strand
constexpr double least_tether = 1e-12;  // of the first stiffness
constexpr double settled = 1e-9;        // of the typical sizes, in a step of longest_step
constexpr double least_share = 1e-15;   // of the way of the supports, in a step
constexpr double most_change = 3;       // of the typical sizes, in a correction
constexpr int most_steps = 2000, most_corrections = 25;
constexpr double converged = 1e-11, stalled = 1e-7;  // of the typical sizes

/// The search for an equilibrium.
class Search {
 public:
  explicit Search(SupportedSystem& system)
      : system_(system),
        tethered_(system),
        dynamics_(tethered_, {.formulation = Formulation::index3, .own = {}}),
        n_(static_cast<std::size_t>(dynamics_.n())),
        m_(static_cast<std::size_t>(dynamics_.m())) {
    for (auto* x : {&q, &v, &a_, &r_, &next_, &zero_, &kept_}) x->assign(n_, 0.0);
    for (auto* x : {&lambda_, &c_, &gap_, &lambda_kept_}) x->assign(m_, 0.0);
    joint_gap_.assign(3 * system.joints(), 0.0);
    joint_lead_ = joint_gap_;
    system.initial_state(q, v);
    double rate = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      rate = std::max(rate, dynamics_.v_typ()[i] / dynamics_.q_typ()[i]);
    }
    time_ = 1 / rate;
    length_ = system.rows().length();
  }

  double length() const { return length_; }
  /// Largest distance (m) of a point, and largest rotation (rad) of a section, from their
  /// supports.
  struct Gap {
    double distance = 0, rotation = 0;
    /// Returns the larger one, over the length and over one radian.
    double over(double length) const { return std::max(distance / length, rotation); }
  };
  /// Measures the gaps, and keeps them for the search.
  Gap gap() {
    Gap most;
    if (m_ > 0 && system_.rows().value(0, q, gap_) != Status::ok) {
      return {std::nan(""), std::nan("")};
    }
    for (auto k = static_cast<std::size_t>(system_.rows().own()); k < m_; ++k) {
      double& of =
          system_.rows().turns(static_cast<int>(k)) ? most.rotation : most.distance;
      of = std::max(of, std::abs(gap_[k]));
    }
    system_.joint_rotations(0, q, joint_gap_);
    // Slighter rotations only strain the joints.
    for (const double c : joint_gap_) {
      if (std::abs(c) > near_support)
        most.rotation = std::max(most.rotation, std::abs(c));
    }
    return most;
  }

  /// Velocities, and positions within rounding, that the supports admit.
  Status project() { return integrators::Projection(dynamics_).project(0, q, v); }

  /// Velocities alone.
  Status project_rates() {
    if (m_ == 0) return Status::ok;
    if (system_.rows().rate(0, q, v, c_) != Status::ok) return Status::retry;
    if (std::ranges::all_of(c_, [](double rate) { return rate == 0; })) return Status::ok;
    const Status s = dynamics_.linearize(0, q, v, zero_, c_, {1, 0, 0});
    if (s != Status::ok) return s;
    return integrators::Projection(dynamics_).velocities(0, q, v);
  }

  /// The number of steps, of a strand that is `bent` a little first; 0: none was found.
  int find(bool bent) {
    std::ranges::fill(v, 0.0);
    if (bent) bend();
    const double lead = std::min(1.0, most_lead / std::max(gap().over(length_), 1e-300));
    // Springs as stiff as the loads of the bent strand are large.
    if (system_.residual(0, q, zero_, zero_, r_) != Status::ok) return 0;
    double stiffness = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      stiffness = std::max(stiffness, std::abs(r_[i]) * dynamics_.q_typ()[i]);
    }
    stiffness *= first_tether;
    const double least = least_tether * stiffness;
    bool at_rest = false;
    // Strands that stretch follow small steps at first: long ones compress them straight.
    const bool places = system_.material_points()->mean(0).has_value();
    double left = 1, share = places ? first_share * lead : lead, h = time_;
    for (int step = 1; step <= most_steps; ++step) {
      const double next = std::max(0.0, left - share);
      tethered_.stiffness = stiffness;
      tethered_.origin = q;
      lead_joints(next);
      if (!solve(h, next)) {
        // At rest, but too limp or too taut for a matrix without springs.
        if (at_rest) return release(step);
        share /= 2;
        if (left == 0) stiffness *= 4;
        if (share < least_share * lead) return release(0);
        continue;
      }
      left = next;
      share = std::min(2 * share, lead);
      static_cast<void>(static_cast<System&>(system_).accept(0, q, v));
      if (left > 0) continue;
      at_rest = way_ <= settled;
      if (h >= longest_step * time_ && stiffness == least && at_rest) {
        return release(step);
      }
      h = std::min(longest_step * time_, 4 * h);
      stiffness = std::max(least, stiffness / 2);
    }
    return release(0);
  }

  /// Largest part of the residual that supports leave, over that without them.
  double unbalanced() {
    if (dynamics_.residual(0, q, zero_, zero_, lambda_, r_, c_) != Status::ok) {
      return std::nan("");
    }
    if (system_.residual(0, q, zero_, zero_, next_) != Status::ok) return std::nan("");
    double left = 0, all = 0;
    for (std::size_t i = 0; i < n_; ++i) {
      left = std::max(left, std::abs(r_[i]) * dynamics_.q_typ()[i]);
      all = std::max(all, std::abs(next_[i]) * dynamics_.q_typ()[i]);
    }
    return all > 0 ? left / all : 0;
  }

  std::vector<double> q, v;  // state of the search

 private:
  /// Leaves neither springs nor leads; returns the number of steps.
  int release(int steps) {
    tethered_.stiffness = 0;
    lead_joints(0);
    return steps;
  }

  /// Moves the rest values of half joints by `left` of their first rotations.
  void lead_joints(double left) {
    for (std::size_t i = 0; i < joint_gap_.size(); ++i) {
      joint_lead_[i] = left * joint_gap_[i];
    }
    system_.lead_joints(joint_lead_);
  }

  /// A step of backward Euler of length h from rest, with `left` of the gaps.
  bool solve(double h, double left) {
    kept_ = q;
    lambda_kept_ = lambda_;
    std::ranges::fill(a_, 0.0);
    bool done = false;
    double before = std::numeric_limits<double>::infinity();
    for (int k = 0; k < most_corrections && !done; ++k) {
      for (std::size_t i = 0; i < n_; ++i) next_[i] = kept_[i] + h * h * a_[i];
      Status s = dynamics_.residual(0, next_, zero_, a_, lambda_, r_, c_);
      for (std::size_t j = 0; j < m_; ++j) c_[j] -= left * gap_[j];
      if (s == Status::ok) {
        s = dynamics_.linearize(0, next_, zero_, a_, lambda_, {1, 0, h * h});
      }
      if (s == Status::ok) s = dynamics_.solve(r_, c_);
      double size = 0;
      for (std::size_t i = 0; i < n_; ++i) {
        a_[i] -= r_[i];
        size = std::max(size, std::abs(h * h * r_[i]) / dynamics_.q_typ()[i]);
      }
      for (std::size_t j = 0; j < m_; ++j) lambda_[j] -= c_[j];
      if (s != Status::ok || !(size < most_change)) break;
      // Rounding ends the convergence of stiff strands earlier.
      done = size <= converged || (size <= stalled && size >= before / 2);
      before = size;
    }
    way_ = 0;
    for (std::size_t i = 0; i < n_ && done; ++i) {
      q[i] = kept_[i] + h * h * a_[i];
      way_ = std::max(way_, std::abs(q[i] - kept_[i]) / dynamics_.q_typ()[i]);
    }
    if (!done) lambda_ = lambda_kept_;
    return done;
  }

  /// Bends the strand a little across its chord, downwards if it can.
  void bend() {
    MaterialPoints& points = *system_.material_points();
    const auto count = static_cast<std::size_t>(points.count());
    std::vector<double> x(3 * count), bow(n_);
    points.positions(0, q, x);
    const Vec chord = load3(&x[3 * count - 3]) - load3(x.data());
    const double across = dot(chord, chord);
    double best = 0;
    for (Vec axis : {Vec{0, 0, -1}, Vec{0, 1, 0}, Vec{1, 0, 0}}) {
      if (across > 0) axis = axis - (dot(axis, chord) / across) * chord;
      if (norm(axis) < 0.5) continue;
      std::ranges::fill(next_, 0.0);
      push(points, 0, {1, 1, 1});
      const bool free = std::ranges::any_of(next_, [](double c) { return c != 0; });
      std::ranges::fill(next_, 0.0);
      for (std::size_t i = 0; i < count; ++i) {
        const double part =
            std::numbers::pi * static_cast<double>(i) / static_cast<double>(count - 1);
        push(points, static_cast<int>(i), std::sin(part) * axis);
      }
      double size = 0;
      // Not the six coordinates of a free root, which bend nothing. A strand that sags
      // between two supports curves against one that is clamped and loaded.
      if (free && !points.mean(0)) {
        for (double& entry : next_) entry = -entry;
        std::fill(next_.end() - 6, next_.end(), 0.0);
      }
      for (std::size_t i = 0; i < n_; ++i) {
        next_[i] *= dynamics_.q_typ()[i] * dynamics_.q_typ()[i];
        size = std::max(size, std::abs(next_[i]) / dynamics_.q_typ()[i]);
      }
      if (size <= best) continue;
      best = size;
      bow = next_;
      break;
    }
    const bool places = points.mean(0).has_value();  // coordinates are places
    for (std::size_t i = 0; i < n_ && best > 0; ++i) {
      q[i] += (places ? 0.1 : 1) * slight_bend / best * bow[i];
    }
  }

  /// next_ += J^T force.
  void push(MaterialPoints& points, int point, const Vec& force) {
    static_cast<void>(models::add_point_force(points, 0, q, point, force, next_));
  }

  SupportedSystem& system_;
  TetheredSystem tethered_;
  integrators::Dynamics dynamics_;
  std::size_t n_, m_;
  double time_ = 0, length_ = 0, way_ = 0;
  std::vector<double> a_, r_, next_, zero_, kept_, lambda_, c_, gap_, lambda_kept_,
      joint_gap_, joint_lead_;
};

}  // namespace

SupportedStart begin_on_supports(System& of, const std::string& where) {
  auto& system = dynamic_cast<SupportedSystem&>(of);
  Search search(system);
  SupportedStart start{.held = true};
  const Search::Gap gap = search.gap();
  const std::vector<double> q = search.q, v = search.v;
  const double length = search.length(), from = gap.over(length);
  const bool near = from > on_support && from <= near_support &&
                    search.project() == Status::ok &&
                    search.gap().over(length) <= on_support;
  if (from > on_support && !near) {
    search.q = q;
    search.v = v;
    start.moved = gap.distance;
    start.turned = gap.rotation;
    start.steps = search.find(true);
    refuse_if(start.steps == 0,
              fmt::format(
                  "no equilibrium of a strand that begins {:g} m and {:.3g} rad off its "
                  "supports",
                  gap.distance, gap.rotation),
              where, "give the strand a shape that begins nearer to its supports");
    start.unbalanced = search.unbalanced();
  }
  refuse_if(!near && search.project_rates() != Status::ok,
            "no velocity that the supports admit", where,
            "give the strand slack, or supports that begin at rest");
  system.begin_at(search.q, search.v);
  return start;
}

bool come_to_rest(SupportedSystem& system, InOut q) {
  Search search(system);
  if (search.find(false) == 0) return false;
  std::ranges::copy(search.q, q.begin());
  return true;
}

}  // namespace tress::simulation
