#include "simulation/run/guard.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace tress::simulation {
namespace {

bool finite(In x) {
  return std::ranges::all_of(x, [](double entry) { return std::isfinite(entry); });
}

/// Twice the kinetic energy of all typical rates at once: r(a) - r(0) = M a.
double typical_energy(System& system, double t, In q) {
  const std::size_t n = q.size();
  std::vector<double> q_typ(n), v_typ(n), zero(n), with(n), without(n);
  system.scale(q_typ, v_typ);
  if (system.residual(t, q, zero, v_typ, with) != Status::ok ||
      system.residual(t, q, zero, zero, without) != Status::ok) {
    return std::numeric_limits<double>::infinity();
  }
  double sum = 0;
  for (std::size_t i = 0; i < n; ++i) sum += v_typ[i] * (with[i] - without[i]);
  return std::abs(sum);
}

}  // namespace

std::string Breach::message() const {
  return fmt::format("{} at t = {:.9g} s{}{}", what, t, where.empty() ? "" : ", ", where);
}

Guard::Guard(System& system, std::vector<GuardedStrand> strands, std::size_t first)
    : system_(system),
      energetics_(system.energetics()),
      points_(system.material_points()),
      strands_(std::move(strands)),
      first_(first),
      supports_(support_forces(system)),
      bodies_(driven_bodies(system)),
      natural_moves_(supports_ != nullptr && supports_->natural_moves()) {
  const auto count = points_ == nullptr ? 0 : static_cast<std::size_t>(points_->count());
  for (auto* list : {&x_, &u_, &tangent_, &load_}) list->resize(3 * count);
  for (int i = 0; i < static_cast<int>(count); ++i) {
    before_.push_back(points_->before(i));
  }
}

void Guard::start(double t, In q, In v) {
  breach_.reset();
  steps_ = 0;
  remember(t, q);
  natural_ = {};
  account_.start(t, {}, 0);
  if (energetics_ == nullptr) return;
  const Seen seen = look(t, q, v);
  meter_.start(seen.energy, sampled(seen.power, t, q));
  const EnergyMeasure begin = measure(t, q, v, seen);
  account_.start(t, begin, slack(t, q, v, begin));
}

/// Bodies drive the strands that drive them, and have an energy of their own: as much as
/// it may be, it is no slack of the strands.
Guard::Seen Guard::look(double t, In q, In v) {
  Seen seen{energetics_->energy(t, q, v), energetics_->power(t, q, v)};
  if (bodies_ == nullptr) return seen;
  const DrivenBodies::OfBodies bodies = bodies_->energy_of_bodies(t, q, v);
  seen.energy.kinetic -= bodies.kinetic;
  seen.energy.potential -= bodies.potential;
  seen.power -= bodies.rate;
  seen.to_bodies = bodies.from_strands;
  return seen;
}

double Guard::slack(double t, In q, In, const EnergyMeasure& begin) {
  if (strands_.empty()) {
    return EnergyAccount::share(begin.kinetic, 0) + typical_energy(system_, t, q);
  }
  double sum = 0, uniform = 0;
  std::size_t first = 0;
  for (const GuardedStrand& strand : strands_) {
    sum += strand.slack();
    const Points p = points_of(strand, first);
    for (const auto& effect : strand.effects) {
      if (strand.uniform(*effect)) uniform += effect->potential(t, p);
    }
    first += strand.rest.size();
  }
  return sum + EnergyAccount::share(begin.kinetic, begin.potential - uniform);
}

/// Keeps the state from which the next step begins.
void Guard::remember(double t, In q) {
  if (!natural_moves_) return;
  t_before_ = t;
  q_before_.assign(q.begin(), q.end());
}

/// Adds the work of natural strains since the last step, however short it was.
void Guard::gather_natural(double t, In q) {
  if (!natural_moves_ || t == t_before_ || !finite(q)) return;
  const NaturalWork step = supports_->natural_work(t_before_, q_before_, t, q);
  natural_.put_in += std::max({0.0, step.at_start, step.at_end});
  natural_.work += (step.at_start + step.at_end) / 2;
  natural_.uncertain += std::abs(step.at_end - step.at_start);
  remember(t, q);
}

/// The power without that of natural strains, whose work is gathered in every step.
double Guard::sampled(double power, double t, In q) {
  return natural_moves_ ? power - supports_->natural_power(t, q) : power;
}

bool Guard::operator()(double t, In q, In v) {
  gather_natural(t, q);
  if (++steps_ < guarded_every && t - account_.seen() < guarded_for) return true;
  return judge(t, q, v);
}

bool Guard::judge(double t, In q, In v) {
  steps_ = 0;
  if (!finite(q) || !finite(v)) {
    return broken(Breach::Kind::not_finite, "the state is not finite",
                  system_.not_finite(t, q, v), t);
  }
  if (stretched(t, q)) return false;
  if (energetics_ == nullptr) return true;
  gather_natural(t, q);
  const Seen seen = look(t, q, v);
  meter_.gather(t - account_.seen(), seen.energy, sampled(seen.power, t, q),
                natural_.work, natural_.uncertain);
  EnergyMeasure now = measure(t, q, v, seen);
  now.work = natural_.put_in;
  natural_ = {};
  account_.gather(t, now);
  judged_ = now;
  return !gained(t, now) && !too_fast(t);
}

void Guard::teleported(double t, In q, In v) {
  remember(t, q);
  if (energetics_ == nullptr) return;
  const Seen seen = look(t, q, v);
  meter_.shift(seen.energy, sampled(seen.power, t, q));
  account_.shift(t, judged_, measure(t, q, v, seen));
}

EnergyMeasure Guard::measure(double t, In q, In v, const Seen& seen) {
  EnergyMeasure now{.kinetic = seen.energy.kinetic, .potential = seen.energy.potential};
  if (points_ != nullptr) {
    points_->positions(t, q, x_);
    points_->velocities(t, q, v, u_);
  }
  now.power = strands_.empty() ? seen.power : -seen.to_bodies;
  std::size_t first = 0;
  for (const GuardedStrand& strand : strands_) {
    const Points p = points_of(strand, first);
    for (const auto& effect : strand.effects) {
      now.power += effect->power(t, p);
      now.touch(*effect, t, p.x, std::ranges::max(strand.rest), strand.mass);
    }
    if (strand.root) move_with(t, strand, p, first, now);
    first += strand.rest.size();
  }
  if (supports_ != nullptr) now.power += power_of(t, q, v);
  return now;
}

/// Power of supports and moments in the clamp's frame, in which supports at rest in space
/// move.
double Guard::power_of(double t, In q, In v) {
  const std::size_t numbers = 3 * supports_->supports();
  std::vector<double> forces(numbers), moments(numbers), x(numbers), u(numbers),
      omega(numbers);
  if (supports_->support_forces(t, q, v, forces, moments) != Status::ok) return 0;
  supports_->support_motion(t, x, u, omega);
  const auto& clamp = strands_.front().root;
  double power = supports_->moment_power(t, q, v, clamp ? clamp->at(t).omega : Vec{});
  for (std::size_t i = 0; i < numbers; i += 3) {
    Vec velocity = load3(&u[i]), turning = load3(&omega[i]);
    if (clamp) {
      const RootPose pose = clamp->at(t);
      velocity = velocity - pose.v - cross(pose.omega, load3(&x[i]) - pose.x);
      turning = turning - pose.omega;
    }
    power += dot(load3(&forces[i]), velocity) + dot(load3(&moments[i]), turning);
  }
  return power;
}

/// Tangents along the mean of the chords that meet at a point.
Points Guard::points_of(const GuardedStrand& strand, std::size_t first) {
  const std::size_t count = strand.rest.size();
  std::fill_n(&tangent_[3 * first], 3 * count, 0.0);
  for (std::size_t i = first + 1; i < first + count; ++i) {
    const auto from = static_cast<std::size_t>(before_[i]);
    const Vec chord = load3(&x_[3 * i]) - load3(&x_[3 * from]);
    for (const std::size_t at : {from, i}) {
      store3(load3(&tangent_[3 * at]) + (1 / norm(chord)) * chord, &tangent_[3 * at]);
    }
  }
  for (std::size_t i = first; i < first + count; ++i) {
    const Vec sum = load3(&tangent_[3 * i]);
    // Of a hairpin's two chords nothing is left.
    if (const double size = norm(sum); size > 0)
      store3((1 / size) * sum, &tangent_[3 * i]);
  }
  const auto part = [&](const std::vector<double>& all) {
    return In(all).subspan(3 * first, 3 * count);
  };
  return strand.lumps.points(part(x_), part(u_), part(tangent_));
}

/// Transforms from the world's frame to the clamp's; leaves the relative velocities in
/// u_.
void Guard::move_with(double t, const GuardedStrand& strand, const Points& p,
                      std::size_t first, EnergyMeasure& now) {
  const Out load = Out(load_).first(3 * strand.rest.size());
  std::ranges::fill(load, 0.0);
  for (const auto& effect : strand.effects) effect->add_load(t, p, load);
  now.move_with(strand.root->at(t), p, load,
                Out(u_).subspan(3 * first, 3 * strand.rest.size()));
}

/// Comparisons are written so that NaN violates a bound.
bool Guard::stretched(double t, In q) {
  const auto most = points_ != nullptr ? points_->stretch(t, q) : std::nullopt;
  if (!most || *most <= most_stretch) return false;
  points_->positions(t, q, x_);
  std::size_t worst = 0, first = 0;
  double ratio = 0;
  for (const GuardedStrand& strand : strands_) {
    for (std::size_t i = 1; i < strand.rest.size(); ++i) {
      const auto from = static_cast<std::size_t>(before_[first + i]);
      const double chord = norm(load3(&x_[3 * (first + i)]) - load3(&x_[3 * from]));
      const double off = std::abs(chord / strand.rest[i] - 1);
      if (off <= ratio) continue;
      ratio = off;
      worst = first + i;
    }
    first += strand.rest.size();
  }
  broken(
      Breach::Kind::stretch,
      fmt::format("unstable: a segment is off its length by {:.3g} of it (at most {:g})",
                  *most, most_stretch),
      worst > 0 ? place(worst, "element") : "", t);
  return true;
}

bool Guard::gained(double t, const EnergyMeasure& now) {
  const double gain = account_.gain(now), allowed = account_.allowed();
  if (gain <= allowed) return false;
  broken(Breach::Kind::energy,
         fmt::format(
             "unstable: {:.3g} J more energy than at the start, at most {:.3g} J are "
             "allowed (the sum of m g L, a tenth of the initial energy, and 1.1 times "
             "the work done)",
             gain, allowed),
         fastest(), t);
  return true;
}

bool Guard::too_fast(double t) {
  std::size_t i = 0;
  for (const GuardedStrand& strand : strands_) {
    const double bound = account_.fastest(strand.mass);
    for (const std::size_t end = i + strand.rest.size(); i < end; ++i) {
      const double speed = norm(load3(&u_[3 * i]));
      if (speed <= bound) continue;
      broken(Breach::Kind::speed,
             fmt::format("unstable: a point moves at {:.3g} m/s (at most {:.3g})", speed,
                         bound),
             place(i, "point"), t);
      return true;
    }
  }
  return false;
}

std::string Guard::fastest() const {
  if (strands_.empty()) return {};
  std::size_t most = 0;
  const auto speed = [&](std::size_t i) { return norm(load3(&u_[3 * i])); };
  for (std::size_t i = 1; 3 * i < u_.size(); ++i) {
    if (speed(i) > speed(most)) most = i;
  }
  return place(most, "point") + " the fastest";
}

/// Elements and points of a strand are counted from 0; element k ends at point k + 1.
std::string Guard::place(std::size_t point, std::string_view what) const {
  std::size_t strand = 0;
  while (point >= strands_[strand].rest.size()) point -= strands_[strand++].rest.size();
  return fmt::format("strand {}, {} {}", first_ + strand, what,
                     what == "element" ? point - 1 : point);
}

bool Guard::broken(Breach::Kind kind, std::string what, std::string where, double t) {
  breach_ = Breach{kind, std::move(what), std::move(where), t};
  return false;
}

/// Of mechanisms, which have no length, `moved` is infinite.
MethodDissipation Guard::dissipation() const {
  double mass = 0, length = std::numeric_limits<double>::infinity();
  for (const GuardedStrand& strand : strands_) {
    mass += strand.mass;
    length =
        std::min(length, std::accumulate(strand.rest.begin(), strand.rest.end(), 0.0));
  }
  return meter_.dissipation(strands_.empty() ? 0 : std::sqrt(mass) * length);
}

Guard::Memory Guard::memory() const {
  Memory all{};
  const auto account = account_.memory();
  const auto dissipation = meter_.memory();
  const auto rest =
      std::ranges::copy(dissipation, std::ranges::copy(account, all.begin()).out).out;
  std::ranges::copy(std::array{natural_.put_in, natural_.work, natural_.uncertain}, rest);
  return all;
}

void Guard::recall(In memory, double t, In q) {
  account_.recall(memory.first(EnergyAccount::remembered));
  meter_.recall(memory.subspan(EnergyAccount::remembered));
  const In natural = memory.last(3);
  natural_ = {natural[0], natural[1], natural[2]};
  remember(t, q);
  steps_ = 0;
  breach_.reset();
}

}  // namespace tress::simulation
