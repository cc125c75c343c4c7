#pragma once

#include "contract/forms/material_points.h"
#include "experiments/hard_cases/hard_case.h"

/// The measures of the cases. Each reads the situation's system, which must outlive it.
namespace tress::experiments::hard_cases {

/// Returns the depth (m) of a strand's surface in a Body that a correct simulator may
/// have. It is the radius, since contact keeps the axis outside, and 0.07 of the last
/// element's length. The tip is that far beyond the last of four Gauss points, where
/// bodies can hold a strand that hits them head-on.
double allowed_depth(const Strand& strand);

/// Largest depth of a material point in a Body among the effects, over allowed_depth().
std::unique_ptr<Gauge> penetration_gauge(const Situation& situation);

/// Largest overlap of parts of the strand farther apart along it than `separation`, over
/// half of the distance at which they begin to touch. At 1 the axis of one part lies on
/// the surface of the other, each as thick as half that distance.
class OverlapGauge final : public Gauge {
 public:
  OverlapGauge(const Situation& situation, double touch, double separation);
  void see(double t, In q, In v) override;
  double measure() const override { return 2 * (1 - nearest_ / touch_); }

 private:
  MaterialPoints& points_;
  double touch_, separation_;
  double nearest_;
  std::vector<double> arc_, x_;
};

/// Largest relative change of an element's length.
std::unique_ptr<Gauge> stretch_gauge(const Situation& situation);

/// Makes a gauge of the growth of the energy and of the angular momentum of a free strand
/// about its centre of mass, relative to the start, the larger one. Its error is the
/// largest change of that angular momentum, and of the linear one times the length, over
/// the initial angular momentum.
std::unique_ptr<Gauge> momentum_gauge(const Situation& situation);

/// Largest depth of the tip below its root, over `allowed` (m).
std::unique_ptr<Gauge> sag_gauge(const Situation& situation, double allowed);

/// Largest |g| over its scale.
std::unique_ptr<Gauge> violation_gauge(const Situation& situation);

/// Measures how incomplete a recovery is at the end: the larger of |g| over a
/// thousandth of its scale and of the energy gained since the start over `energy` (J).
std::unique_ptr<Gauge> recovery_gauge(const Situation& situation, double energy);

}  // namespace tress::experiments::hard_cases
