#pragma once

#include <algorithm>
#include <array>
#include <limits>
#include <optional>

#include "models/head/lane_head.h"
#include "models/head/lone_strand.h"
#include "models/head/near_bodies.h"

namespace tress::models {

/// A head of any model in lanes by a step of Newton's, or by as many as converge. A Model
/// has
///
///     Real                                  // PackOf
///     Strand, Element                       // Real only: what is known of them
///     Clamp, Scratch(Model)
///     elements(), unknowns()                // of a strand
///     describe(strand, units, lane, Strand&, Element*, q, v)
///     clamp(Strand, RootPose)
///     renew(Element*, Clamp, q, v)          // reference frames, before a step
///     predict(Strand, RootPose, RootPose, h, q, v, q_bar)   // q + h v
///     newton(Strand, Element*, Clamp, Weights, q, v, a, correction, Scratch&)
///     again(the same)                       // with the matrix of the last newton()
///     resolved(Strand, Weights, lane)       // size of corrections that are rounding
///     positions(Strand, Element*, RootPose, q, use(i, Vec3<Real>))
///     velocities(Strand, RootPose, q, v, use(i, Vec3<Real>))
///     energies(Strand, Element*, RootPose, q, v)   // LaneEnergies
///     mass(Strand, lane)
///     iterates                              // whether there is more than one step
///     use_others                            // remedy for effects that it has not
///     straight                              // whether elements are; else it has
///     element_length(Strand)
///     takes_bodies                          // whether it has these, too:
///     root_at(Strand, Frame), length(Strand)   // from the head's position; of strands
///     most_stretched                        // their length over that
///     find_loads(Strand, bodies, RootPose, HeadUnits, h, q, v, Scratch&)  // for
///     newton() and again(), the latter two at their states; bodies outlive them
///
/// and an Element has keep(lane, double*), recall(lane, const double*): `kept` numbers.
///
///     unit(HeadUnits, k)                    // of unknown k
///
/// all without units; poses are HeadUnits' multiples. Lanes do not mix, and decisions are
/// taken lane by lane, so results are the same bits for any number of lanes, threads and
/// blocks in a call.
template <class Model>
class SteppingHead final : public Head {
 public:
  using T = typename Model::Real;

  SteppingHead(const HeadOptions& options, Instructions instructions)
      : options_(with_uniform_effects(options)),
        units_(HeadUnits::of(options.longest)),
        model_(options_, units_, instructions),
        iterates_(options.method == HeadMethod::backward_euler),
        n_(model_.elements()),
        size_(model_.unknowns()),
        of_state_((iterates_ ? 3 : 2) * size_) {
    options_.motion.frame = {};
    for (const auto& effect : options_.effects) {
      check_for_head(*effect);
      refuse_if(!Model::takes_bodies || effect->rigid_contact() == nullptr,
                on_this_model(*effect), place_of_head, Model::use_others);
      bodies_.push_back(effect->rigid_contact());
    }
  }

  void reserve(std::size_t strands) override {
    const std::size_t blocks = (strands + width - 1) / width;
    strands_.reserve(blocks);
    elements_.reserve(n_ * blocks);
    state_.reserve(of_state_ * blocks);
    lost_.reserve(strands);
  }

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
      radius_ = std::max(radius_, norm(strand.root.position - options_.motion.position) +
                                      Model::most_stretched * static_cast<double>(n_) *
                                          strand.segments.front().length);
    }
    const std::size_t block = lost_.size() / width;
    const int lane_of_own = static_cast<int>(lost_.size() % width);
    if (lane_of_own == 0) {
      strands_.emplace_back();
      elements_.resize(elements_.size() + n_);
      state_.resize(state_.size() + of_state_, T(0));
    }
    models::Strand in_head = strand;
    in_head.root = options_.motion;
    in_head.root.position = strand.root.position;
    in_head.root.frame = strand.root.frame;
    if (!in_head.root.centre) in_head.root.centre = options_.motion.position;
    model_.describe(in_head, options_.motion.position, units_, lane_of_own,
                    strands_[block], &elements_[n_ * block], q_of(block), v_of(block));
    // The first strand of a block fills the lanes of those that may not come.
    for (int lane = 1; lane_of_own == 0 && lane < T::lanes; ++lane) {
      copy_strand(block, 0, block, lane);
    }
    lost_.push_back(0);
  }

  std::size_t strands() const override { return lost_.size(); }
  std::size_t blocks() const override { return strands_.size(); }
  std::size_t bytes() const override {
    return blocks() * (sizeof(typename Model::Strand) +
                       n_ * sizeof(typename Model::Element) + of_state_ * sizeof(T)) +
           lost_.size();
  }
  std::unique_ptr<Scratch> scratch() const override {
    return std::make_unique<Own>(model_);
  }

  void step(std::size_t block, double t, double h, Scratch& given) override {
    step(block, block + 1, t, h, given);
  }
  void step(std::size_t first, std::size_t last, double t, double h,
            Scratch& given) override {
    Own& own = static_cast<Own&>(given);
    own.from = pose(t);
    own.to = pose(t + h);
    if constexpr (Model::takes_bodies) look_around(t + h, own);
    if constexpr (Model::iterates) {
      if (iterates_) return iterate(first, last, t, h, own);
    }
    for (std::size_t block = first; block < last; ++block) once(block, t, h, own);
  }

  bool lost(std::size_t strand) const override { return lost_[strand] != 0; }
  std::vector<HeadLoss> losses(std::size_t known) const override {
    return losses_.after(known);
  }
  void lose(std::size_t strand) override {
    const auto lane = static_cast<int>(strand % width);
    T* const v = v_of(strand / width);
    for (std::size_t k = 0; k < of_state_ - size_; ++k) v[k].set(lane, 0);
    lost_[strand] = 1;
  }

  std::size_t numbers() const override { return 3 * (n_ + 1); }
  std::size_t strands_of(std::size_t block) const override {
    return std::min(width, lost_.size() - width * block);
  }
  void positions(std::size_t block, double t, std::span<double> x) const override {
    place(block, t, &state_[of_state_ * block], x);
  }
  void ahead(std::size_t block, double t, double h, std::span<double> x,
             std::span<double> bulge) const override {
    std::vector<T> next(size_);
    const T* const q = &state_[of_state_ * block];
    model_.predict(strands_[block], pose(t), pose(t + h), h / units_.time, q, q + size_,
                   next.data());
    place(block, t + h, next.data(), x);
    for (std::size_t k = 0; k < strands_of(block); ++k) {
      if constexpr (Model::straight) {
        bulge[k] = 0;
      } else {
        bulge[k] = largest_bulge(
            x.subspan(3 * (n_ + 1) * k, 3 * (n_ + 1)),
            rounded_up<T> * units_.length *
                lane_of(model_.element_length(strands_[block]), static_cast<int>(k)));
      }
    }
  }
  void motion(std::size_t block, double t, std::span<double> x,
              std::span<double> v) const override {
    positions(block, t, x);
    const T* const q = &state_[of_state_ * block];
    model_.velocities(strands_[block], pose(t), q, q + size_,
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
    const T* const from = &state_[of_state_ * (strand / width)];
    for (std::size_t k = 0; k < size_; ++k) {
      const double unit = model_.unit(units_, k);
      q[k] = unit * lane_of(from[k], lane);
      v[k] = unit / units_.time * lane_of(from[size_ + k], lane);
    }
  }
  void energies(std::size_t block, double t, std::span<HeadEnergy> each) const override {
    const T* const q = &state_[of_state_ * block];
    const auto sums =
        model_.energies(strands_[block], &elements_[n_ * block], pose(t), q, q + size_);
    const Vec from = options_.motion.at(t).x;
    for (std::size_t k = 0; k < strands_of(block); ++k) {
      const auto lane = static_cast<int>(k);
      each[k] = sums.of(lane, units_, units_.mass() * model_.mass(strands_[block], lane),
                        from, options_.gravity);
    }
  }

  // Of a strand: its numbers of state, reference frames, and whether it is lost.
  std::size_t kept() const override { return of_state_ + Model::Element::kept * n_ + 1; }
  std::size_t kept_of_state() const override { return 2 * size_; }
  void keep(std::size_t block, std::span<double> x) const override {
    double* to = x.data();
    for (std::size_t k = 0; k < strands_of(block); ++k) {
      const auto lane = static_cast<int>(k);
      for (std::size_t i = 0; i < of_state_; ++i) {
        *to++ = lane_of(state_[of_state_ * block + i], lane);
      }
      for (std::size_t i = 0; i < n_; ++i) {
        elements_[n_ * block + i].keep(lane, to);
        to += Model::Element::kept;
      }
      *to++ = lost_[width * block + k];
    }
  }
  void recall(std::size_t block, std::span<const double> x) override {
    const double* from = x.data();
    for (std::size_t k = 0; k < strands_of(block); ++k) {
      const auto lane = static_cast<int>(k);
      for (std::size_t i = 0; i < of_state_; ++i) {
        set_lane(state_[of_state_ * block + i], lane, *from++);
      }
      for (std::size_t i = 0; i < n_; ++i) {
        elements_[n_ * block + i].recall(lane, from);
        from += Model::Element::kept;
      }
      lost_[width * block + k] = *from++ != 0 ? 1 : 0;
    }
  }

 private:
  static constexpr std::size_t width = T::lanes;
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

  using Lanes = std::array<std::size_t, width>;  // the strand in each, or none

  struct Own final : Scratch {
    explicit Own(const Model& model) : work(model) {}
    LaneWork<Model> work;
    RootPose from, to;
    std::vector<std::size_t> failed, stuck;
    double t = std::numeric_limits<double>::quiet_NaN();  // of what follows
    Vec head;                                             // its position, m
    std::vector<NearBody> around, near;  // bodies that reach the head, and a block
  };

  // Beyond those that the options' numbers say as well.
  static std::string on_this_model(const Effect& effect) {
    return "effect " + std::string(effect.name()) + " on this model";
  }
  /// Bodies that reach the ball in which all strands are at t, the step's end.
  void look_around(double t, Own& own) const {
    if (bodies_.empty() || own.t == t) return;
    own.t = t;
    own.head = options_.motion.at(t).x;
    bodies_around(bodies_, t, {own.head, radius_}, own.around);
  }
  /// Those of them that reach strands, at this pose of the head.
  std::span<const NearBody> reached(const typename Model::Strand& strand,
                                    const RootPose& pose, Own& own) const {
    if (own.around.empty()) return {};
    const T unit(units_.length), longest(Model::most_stretched * units_.length);
    bodies_near<T>(own.around, unit * model_.root_at(strand, pose.frame),
                   longest * model_.length(strand), own.near);
    return own.near;
  }
  /// Loads on the strands that are worked on, of a step of h (s) to t.
  void meet_bodies(double t, double h, Own& own) const {
    if constexpr (Model::takes_bodies) {
      look_around(t, own);
      const RootPose at = pose(t);
      LaneWork<Model>& work = own.work;
      model_.find_loads(work.strand, reached(work.strand, at, own), at, units_, h,
                        work.q.data(), work.v.data(), work.scratch);
    }
  }

  void place(std::size_t block, double t, const T* q, std::span<double> x) const {
    const RootPose of_head = options_.motion.at(t);
    model_.positions(
        strands_[block], of_head.frame, q, [&](std::size_t i, const Vec3<T>& at) {
          for (std::size_t k = 0; k < strands_of(block); ++k) {
            store3(of_head.x + units_.length * lane_of(at, static_cast<int>(k)),
                   &x[3 * (k * (n_ + 1) + i)]);
          }
        });
  }

  T* q_of(std::size_t block) { return &state_[of_state_ * block]; }
  T* v_of(std::size_t block) { return q_of(block) + size_; }

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

  void copy_strand(std::size_t from, int lane_from, std::size_t to, int lane_to) {
    copy_lane<T>(strands_[from], lane_from, strands_[to], lane_to);
    for (std::size_t i = 0; i < n_; ++i) {
      copy_lane<T>(elements_[n_ * from + i], lane_from, elements_[n_ * to + i], lane_to);
    }
    copy_lane(q_of(from), lane_from, q_of(to), lane_to, of_state_);
  }

  /// One step of Newton's for a block where it lies.
  void once(std::size_t block, double t, double h_s, Own& own) {
    const double h = h_s / units_.time;
    LaneWork<Model>& work = own.work;
    T *const q = q_of(block), *const v = v_of(block), *const a = work.a();
    typename Model::Element* const elements = &elements_[n_ * block];
    const typename Model::Strand& strand = strands_[block];
    model_.renew(elements, model_.clamp(strand, own.from), q, v);
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
    own.Scratch::work.steps += static_cast<long>(strands_of(block));
    if (all_up_to(size, std::numeric_limits<typename T::Scalar>::max()) &&
        !some_lost(block)) [[likely]] {
      for (std::size_t k = 0; k < size_; ++k) {
        v[k] -= vel * work.step[k];
        q[k] = work.q_bar[k] - pos * work.step[k];
      }
      return;
    }
    for (std::size_t k = 0; k < strands_of(block); ++k) {
      const auto lane = static_cast<int>(k);
      if (lost_[width * block + k] != 0) continue;
      if (!std::isfinite(size[lane])) {
        lose(width * block + k, t, h_s, "the result of the step is not finite");
        continue;
      }
      for (std::size_t i = 0; i < size_; ++i) {
        v[i].set(lane, (v[i] - vel * work.step[i])[lane]);
        q[i].set(lane, (work.q_bar[i] - pos * work.step[i])[lane]);
      }
    }
  }
  bool some_lost(std::size_t block) const {
    return std::any_of(&lost_[width * block], &lost_[width * block] + strands_of(block),
                       [](char lost) { return lost != 0; });
  }

  /// Strands that wait for a lane: those of blocks, or of a list.
  struct Queue {
    std::size_t next, end;
    const std::vector<std::size_t>* list = nullptr;
    std::size_t strand() const { return list == nullptr ? next : (*list)[next]; }
  };

  /// Newton's iteration, damped iterations of the strands on which it fails, and those on
  /// which they fail one by one.
  void iterate(std::size_t first, std::size_t last, double t, double h_s, Own& own) {
    HeadWork& done = own.Scratch::work;
    for (std::size_t block = first; block < last; ++block) {
      done.steps += static_cast<long>(strands_of(block));
    }
    PlainCourse<Model> plain(model_, options_.newton_tolerance,
                             options_.newton_iterations);
    own.failed.clear();
    run({width * first, std::min(width * last, lost_.size())}, plain, t, h_s, own,
        own.failed, done.iterations, done.lanes);
    if (own.failed.empty()) return;
    done.retried += static_cast<long>(own.failed.size());
    DampedCourse<Model> damped(model_, options_.newton_tolerance,
                               options_.newton_iterations);
    own.stuck.clear();
    run({0, own.failed.size(), &own.failed}, damped, t, h_s, own, own.stuck,
        done.again_iterations, done.again_lanes);
    done.again_iterations += damped.iterations;
    done.again_lanes += damped.lanes;
    for (const std::size_t strand : own.stuck) alone(strand, t, h_s, own);
  }

  /// Lanes that are done take the next strand of the queue.
  template <class Course>
  void run(Queue queue, Course& course, double t, double h_s, Own& own,
           std::vector<std::size_t>& failed, long& iterations, long& lanes) {
    LaneWork<Model>& work = own.work;
    Lanes home;
    home.fill(none);
    for (bool refill = true;;) {
      if (refill) {
        const Lanes before = home;
        fill(home, queue, work);
        if (std::ranges::all_of(home, [](std::size_t k) { return k == none; })) break;
        work.begin(model_, own.from, own.to, h_s / units_.time);
        meet_bodies(t + h_s, h_s, own);
        for (std::size_t k = 0; k < width; ++k) {
          if (before[k] == none) course.start(static_cast<int>(k), work);
        }
        refill = false;
      }
      const auto verdicts = course.go_on(work, work.newton(model_));
      lanes += T::lanes;
      for (std::size_t k = 0; k < width; ++k) {
        if (home[k] == none) continue;
        ++iterations;
        if (verdicts[k] == NewtonVerdict::go_on) continue;
        if (verdicts[k] == NewtonVerdict::converged) {
          put_home(work, static_cast<int>(k), home[k]);
        } else {
          failed.push_back(home[k]);
        }
        home[k] = none;
        refill = true;
      }
    }
  }

  /// Takes the next strands into free lanes; into all lanes of a whole block at once.
  void fill(Lanes& home, Queue& queue, LaneWork<Model>& work) {
    const bool all_free =
        std::ranges::all_of(home, [](std::size_t k) { return k == none; });
    if (all_free && queue.list == nullptr && queue.next < queue.end &&
        queue.next % width == 0) {
      const std::size_t block = queue.next / width;
      work.strand = strands_[block];
      std::copy_n(&elements_[n_ * block], n_, work.elements.begin());
      std::copy_n(q_of(block), of_state_, work.state.begin());
      for (std::size_t k = 0; k < width && queue.next < queue.end; ++k, ++queue.next) {
        if (lost_[queue.next] == 0) home[k] = queue.next;
      }
    }
    for (std::size_t k = 0; k < width; ++k) {
      if (home[k] != none) continue;
      while (queue.next < queue.end && lost_[queue.strand()] != 0) ++queue.next;
      if (queue.next == queue.end) return;
      home[k] = queue.strand();
      take(home[k], work, static_cast<int>(k));
      ++queue.next;
    }
  }

  void take(std::size_t strand, LaneWork<Model>& work, int lane) {
    const std::size_t block = strand / width;
    const auto from = static_cast<int>(strand % width);
    copy_lane<T>(strands_[block], from, work.strand, lane);
    for (std::size_t i = 0; i < n_; ++i) {
      copy_lane<T>(elements_[n_ * block + i], from, work.elements[i], lane);
    }
    copy_lane(q_of(block), from, work.q_n(), lane, of_state_);
  }
  void put_home(LaneWork<Model>& work, int lane, std::size_t strand) {
    const std::size_t block = strand / width;
    const auto to = static_cast<int>(strand % width);
    for (std::size_t i = 0; i < n_; ++i) {
      copy_lane<T>(work.elements[i], lane, elements_[n_ * block + i], to);
    }
    copy_lane(work.q.data(), lane, q_of(block), to, size_);
    copy_lane(work.v.data(), lane, v_of(block), to, size_);
    copy_lane(work.a(), lane, v_of(block) + size_, to, size_);
  }

  void alone(std::size_t strand, double t, double h_s, Own& own) {
    for (int lane = 0; lane < T::lanes; ++lane) take(strand, own.work, lane);
    LoneStrand<Model> lone(model_, options_.newton_tolerance, options_.newton_iterations,
                           own.work);
    const bool solved = lone.solve(
        [&](double part) { return pose(t + part * h_s); },
        [&](double part, int parts) { meet_bodies(t + part * h_s, h_s / parts, own); },
        h_s / units_.time);
    own.Scratch::work.alone += lone.iterations;
    own.Scratch::work.again_iterations += lone.iterations;
    own.Scratch::work.again_lanes += T::lanes * lone.iterations;
    own.Scratch::work.shortened += lone.shortened ? 1 : 0;
    if (solved) {
      put_home(own.work, 0, strand);
    } else {
      lose(strand, t, h_s, "no solution for the step, nor for 64 parts of it");
    }
  }

  void lose(std::size_t strand, double t, double h_s, std::string_view reason) {
    lose(strand);
    losses_.add(strand, t, h_s, reason);
  }

  HeadOptions options_;
  HeadUnits units_;
  Model model_;
  bool iterates_;
  std::size_t n_, size_, of_state_;  // per strand: elements, unknowns, numbers of state
  std::vector<typename Model::Strand> strands_;    // (blocks)
  std::vector<typename Model::Element> elements_;  // (blocks, elements)
  std::vector<T> state_;                           // (blocks; q, v, and a if it iterates)
  std::vector<char> lost_;                         // of each strand
  HeadLosses losses_;
  std::vector<const RigidContact*> bodies_;
  double radius_ = 0;  // of the ball about the head's position that holds all strands, m
};

}  // namespace tress::models
