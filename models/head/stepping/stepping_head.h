#pragma once

#include <algorithm>
#include <limits>
#include <optional>
#include <vector>

#include "models/head/head_bodies.h"
#include "models/head/lane_head.h"
#include "models/head/stepping/controlled_steps.h"
#include "models/head/stepping/lane_solver.h"
#include "models/head/stepping/stepped_model.h"

namespace tress::models {

/// A head of any SteppedModel in lanes, by one correction of Newton's a step or by the
/// stages of a LaneMethod. Lanes do not mix, so results are the same bits for any number
/// of lanes, threads and blocks in a call.
template <SteppedModel Model>
class SteppingHead final : public Head {
 public:
  using T = typename Model::Real;

  SteppingHead(const HeadOptions& options, Instructions instructions)
      : options_(with_uniform_effects(options)),
        units_(HeadUnits::of(options.longest)),
        model_(options_, units_, instructions),
        method_(lane_method(options.method)),
        n_(model_.elements()),
        size_(model_.unknowns()),
        all_(model_, method_, options.tolerance > 0) {
    options_.motion.frame = {};
    for (const auto& effect : options_.effects) {
      check_for_head(*effect);
      refuse_if(!Model::takes_bodies || effect->rigid_contact() == nullptr,
                on_this_model(*effect), place_of_head, Model::use_others);
      bodies_.add(effect->rigid_contact());
    }
  }

  void reserve(std::size_t strands) override { all_.reserve(strands); }

  using Head::add;
  using Head::losses;
  void add(const models::Strand& strand, Effects own) override {
    models::check(strand);
    check_for_head(strand, n_);
    refuse_if(!own.empty(), own.empty() ? "" : on_this_model(*own.front()), place_of_head,
              Model::use_others);
    units_.weigh(options_.line_density,
                 strand.material.density * strand.segments.front().section.area());
    if constexpr (Model::takes_bodies) {
      bodies_.include(norm(strand.root.position - options_.motion.position) +
                      Model::most_stretched * static_cast<double>(n_) *
                          strand.segments.front().length);
    }
    models::Strand in_head = strand;
    in_head.root = options_.motion;
    in_head.root.position = strand.root.position;
    in_head.root.frame = strand.root.frame;
    if (!in_head.root.centre) in_head.root.centre = options_.motion.position;
    all_.add([&](int lane, typename Model::Strand& to, typename Model::Element* elements,
                 T* q, T* v) {
      model_.describe(in_head, options_.motion.position, units_, lane, to, elements, q,
                      v);
    });
  }

  std::size_t strands() const override { return all_.size(); }
  std::size_t blocks() const override { return all_.blocks(); }
  std::size_t bytes() const override { return all_.bytes(); }
  std::unique_ptr<Scratch> scratch() const override {
    return std::make_unique<Own>(model_, method_, options_, units_);
  }

  void step(std::size_t block, double t, double h, Scratch& given) override {
    step(block, block + 1, t, h, given);
  }
  void step(std::size_t first, std::size_t last, double t, double h,
            Scratch& given) override {
    Own& own = static_cast<Own&>(given);
    if constexpr (Model::iterates) {
      if (own.controlled) return control(first, last, t, h, own);
    }
    own.from = pose(t);
    for (std::size_t block = first; block < last; ++block) {
      own.Scratch::work.steps += static_cast<long>(strands_of(block));
      all_.renew(model_, block, own.from);
    }
    if (options_.method == HeadMethod::semi_implicit_euler) {
      own.to = pose(t + h);
      if constexpr (Model::takes_bodies) bodies_.look(t + h, options_.motion, own.near);
      for (std::size_t block = first; block < last; ++block) once(block, t, h, own);
    } else if constexpr (Model::iterates) {
      solve({width * first, std::min(width * last, all_.size())}, t, h, own);
    }
  }

  /// Strands that choose their steps share lanes with those of the same step alone: in a
  /// hundred blocks of 8 lanes 8 % of the lanes are without one, in a dozen 40 %.
  std::size_t blocks_at_once() const override {
    return options_.tolerance > 0 ? 100 : Head::blocks_at_once();
  }
  bool lost(std::size_t strand) const override { return all_.lost(strand); }
  std::vector<HeadLoss> losses(std::size_t known) const override {
    return losses_.after(known);
  }
  void lose(std::size_t strand) override { all_.lose(strand); }

  std::size_t numbers() const override { return 3 * (n_ + 1); }
  std::size_t strands_of(std::size_t block) const override { return all_.of(block); }
  void positions(std::size_t block, double t, std::span<double> x) const override {
    place(block, t, all_.q(block), x);
  }
  void ahead(std::size_t block, double t, double h, std::span<double> x,
             std::span<double> bulge) const override {
    std::vector<T> next(size_);
    const T* const q = all_.q(block);
    model_.predict(all_.strand(block), pose(t), pose(t + h), h / units_.time, q,
                   q + size_, next.data());
    place(block, t + h, next.data(), x);
    for (std::size_t k = 0; k < strands_of(block); ++k) {
      if constexpr (Model::straight) {
        bulge[k] = 0;
      } else {
        bulge[k] = largest_bulge(
            x.subspan(3 * (n_ + 1) * k, 3 * (n_ + 1)),
            rounded_up<T> * units_.length *
                lane_of(model_.element_length(all_.strand(block)), static_cast<int>(k)));
      }
    }
  }
  void motion(std::size_t block, double t, std::span<double> x,
              std::span<double> v) const override {
    positions(block, t, x);
    const T* const q = all_.q(block);
    model_.velocities(all_.strand(block), pose(t), q, q + size_,
                      [&](std::size_t i, const Vec3<T>& u) {
                        for (std::size_t k = 0; k < strands_of(block); ++k) {
                          store3(units_.speed() * lane_of(u, static_cast<int>(k)),
                                 &v[3 * (k * (n_ + 1) + i)]);
                        }
                      });
  }
  void state(std::size_t strand, std::span<double> q,
             std::span<double> v) const override {
    const auto lane = static_cast<int>(strand % width);
    const T* const from = all_.q(strand / width);
    for (std::size_t k = 0; k < size_; ++k) {
      const double unit = model_.unit(units_, k);
      q[k] = unit * lane_of(from[k], lane);
      v[k] = unit / units_.time * lane_of(from[size_ + k], lane);
    }
  }
  void energies(std::size_t block, double t, std::span<HeadEnergy> each) const override {
    const T* const q = all_.q(block);
    const auto sums =
        model_.energies(all_.strand(block), all_.elements(block), pose(t), q, q + size_);
    const Vec from = options_.motion.at(t).x;
    for (std::size_t k = 0; k < strands_of(block); ++k) {
      const auto lane = static_cast<int>(k);
      each[k] =
          sums.of(lane, units_, units_.mass() * model_.mass(all_.strand(block), lane),
                  from, options_.gravity);
    }
  }

  std::size_t kept() const override { return all_.kept(); }
  std::size_t kept_of_state() const override { return 2 * size_; }
  void keep(std::size_t block, std::span<double> x) const override {
    all_.keep(block, x.data());
  }
  void recall(std::size_t block, std::span<const double> x) override {
    all_.recall(block, x.data());
  }

 private:
  static constexpr std::size_t width = T::lanes;

  struct Own final : Scratch {
    Own(const Model& model, const LaneMethod& method, const HeadOptions& options,
        const HeadUnits& units)
        : solver(model, method, newton_tolerance(options),
                 options.tolerance > 0 ? 1 : NewtonRules::margin,
                 options.newton_iterations) {
      if constexpr (Model::iterates) {
        if (options.tolerance > 0) {
          controlled.emplace(model, method, options.tolerance,
                             options.min_step / units.time, solver);
        }
      }
    }
    LaneSolver<Model> solver;
    std::optional<ControlledSteps<Model>> controlled;  // with a tolerance
    RootPose from, to;
    HeadBodies::Near near;
  };

  static double newton_tolerance(const HeadOptions& options) {
    if constexpr (Model::iterates) {
      if (options.tolerance > 0) return Model::newton_part * options.tolerance;
    }
    return options.newton_tolerance;
  }

  // Beyond those that the options' numbers say as well.
  static std::string on_this_model(const Effect& effect) {
    return "effect " + std::string(effect.name()) + " on this model";
  }
  /// Bodies that reach strands, at this pose of the head.
  std::span<const NearBody> reached(const typename Model::Strand& strand,
                                    const RootPose& pose, Own& own) const {
    if (own.near.none()) return {};
    const T unit(units_.length), longest(Model::most_stretched * units_.length);
    return HeadBodies::reached<T>(own.near, unit * model_.root_at(strand, pose.frame),
                                  longest * model_.length(strand));
  }
  /// Loads at t on the strands that are worked on, of a stage of gamma h = h (s).
  void meet_bodies(double t, double h, Own& own) const {
    if constexpr (Model::takes_bodies) {
      bodies_.look(t, options_.motion, own.near);
      const RootPose at = pose(t);
      LaneWork<Model>& work = own.solver.work;
      model_.find_loads(work.strand, reached(work.strand, at, own), at, units_, h,
                        work.q.data(), work.v.data(), work.scratch);
    }
  }

  void place(std::size_t block, double t, const T* q, std::span<double> x) const {
    const RootPose of_head = options_.motion.at(t);
    model_.positions(
        all_.strand(block), of_head.frame, q, [&](std::size_t i, const Vec3<T>& at) {
          for (std::size_t k = 0; k < strands_of(block); ++k) {
            store3(of_head.x + units_.length * lane_of(at, static_cast<int>(k)),
                   &x[3 * (k * (n_ + 1) + i)]);
          }
        });
  }

  RootPose pose(double t) const {
    RootPose at = options_.motion.at(t);
    const double l = units_.length, tau = units_.time;
    at.x = (1 / l) * at.x;
    at.v = (tau / l) * at.v;
    at.a = (tau * tau / l) * at.a;
    at.omega = tau * at.omega;
    at.alpha = (tau * tau) * at.alpha;
    return at;
  }

  /// By the stages of the method.
  void solve(const LaneQueue& queue, double t, double h, Own& own) {
    const auto& lost = own.solver.step(
        queue, all_, [&](double part) { return pose(t + part * h); },
        [&](double part, double share) { meet_bodies(t + part * h, share * h, own); },
        h / units_.time, own.Scratch::work);
    for (const auto& [strand, reason] : lost) losses_.add(strand, t, h, reason);
  }

  /// Steps of each strand's own, which end where the motion of the head is not smooth.
  void control(std::size_t first, std::size_t last, double t, double h, Own& own) {
    const double end = t + h;
    for (double begin = t; begin < end;) {
      const double stop = std::min(options_.motion.next_breakpoint(begin), end),
                   length = stop - begin;
      const RootPose from = pose(begin);
      for (std::size_t block = first; block < last; ++block) {
        all_.renew(model_, block, from);
      }
      const auto& lost = own.controlled->step(
          width * first, std::min(width * last, all_.size()), all_,
          [&](double part) { return pose(begin + part * length); },
          [&](double part, double share) {
            meet_bodies(begin + part * length, share * length, own);
          },
          length / units_.time, own.Scratch::work);
      for (const auto& [strand, at, reason] : lost) {
        losses_.add(strand, t, h, reason, (begin - t + at * length) / h);
      }
      begin = stop;
    }
  }

  /// One correction of Newton's for a block where it lies.
  void once(std::size_t block, double t, double h_s, Own& own) {
    const double h = h_s / units_.time;
    LaneWork<Model>& work = own.solver.work;
    T *const q = all_.q(block), *const v = all_.v(block), *const a = work.a();
    typename Model::Element* const elements = all_.elements(block);
    const typename Model::Strand& strand = all_.strand(block);
    model_.predict(strand, own.from, own.to, h, q, v, work.q_bar.data());
    std::fill_n(a, size_, T(0));
    if constexpr (Model::takes_bodies) {
      model_.find_loads(strand, reached(strand, own.to, own), own.to, units_, h_s,
                        work.q_bar.data(), v, work.scratch);
    }
    const T size =
        model_.newton(strand, elements, model_.clamp(strand, own.to), {1, h, h * h},
                      work.q_bar.data(), v, a, work.step.data(), work.scratch);
    const T pos(h * h), vel(h);
    if (all_up_to(size, std::numeric_limits<typename T::Scalar>::max()) &&
        !all_.some_lost(block)) [[likely]] {
      for (std::size_t k = 0; k < size_; ++k) {
        v[k] -= vel * work.step[k];
        q[k] = work.q_bar[k] - pos * work.step[k];
      }
      return;
    }
    for (std::size_t k = 0; k < strands_of(block); ++k) {
      const auto lane = static_cast<int>(k);
      if (all_.lost(width * block + k)) continue;
      if (!std::isfinite(size[lane])) {
        lose(width * block + k);
        losses_.add(width * block + k, t, h_s, "the result of the step is not finite");
        continue;
      }
      for (std::size_t i = 0; i < size_; ++i) {
        v[i].set(lane, (v[i] - vel * work.step[i])[lane]);
        q[i].set(lane, (work.q_bar[i] - pos * work.step[i])[lane]);
      }
    }
  }

  HeadOptions options_;
  HeadUnits units_;
  Model model_;
  LaneMethod method_;
  std::size_t n_, size_;  // elements and unknowns of a strand
  LaneStrands<Model> all_;
  HeadLosses losses_;
  HeadBodies bodies_;
};

}  // namespace tress::models
