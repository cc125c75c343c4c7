#include "simulation/head/lane_guard.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "math/gauss_legendre.h"
#include "models/head/strain_entries.h"
#include "models/reduced/helix.h"
#include "simulation/head/clothoid_points.h"
#include "simulation/head/no_head.h"
#include "simulation/run/guarded_strand.h"
#include "simulation/scene/strand_tables.h"

namespace tress::simulation {
namespace {

using models::Effect;
using models::HeadEnergy;

constexpr int smooth_every = 10;      // steps
constexpr double smooth_for = 20e-3;  // s

}  // namespace

/// Strands of a block at one time, with the points on which effects act.
class LaneGuard::Reader {
 public:
  Reader(const LaneGuard& guard, const models::Head& head, std::size_t block,
         std::size_t first, double t)
      : guard_(guard),
        head_(head),
        first_(first),
        t_(t),
        numbers_(head.numbers()),
        each_(head.strands_of(block)),
        pose_(guard.motion_.at(t)) {
    head.energies(block, t, each_);
    if (!sees_points()) return;
    ends_.resize(numbers_ * each_.size());
    rates_.resize(ends_.size());
    if (guard.curved()) {
      darboux_.resize((guard.clothoids_ ? 6 : 3) * guard.elements_);
      darboux_rates_.resize(darboux_.size());
      if (guard.clothoids_) clothoid_.emplace(guard.at_, guard.weight_);
    }
    head.motion(block, t, ends_, rates_);
    const std::size_t count =
        guard.at_.empty() ? numbers_ / 3 : guard.at_.size() * guard.elements_;
    for (auto* list : {&x_, &v_, &tangent_, &load_, &u_}) list->resize(3 * count);
    for (auto* list : {&mass_, &length_, &arc_}) list->resize(count);
  }

  std::size_t strands() const { return each_.size(); }
  const HeadEnergy& energy(std::size_t k) const { return each_[k]; }

  /// Strand k of the block is the one that the others tell of.
  void take(std::size_t k) {
    k_ = k;
    if (!sees_points()) return;
    const double length = strand().length, density = each_[k].mass / whole_length();
    if (guard_.at_.empty()) {
      put_nodes(length);
    } else if (guard_.curved()) {
      head_.state(first_ + k, darboux_, darboux_rates_);
      if (guard_.clothoids_) {
        put_points_of_clothoids(length);
      } else {
        put_points_of_helices(length);
      }
    } else {
      put_points_of_chords(length);
    }
    for (std::size_t i = 0; i < mass_.size(); ++i) mass_[i] = density * length_[i];
  }
  double potential(const Effect& effect) const {
    return effect.uniform_acceleration() || !reaches(effect)
               ? 0
               : effect.potential(t_, points());
  }
  /// Of its energy at the start, the part that is neither motion's nor a uniform load's.
  double elastic() const {
    double sum = each_[k_].elastic;
    if (!sees_points()) return sum;
    each_effect([&](const Effect& effect) {
      if (effect.needs().position) sum += potential(effect);
    });
    return sum;
  }
  /// Energies and power of all effects.
  EnergyMeasure measure() {
    const HeadEnergy& one = each_[k_];
    EnergyMeasure now{.kinetic = one.kinetic, .potential = one.elastic + one.gravity};
    if (!sees_points()) return now;
    each_effect([&](const Effect& effect) {
      now.potential += potential(effect);
      if (!guard_.works_) return;
      now.power += effect.power(t_, points());
      now.touch(effect, t_, points().x, strand().length, one.mass);
    });
    if (!guard_.moves_) return now;
    std::ranges::fill(load_, 0.0);
    each_effect([&](const Effect& effect) { effect.add_load(t_, points(), load_); });
    now.move_with(pose_, points(), load_, u_);
    return now;
  }
  /// m/s, of the root and the ends of elements, seen from the head.
  double fastest() const {
    if (!guard_.moves_) return each_[k_].fastest;
    double most = 0;
    for (std::size_t i = 0; i <= guard_.elements_; ++i) {
      const double speed = norm(rate(i) - pose_.v - cross(pose_.omega, end(i) - pose_.x));
      if (!(speed <= most)) most = speed;
    }
    return most;
  }
  /// Largest |chord/length - 1| of an element.
  double stretch() const {
    double most = 0;
    for (std::size_t i = 0; i < guard_.elements_; ++i) {
      const double off = std::abs(norm(end(i + 1) - end(i)) / strand().length - 1);
      if (!(off <= most)) most = off;
    }
    return most;
  }

 private:
  /// Without work and effects of places nothing but energies counts.
  bool sees_points() const {
    return guard_.works_ || guard_.stretches_ || guard_.acts_somewhere_;
  }
  const OfStrand& strand() const { return guard_.strands_[first_ + k_]; }
  double whole_length() const {
    return static_cast<double>(guard_.elements_) * strand().length;
  }
  Vec end(std::size_t i) const { return load3(&ends_[numbers_ * k_ + 3 * i]); }
  Vec rate(std::size_t i) const { return load3(&rates_[numbers_ * k_ + 3 * i]); }
  void put_nodes(double length) {
    for (std::size_t i = 0; i < guard_.elements_; ++i) {
      const Vec chord = end(i + 1) - end(i), along = (1 / norm(chord)) * chord;
      if (i == 0) put(0, end(0), rate(0), along, length / 2);
      put(i + 1, end(i + 1), rate(i + 1), along,
          i + 1 < guard_.elements_ ? length : length / 2);
    }
  }
  void put_points_of_chords(double length) {
    const std::size_t points = guard_.at_.size();
    for (std::size_t i = 0; i < guard_.elements_; ++i) {
      const Vec chord = end(i + 1) - end(i), along = (1 / norm(chord)) * chord;
      for (std::size_t j = 0; j < points; ++j) {
        const double s = guard_.at_[j];
        put(points * i + j, end(i) + s * chord, rate(i) + s * (rate(i + 1) - rate(i)),
            along, guard_.weight_[j] * length);
      }
    }
  }
  /// From the Darboux vectors of the elements and their rates.
  void put_points_of_helices(double length) {
    const std::size_t points = guard_.at_.size();
    Frame frame = pose_.frame * guard_.frames_[first_ + k_];
    Vec omega = pose_.omega;
    for (std::size_t i = 0; i < guard_.elements_; ++i) {
      const Vec turning = load3(&darboux_rates_[3 * i]);
      const models::Helix helix(load3(&darboux_[3 * i]), length);
      const auto position = helix.position();
      const auto velocity = helix.first(turning);
      for (std::size_t j = 0; j < points; ++j) {
        const auto at = helix.point(guard_.at_[j] * length);
        const Vec from_start = frame * position.at(at);
        put(points * i + j, end(i) + from_start,
            rate(i) + cross(omega, from_start) + frame * velocity.at(at),
            frame * helix.rotated(at, models::Helix::tangent),
            guard_.weight_[j] * length);
      }
      const auto tip = helix.tip();
      omega = omega + frame * helix.W(turning).at(tip);
      frame = frame * helix.rotation(tip);
    }
  }
  /// The same of linear Darboux vectors.
  void put_points_of_clothoids(double length) {
    const std::size_t points = clothoid_->count();
    Frame frame = pose_.frame * guard_.frames_[first_ + k_];
    Vec omega = pose_.omega;
    for (std::size_t i = 0; i < guard_.elements_; ++i) {
      using models::LinearStrain;
      clothoid_->place(models::entries<LinearStrain>(&darboux_[6 * i]),
                       models::entries<LinearStrain>(&darboux_rates_[6 * i]), length);
      for (std::size_t j = 0; j < points; ++j) {
        const ClothoidPoints::Point at = clothoid_->point(j);
        const Vec from_start = frame * at.position;
        put(points * i + j, end(i) + from_start,
            rate(i) + cross(omega, from_start) + frame * at.velocity, frame * at.tangent,
            guard_.weight_[j] * length);
      }
      omega = omega + frame * clothoid_->turning();
      frame = frame * clothoid_->rotation();
    }
  }
  void put(std::size_t i, const Vec& x, const Vec& v, const Vec& tangent, double length) {
    store3(x, &x_[3 * i]);
    store3(v, &v_[3 * i]);
    store3(tangent, &tangent_[3 * i]);
    length_[i] = length;
    const std::size_t n = guard_.at_.size();
    const double place =
        n == 0 ? static_cast<double>(i) : static_cast<double>(i / n) + guard_.at_[i % n];
    arc_[i] = place * strand().length;
  }
  Points points() const {
    Points p{static_cast<int>(mass_.size()), x_, v_, tangent_, mass_, length_};
    p.arc = arc_;
    p.longest = whole_length();
    return p;
  }
  bool reaches(const Effect& effect) const {
    const double longest = (guard_.stretches_ ? 1 + most_stretch : 1) * whole_length();
    return effect.reaches(t_, {end(0), longest});
  }
  template <class Use>
  void each_effect(Use use) const {
    const auto ask = [&](const models::Effects& effects) {
      for (const auto& effect : effects) {
        if (reaches(*effect)) use(*effect);
      }
    };
    ask(guard_.effects_);
    if (!guard_.own_.empty()) ask(guard_.own_[first_ + k_]);
  }

  const LaneGuard& guard_;
  const models::Head& head_;
  std::size_t first_, k_ = 0;
  double t_;
  std::size_t numbers_;
  std::vector<HeadEnergy> each_;
  RootPose pose_;
  std::vector<double> ends_, rates_;                // as Head::motion()
  std::vector<double> darboux_, darboux_rates_;     // of helices, as Head::state()
  std::optional<ClothoidPoints> clothoid_;          // of elements of linear curvature
  std::vector<double> x_, v_, tangent_, load_, u_;  // (3 points)
  std::vector<double> mass_, length_, arc_;         // (points)
};

LaneGuard::LaneGuard(const Scene& scene, const HeadOptions& options, bool at_rest)
    : motion_(options.motion),
      effects_(make_effects(scene)),
      moves_(!options.motion.fixed()),
      works_(moves_ || !at_rest),
      at_rest_(at_rest),
      stretches_(steps_edges(scene)),
      acts_somewhere_(models::depend_on_place(effects_)),
      helices_(!stretches_ && !steps_chains(scene) && !steps_clothoids(scene)),
      clothoids_(steps_clothoids(scene)),
      elements_(static_cast<std::size_t>(options.elements)) {
  motion_.frame = {};
  for (const auto& effect : effects_) {
    if (!effect->uniform_acceleration()) placed_.push_back(effect.get());
  }
  if (stretches_ || (at_rest_ && !acts_somewhere_)) return;
  for (const QuadraturePoint& point : gauss_legendre(options.points, 1)) {
    at_.push_back(point.at);
    weight_.push_back(point.weight);
  }
}

void LaneGuard::add(const Strand& strand, models::Effects own) {
  const GuardedStrand guarded = guarded_strand(strand, effects_);
  strands_.push_back({strand.segments.front().length, guarded.slack(), {}, {}});
  if (curved()) frames_.push_back(strand.root.frame);
  if (own.empty() && own_.empty()) return;
  own_.resize(strands_.size());
  own_.back() = std::move(own);
}

void LaneGuard::potentials(const models::Head& head, std::size_t block, std::size_t first,
                           double t, std::span<double> each) const {
  std::ranges::fill(each, 0.0);
  if (!acts_somewhere_) return;
  Reader reader(*this, head, block, first, t);
  for (std::size_t k = 0; k < reader.strands(); ++k) {
    reader.take(k);
    for (std::size_t i = 0; i < placed_.size(); ++i) {
      each[placed_.size() * k + i] = reader.potential(*placed_[i]);
    }
  }
}

void LaneGuard::start(const models::Head& head, std::size_t block, std::size_t first,
                      double t) {
  Reader reader(*this, head, block, first, t);
  for (std::size_t k = 0; k < reader.strands(); ++k) {
    reader.take(k);
    OfStrand& strand = strands_[first + k];
    const EnergyMeasure now = reader.measure();
    strand.account.start(
        t, now, strand.slack + EnergyAccount::share(now.kinetic, reader.elastic()));
  }
}

bool LaneGuard::due(double t, double h) const {
  if (!works_ || strands_.empty()) return false;
  // Of steps that are equal but for rounding.
  const double since = t - strands_.front().account.seen() + 1e-6 * h;
  return at_rest_ && !acts_somewhere_ ? since >= std::min(smooth_every * h, smooth_for)
                                      : since >= std::min(guarded_every * h, guarded_for);
}

void LaneGuard::judge(const models::Head& head, std::size_t block, std::size_t first,
                      double t) {
  Reader reader(*this, head, block, first, t);
  for (std::size_t k = 0; k < reader.strands(); ++k) {
    OfStrand& strand = strands_[first + k];
    strand.verdict = {};
    reader.take(k);
    const EnergyMeasure now = reader.measure();
    strand.account.gather(t, now);
    // Comparisons are written so that NaN violates a bound.
    if (stretches_ && !(reader.stretch() <= most_stretch)) {
      strand.verdict = off_length;
    } else if (!(strand.account.gain(now) <= strand.account.allowed())) {
      strand.verdict = too_much_energy;
    } else if (!(reader.fastest() <= strand.account.fastest(reader.energy(k).mass))) {
      strand.verdict = too_fast;
    }
  }
}

void LaneGuard::keep(std::size_t place, std::span<double> to) const {
  std::ranges::copy(strands_[place].account.memory(), to.begin());
}
void LaneGuard::recall(std::size_t place, std::span<const double> from) {
  strands_[place].account.recall(from);
}

}  // namespace tress::simulation
