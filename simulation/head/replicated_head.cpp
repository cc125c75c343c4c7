#include "simulation/head/replicated_head.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "contract/input_error.h"
#include "simulation/run/memory.h"

namespace tress::simulation {

using models::HeadEnergy;

/// Guards are of the strands: what is judged here is what a step has not judged.
class ReplicatedHead::Judge final : public HeadGuard {
 public:
  explicit Judge(ReplicatedHead& head) : head_(head) {
    for (const auto& effect : head.maker_.effects()) {
      if (!effect->uniform_acceleration()) ++effects_;
    }
  }

  std::size_t effects() const override { return effects_; }
  void potentials(const Head&, std::size_t block, std::size_t, double t,
                  std::span<double> each) const override {
    const SteppedSystem& run = head_.strands_[block].run;
    std::ranges::fill(each, 0.0);
    Energetics* energetics = run.system->energetics();
    if (energetics == nullptr) return;
    static_cast<void>(energetics->energy(t, run.seen_q(), run.seen_v()));
    std::size_t i = 0;
    for (const auto& meter : run.meters) {
      if (!meter->uniform_acceleration()) each[i++] = meter->last();
    }
  }

  void start(const Head&, std::size_t block, std::size_t, double t) override {
    SteppedSystem& run = head_.strands_[block].run;
    if (run.guard) run.guard->start(t, run.integrator->q(), run.integrator->v());
  }
  bool due(double, double) const override { return false; }
  void judge(const Head&, std::size_t block, std::size_t, double t) override {
    SteppedSystem& run = head_.strands_[block].run;
    if (!run.guard || run.stays() || !(t > 0)) return;
    static_cast<void>(run.guard->judge(t, run.integrator->q(), run.integrator->v()));
    OfStrand& one = head_.strands_[block];
    if (run.guard->breach()) one.verdict = run.guard->breach()->message();
  }
  std::string_view verdict(std::size_t place) const override {
    return head_.strands_[place].verdict;
  }

  Excess excess() const override {
    Excess most;
    for (const OfStrand& one : head_.strands_) {
      if (one.run.guard) most.take(one.run.guard->excess());
    }
    return most;
  }
  std::string no_dissipation() const override {
    if (head_.touching_) return std::string(touching_strands);
    return head_.strands_.front().run.no_dissipation();
  }
  MethodDissipation dissipation() const override {
    MethodDissipation sum;
    for (const OfStrand& one : head_.strands_) sum += one.run.guard->dissipation();
    return sum;
  }
  std::optional<StrandPassage> passed() const override {
    std::optional<StrandPassage> first;
    for (std::size_t k = 0; k < head_.strands_.size(); ++k) {
      const auto& depth = head_.strands_[k].run.depth;
      if (!depth || !depth->seen.missed) continue;
      if (first && first->contact.t <= depth->seen.missed->t) continue;
      first = {k, *depth->seen.missed};
    }
    return first;
  }

  // The head keeps what guards have gathered.
  std::size_t kept() const override { return 0; }
  void keep(std::size_t, std::span<double>) const override {}
  void recall(std::size_t, std::span<const double>) override {}

 private:
  ReplicatedHead& head_;
  std::size_t effects_ = 0;
};

namespace {

struct Done final : models::Head::Scratch {};

void add_done(const Stats& before, const Stats& now, models::HeadWork& work) {
  const long iterations = now.newton_iterations - before.newton_iterations;
  work.steps += now.steps - before.steps;
  work.iterations += iterations;
  work.lanes += iterations;
  work.shortened += now.rejected - before.rejected;
  work.replaced += now.replaced - before.replaced;
  work.rejected_by_error += now.rejected_by_error - before.rejected_by_error;
  work.rejected_by_newton += now.rejected_by_newton - before.rejected_by_newton;
}

/// Largest distance of an arc of this length from its chord.
double bulge_of(double arc, double chord) {
  return std::sqrt(std::max(0.0, arc * arc - chord * chord)) / 2;
}

}  // namespace

ReplicatedHead::ReplicatedHead(const Scene& scene, int elements)
    : maker_(scene),
      elements_(static_cast<std::size_t>(elements)),
      touching_(scene.interaction() != nullptr) {}

void ReplicatedHead::add(const StrandToMake& strand, std::size_t number) {
  const auto refuse = [&](const std::string& what, const std::string& remedy) {
    throw InputError(what, fmt::format("strand {} of a batch", number), remedy);
  };
  if (strand.strand.segments.size() != elements_) {
    refuse(fmt::format("{} elements, others have {}", strand.strand.segments.size(),
                       elements_),
           "give all strands equally many elements");
  }
  const std::size_t before = heap_in_use();
  OfStrand one{
      .run = maker_.one(strand, number), .mass = strand.strand.mass(), .lengths = {}};
  for (const Segment& segment : strand.strand.segments) {
    one.lengths.push_back(segment.length);
  }
  SteppedSystem& run = one.run;
  MaterialPoints* const points = run.system->material_points();
  if (points == nullptr || points->count() != static_cast<int>(elements_ + 1)) {
    refuse(
        "the model has no material points at the ends of its elements, which frames "
        "of a batch consist of",
        "use --as strands");
  }
  if (BodyDepth depth(maker_.effects(), *points); depth.any()) {
    run.depth.emplace(std::move(depth));
  }
  run.take_method(maker_.method().id, maker_.options());
  SteppedSystem::State begin = run.initial_state();
  if (strands_.empty()) {
    coordinates_ = begin.q.size();
    memory_ = begin.memory.size();
  } else if (begin.q.size() != coordinates_ || begin.memory.size() != memory_) {
    refuse("other coordinates than the strands before it", "use --as strands");
  }
  run.start(0, std::move(begin));
  if (run.status != Status::ok) {
    one.failure = run.failure();
    run.stay(run.begun());
  }
  strands_.push_back(std::move(one));
  bytes_ += std::max(heap_in_use(), before) - before;
}

std::unique_ptr<HeadGuard> ReplicatedHead::guard() {
  return std::make_unique<Judge>(*this);
}

std::unique_ptr<models::Head::Scratch> ReplicatedHead::scratch() const {
  return std::make_unique<Done>();
}

void ReplicatedHead::step(std::size_t block, double t, double h, Scratch& scratch) {
  OfStrand& one = strands_[block];
  SteppedSystem& run = one.run;
  if (run.stays()) return report(block, t, h);
  const Stats before = run.stats();
  run.advance(maker_.method(), maker_.options(), t + h, false);
  add_done(before, run.stats(), scratch.work);
  if (run.status == Status::ok) return;
  one.failure = run.failure();
  report(block, t, h);
  run.stay(run.begun());
}

void ReplicatedHead::report(std::size_t strand, double t, double h) {
  OfStrand& one = strands_[strand];
  if (one.known) return;
  one.known = true;
  losses_.add(strand, t, h, one.failure, (one.run.t - t) / h);
}

void ReplicatedHead::lose(std::size_t strand) {
  OfStrand& one = strands_[strand];
  one.known = true;
  one.run.stay(one.run.begun());
}

void ReplicatedHead::positions(std::size_t block, double t, std::span<double> x) const {
  const SteppedSystem& run = strands_[block].run;
  run.system->material_points()->positions(t, run.seen_q(), x);
}

void ReplicatedHead::motion(std::size_t block, double t, std::span<double> x,
                            std::span<double> v) const {
  positions(block, t, x);
  const SteppedSystem& run = strands_[block].run;
  run.system->material_points()->velocities(t, run.seen_q(), run.seen_v(), v);
}

void ReplicatedHead::ahead(std::size_t block, double t, double h, std::span<double> x,
                           std::span<double> bulge) const {
  const OfStrand& one = strands_[block];
  std::vector<double> q(coordinates_);
  for (std::size_t i = 0; i < q.size(); ++i) {
    q[i] = one.run.seen_q()[i] + h * one.run.seen_v()[i];
  }
  MaterialPoints& points = *one.run.system->material_points();
  points.positions(t + h, q, x);
  const double stretched = 1 + points.stretch(t + h, q).value_or(0);
  bulge[0] = 0;
  for (std::size_t i = 0; i < elements_; ++i) {
    const double chord = norm(load3(&x[3 * (i + 1)]) - load3(&x[3 * i]));
    bulge[0] = std::max(bulge[0], bulge_of(stretched * one.lengths[i], chord));
  }
}

void ReplicatedHead::state(std::size_t strand, std::span<double> q,
                           std::span<double> v) const {
  std::ranges::copy(strands_[strand].run.seen_q(), q.begin());
  std::ranges::copy(strands_[strand].run.seen_v(), v.begin());
}

void ReplicatedHead::energies(std::size_t block, double t,
                              std::span<HeadEnergy> each) const {
  const OfStrand& one = strands_[block];
  HeadEnergy& to = each[0] = {};
  to.mass = one.mass;
  std::vector<double> x(numbers()), v(numbers());
  motion(block, t, x, v);
  to.tip = load3(&x[3 * elements_]);
  for (std::size_t i = 0; i <= elements_; ++i) {
    to.fastest = std::max(to.fastest, norm(load3(&v[3 * i])));
  }
  Energetics* energetics = one.run.system->energetics();
  if (energetics == nullptr) return;
  const Energy energy = energetics->energy(t, one.run.seen_q(), one.run.seen_v());
  double of_effects = 0;
  for (const auto& meter : one.run.meters) {
    of_effects += meter->last();
    if (meter->uniform_acceleration()) to.gravity += meter->last();
  }
  to.kinetic = energy.kinetic;
  to.elastic = energy.potential - of_effects;
}

std::size_t ReplicatedHead::kept() const {
  const bool guarded = !strands_.empty() && strands_.front().run.guard;
  return 2 * coordinates_ + memory_ + (guarded ? Guard::remembered : 0) + 2;
}

/// q, v, memory, what the guard has gathered, time, whether it is lost.
void ReplicatedHead::keep(std::size_t block, std::span<double> x) const {
  const SteppedSystem& run = strands_[block].run;
  const std::vector<double> memory = run.system->memory();
  auto to = std::ranges::copy(run.seen_q(), x.begin()).out;
  to = std::ranges::copy(run.seen_v(), to).out;
  to = std::ranges::copy(memory, to).out;
  if (run.guard) to = std::ranges::copy(run.guard->memory(), to).out;
  *to++ = run.stays() ? run.t : run.integrator->time();
  *to = run.stays() ? 1 : 0;
}

void ReplicatedHead::recall(std::size_t block, std::span<const double> x) {
  OfStrand& one = strands_[block];
  SteppedSystem& run = one.run;
  const auto take = [&](std::size_t count) {
    const auto part = x.first(count);
    x = x.subspan(count);
    return std::vector<double>(part.begin(), part.end());
  };
  SteppedSystem::State state;
  state.q = take(coordinates_);
  state.v = take(coordinates_);
  state.memory = take(memory_);
  const std::vector<double> gathered = take(run.guard ? Guard::remembered : 0);
  run.take_method(maker_.method().id, maker_.options());
  run.start(x[0], std::move(state));
  if (run.guard) run.guard->recall(gathered, run.integrator->time(), run.integrator->q());
  one.known = x[1] != 0;
  if (run.status != Status::ok && !one.known) one.failure = run.failure();
  if (run.status != Status::ok || one.known) run.stay(run.begun());
}

}  // namespace tress::simulation
