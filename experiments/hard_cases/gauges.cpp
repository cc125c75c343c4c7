#include "experiments/hard_cases/gauges.h"

#include <algorithm>
#include <cmath>

#include "contract/input_error.h"
#include "experiments/numerics/drift_monitor.h"
#include "math/closest.h"
#include "models/effects/effect.h"
#include "models/strand/arc_lengths.h"

namespace tress::experiments::hard_cases {
namespace {

constexpr double never = StabilityBounds::none;
// The first of four Gauss points is at (1 - 0.8611)/2 of the interval.
constexpr double last_point = 0.0694;

/// The larger of two, or NaN.
double larger(double a, double b) { return b <= a ? a : b; }

class PenetrationGauge final : public Gauge {
 public:
  explicit PenetrationGauge(const Situation& s)
      : points_(*s.system->material_points()),
        x_(3 * static_cast<std::size_t>(points_.count())),
        effects_(s.effects),
        allowed_(allowed_depth(s.strand)) {}
  void see(double t, In q, In) override {
    points_.positions(t, q, x_);
    for (const auto& effect : effects_) {
      const std::optional<double> depth = effect->penetration(t, x_);
      if (depth) deepest_ = larger(deepest_, *depth);
    }
  }
  double measure() const override { return deepest_ / allowed_; }

 private:
  MaterialPoints& points_;
  std::vector<double> x_;
  const Effects effects_;
  double allowed_, deepest_ = 0;
};

class StretchGauge final : public Gauge {
 public:
  explicit StretchGauge(const Situation& s)
      : drift_(*s.system, s.start.q, s.start.v, never) {}
  void see(double t, In q, In v) override { static_cast<void>(drift_(t, q, v)); }
  /// Particles provide no lengths; their constraint violation measures stretch.
  double measure() const override {
    const double stretched = drift_.length_error();
    return std::isnan(stretched) ? drift_.g_max() : stretched;
  }

 private:
  DriftMonitor drift_;
};

class MomentumGauge final : public Gauge {
 public:
  explicit MomentumGauge(const Situation& s)
      : energetics_(*s.system->energetics()),
        points_(*s.system->material_points()),
        segments_(s.strand.segments),
        length_(s.length),
        x_(3 * static_cast<std::size_t>(points_.count())) {
    const Energy energy = energetics_.energy(0, s.start.q, s.start.v);
    energy_ = energy.total();
    kinetic_ = energy.kinetic;
    start_ = momentum(0, s.start.q, s.start.v);
  }
  void see(double t, In q, In v) override {
    const Motion now = momentum(t, q, v);
    const double gained = energetics_.energy(t, q, v).total() - energy_;
    const double spin = norm(start_.angular);
    growth_ = larger(growth_, larger(gained / kinetic_, norm(now.angular) / spin - 1));
    error_ = larger(error_, larger(norm(now.angular - start_.angular),
                                   norm(now.linear - start_.linear) * length_) /
                                spin);
  }
  double measure() const override { return growth_; }
  std::optional<double> error() const override { return error_; }

 private:
  struct Motion {
    Vec linear, angular;  // the latter about the centre of mass
  };

  /// Treats segments as straight.
  Motion momentum(double t, In q, In v) {
    const Momentum total = energetics_.momentum(t, q, v).value();
    points_.positions(t, q, x_);
    Vec moment;
    double volume = 0;
    for (std::size_t i = 0; i < segments_.size(); ++i) {
      const double part = segments_[i].section.area() * segments_[i].length;
      moment = moment + part / 2 * (load3(&x_[3 * i]) + load3(&x_[3 * i + 3]));
      volume += part;
    }
    const Vec p = load3(total.linear.data());
    return {p, load3(total.angular.data()) - cross(1 / volume * moment, p)};
  }

  Energetics& energetics_;
  MaterialPoints& points_;
  const std::vector<Segment>& segments_;
  double length_, energy_ = 0, kinetic_ = 0, growth_ = 0, error_ = 0;
  std::vector<double> x_;
  Motion start_;
};

class SagGauge final : public Gauge {
 public:
  SagGauge(const Situation& s, double allowed)
      : points_(*s.system->material_points()),
        allowed_(allowed),
        x_(3 * static_cast<std::size_t>(points_.count())) {}
  void see(double t, In q, In) override {
    points_.positions(t, q, x_);
    lowest_ = larger(lowest_, std::abs(x_[2] - x_.back()));
  }
  double measure() const override { return lowest_ / allowed_; }

 private:
  MaterialPoints& points_;
  double allowed_, lowest_ = 0;
  std::vector<double> x_;
};

/// |g| over its scale, of a system that has constraints.
class Violation {
 public:
  explicit Violation(System& system) : form_(*system.constraint_form()) {
    g_.resize(static_cast<std::size_t>(system.layout().constraints));
    typical_.resize(g_.size());
    form_.scale(typical_);
  }
  double at(double t, In q) {
    if (form_.value(t, q, g_) != Status::ok) return std::nan("");
    double largest = 0;
    for (std::size_t k = 0; k < g_.size(); ++k) {
      largest = larger(largest, std::abs(g_[k]) / typical_[k]);
    }
    return largest;
  }

 private:
  ConstraintForm& form_;
  std::vector<double> g_, typical_;
};

class ViolationGauge final : public Gauge {
 public:
  explicit ViolationGauge(const Situation& s) : violation_(*s.system) {}
  void see(double t, In q, In) override {
    largest_ = larger(largest_, violation_.at(t, q));
  }
  double measure() const override { return largest_; }

 private:
  Violation violation_;
  double largest_ = 0;
};

class RecoveryGauge final : public Gauge {
 public:
  RecoveryGauge(const Situation& s, double energy)
      : energetics_(*s.system->energetics()),
        violation_(*s.system),
        allowed_(energy),
        start_(energetics_.energy(0, s.start.q, s.start.v).total()) {}
  void see(double t, In q, In v) override {
    constexpr double recovered = 1e-3;
    left_ = larger(violation_.at(t, q) / recovered,
                   (energetics_.energy(t, q, v).total() - start_) / allowed_);
  }
  double measure() const override { return left_; }

 private:
  Energetics& energetics_;
  Violation violation_;
  double allowed_, start_, left_ = never;
};

}  // namespace

OverlapGauge::OverlapGauge(const Situation& s, double touch, double separation)
    : points_(*s.system->material_points()),
      touch_(touch),
      separation_(separation),
      nearest_(touch),
      arc_(models::arc_lengths(s.strand)),
      x_(3 * static_cast<std::size_t>(points_.count())) {}

void OverlapGauge::see(double t, In q, In) {
  points_.positions(t, q, x_);
  for (std::size_t i = 0; i < arc_.size(); ++i) {
    const Vec x = load3(&x_[3 * i]);
    for (std::size_t j = i + 1; j + 1 < arc_.size(); ++j) {
      if (arc_[j] - arc_[i] < separation_) continue;
      const StraightPiece piece(load3(&x_[3 * j]), load3(&x_[3 * j + 3]));
      const Vec gap = x - piece.at(piece.nearest(x));
      nearest_ = std::min(nearest_, norm(gap));
    }
  }
}

double allowed_depth(const Strand& strand) {
  const Segment& last = strand.segments.back();
  return last.section.a1 + last_point * last.length;
}
std::unique_ptr<Gauge> penetration_gauge(const Situation& s) {
  return std::make_unique<PenetrationGauge>(s);
}
std::unique_ptr<Gauge> stretch_gauge(const Situation& s) {
  return std::make_unique<StretchGauge>(s);
}
std::unique_ptr<Gauge> momentum_gauge(const Situation& s) {
  return std::make_unique<MomentumGauge>(s);
}
std::unique_ptr<Gauge> sag_gauge(const Situation& s, double allowed) {
  return std::make_unique<SagGauge>(s, allowed);
}
std::unique_ptr<Gauge> violation_gauge(const Situation& s) {
  return std::make_unique<ViolationGauge>(s);
}
std::unique_ptr<Gauge> recovery_gauge(const Situation& s, double energy) {
  return std::make_unique<RecoveryGauge>(s, energy);
}

}  // namespace tress::experiments::hard_cases
