#include "integrators/gradient/recorded_run.h"

#include <algorithm>
#include <cmath>

#include "integrators/catalogue.h"
#include "integrators/gradient/run_phases.h"

namespace tress::integrators {
namespace {

using Kind = StepTable::Operation::Kind;

/// Steps that divide a span equally differ by rounding.
bool nearly_equal(const std::vector<double>& x, const std::vector<double>& y) {
  constexpr double rounding = 1e-10;
  return std::ranges::equal(
      x, y, [](double a, double b) { return std::abs(a - b) <= rounding * std::abs(b); });
}

}  // namespace

void Tape::clear() {
  steps_.clear();
  numbers_.clear();
}

void Tape::add(std::shared_ptr<const StepTable> table,
               std::span<const Motion* const> motions, In memory_before,
               In memory_after) {
  Step step{std::move(table), numbers_.size(), 0};
  for (const Motion* motion : motions) {
    numbers_.push_back(motion->t);
    for (const auto* x : {&motion->q, &motion->v, &motion->a, &motion->lambda}) {
      numbers_.insert(numbers_.end(), x->begin(), x->end());
    }
  }
  while (step.common < memory_before.size() &&
         memory_before[step.common] == memory_after[step.common]) {
    ++step.common;
  }
  const In lost = memory_before.subspan(step.common);
  numbers_.insert(numbers_.end(), lost.begin(), lost.end());
  steps_.push_back(std::move(step));
}

void Tape::read(const Step& step, std::size_t operation, Motion& motion) const {
  const std::size_t length = 1 + 3 * motion.q.size() + motion.lambda.size();
  const double* from = &numbers_[step.at + operation * length];
  motion.t = *from++;
  for (auto* x : {&motion.q, &motion.v, &motion.a, &motion.lambda}) {
    std::copy_n(from, x->size(), x->begin());
    from += x->size();
  }
}

void Tape::step_back(const Step& step, std::vector<double>& memory) const {
  const std::size_t next = &step == &steps_.back() ? numbers_.size() : (&step + 1)->at;
  const std::size_t lost = memory.size() - step.common;
  std::copy_n(numbers_.begin() + static_cast<std::ptrdiff_t>(next - lost), lost,
              memory.begin() + static_cast<std::ptrdiff_t>(step.common));
}

RecordedRun::RecordedRun(System& system, const GradientRun::Method& method)
    : system_(system), watched_(system) {
  const auto part = [this](std::string_view id, const Options& options) {
    return Part{make_integrator(id, watched_, options),
                std::make_unique<StepProbe>(id, options)};
  };
  parts_[0] = part(DampedStart::method, DampedStart::options(method.options));
  parts_[1] = part(method.id, method.options);
}

Status RecordedRun::begin(std::size_t method, double t, In q, In v, Tape& tape) {
  method_ = method;
  const Part& part = parts_[method_];
  memory_ = system_.memory();
  watched_.forget();
  const Status s = part.run->start(t, q, v);
  if (s != Status::ok) return s;
  table_ = std::make_shared<const StepTable>(part.probe->start(t));
  key_.clear();
  write(tape);
  return Status::ok;
}

Status RecordedRun::advance(double t_end, Tape& tape,
                            const std::function<void(double t)>& each_step) {
  double from = time();
  return parts_[method_].run->advance(t_end, [&](double t, In, In) {
    write_step(from, t, tape);
    from = t;
    each_step(t);
    return true;
  });
}

/// Where frames moved the table is that of this step alone.
void RecordedRun::write_step(double from, double to, Tape& tape) {
  StepProbe& probe = *parts_[method_].probe;
  std::vector<double> key = numbers_;
  key.push_back(to - from);
  const bool moved = watched_.moved();
  if (moved || !nearly_equal(key, key_)) {
    probe.go_to(from, numbers_);
    table_ = std::make_shared<const StepTable>(probe.step(to, watched_));
  }
  key_ = moved ? std::vector<double>{} : std::move(key);
  write(tape);
}

/// The last step or start, with table_.
void RecordedRun::write(Tape& tape) {
  WatchedSystem::Motion end{
      time(), {q().begin(), q().end()}, {v().begin(), v().end()}, {}, {}};
  end.a.resize(end.q.size());
  end.lambda.resize(static_cast<std::size_t>(watched_.layout().constraints));
  std::vector<const WatchedSystem::Motion*> motions;
  WatchedSystem::Motion accepted = end;
  if (watched_.moved()) {
    accepted.t = watched_.accepted().t;
    accepted.q = watched_.accepted().q;
    accepted.v = watched_.accepted().v;
  }
  std::vector<WatchedSystem::Motion> carried;
  for (const auto& one : watched_.carried()) {
    carried.push_back(one);
    carried.back().lambda = end.lambda;
  }
  std::size_t stage = 0, carry = 0;
  for (const auto& operation : table_->operations) {
    motions.push_back(operation.kind == Kind::stage    ? &watched_.stages()[stage++]
                      : operation.kind == Kind::accept ? &accepted
                      : operation.kind == Kind::carry  ? &carried[carry++]
                                                       : &end);
  }
  const std::vector<double> memory = system_.memory();
  tape.add(table_, motions, memory_, memory);
  memory_ = memory;
  numbers_ = numbers();
  watched_.forget();
}

std::vector<double> RecordedRun::numbers() const {
  std::vector<double> all;
  for (const double* x : fixed().numbers()) all.push_back(*x);
  return all;
}

RecordedRun::Place RecordedRun::place() const {
  Place place{method_, time(), {}, memory_};
  for (const InOut x : fixed().state()) {
    place.state.insert(place.state.end(), x.begin(), x.end());
  }
  for (const double* x : fixed().numbers()) place.state.push_back(*x);
  return place;
}

Status RecordedRun::go_to(const Place& place) {
  method_ = place.method;
  const Part& part = parts_[method_];
  system_.recall(place.memory);
  memory_ = place.memory;
  const std::size_t n = static_cast<std::size_t>(watched_.layout().coordinates);
  const Status s =
      part.run->start(place.t, In(place.state).first(n), In(place.state).subspan(n, n));
  auto from = place.state.begin();
  for (const InOut x : fixed().state()) {
    std::copy_n(from, x.size(), x.begin());
    from += static_cast<std::ptrdiff_t>(x.size());
  }
  for (double* x : fixed().numbers()) *x = *from++;
  numbers_ = numbers();
  key_.clear();
  watched_.forget();
  return s;
}

}  // namespace tress::integrators
