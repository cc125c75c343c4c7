#pragma once

#include "models/maximal/edge_reference.h"
#include "models/splines/spline_elasticity.h"
#include "models/splines/spline_strain.h"

namespace tress::models {

/// Stretching, bending and twisting of a cubic spline with material frames at its knots
/// (dynamic_spline.cpp), coordinates z = (control points, theta at the knots). If
/// `clamped`, the first knot has the clamp's frame and no angle.
class FramedSpline final : public Elasticity, private NaturalStrains {
 public:
  /// Strains of a span.
  struct Span {
    /// Quadrature point of a span.
    struct Point {
      std::array<double, 4> first, second;  // derivatives of the controls' weights
      SplineBend bend;                      // bending at the point
    };
    std::array<double, 4> start, end;  // first derivatives at the knots
    SplineTwist twist;                 // twist of the span
    std::array<Point, 2> points;       // quadrature points
  };
  /// Control points (3 each) and frames at the knots, e0 along r'.
  struct Shape {
    std::vector<double> controls;  // control points, m
    std::vector<Frame> frames;     // frames at the knots
  };
  /// Sets `rest` of the strains to their values in the natural shape; the first
  /// references are the frames of the initial shape.
  FramedSpline(std::vector<Span> spans, std::vector<SplineElasticity::Point> stretching,
               const Shape& natural, std::vector<Frame> initial, bool clamped);
  FramedSpline(const FramedSpline&) = delete;  // spans point to the references
  FramedSpline& operator=(const FramedSpline&) = delete;

  std::vector<std::vector<int>> groups() const override;
  void add_force(const Placement& p, InOut f) noexcept override;
  void add_tangent(const Placement& p, double pos, double vel,
                   GroupSum& s) noexcept override;
  double energy(const Placement& p) noexcept override;
  double power(const Placement& p) noexcept override;
  double stretch(const Placement& p) noexcept override { return stretching_.stretch(p); }
  Vec spin(const Placement& p, In inertia) noexcept override;
  std::optional<Frame> end_frame(const Placement& p) noexcept override;
  std::optional<EndTurn> end_turn(bool tip) const override {
    const std::size_t knot = tip ? spans_.size() : 0;
    if (held(knot)) return {};
    return EndTurn{static_cast<int>(angle(knot)), references_[knot]};
  }
  bool rebase(const RootPose& root, InOut z, InOut rate) override;
  void carry(InOut z, InOut rate, InOut second) const override;
  void displace(const Displacement& by, InOut z, InOut rate) override;
  void reset() override;
  std::vector<double> memory() const override;
  /// Restores what keep() wrote.
  void recall(In memory) override;
  NaturalStrains* natural_strains() override { return this; }
  bool takes_stresses() const override { return stretching_.takes_stresses(); }

 private:
  // Of the twist of each span, then of the bending at its points; lengths at rest, of
  // stretching, are those of the natural shape.
  std::vector<double> natural() const override;
  void set_natural(In values) override;
  std::vector<double> natural_stiffness() const override;
  /// see(value at rest, stiffness) for all of them, in order.
  template <class Self, class See>
  static void each_strain(Self& self, See see) {
    for (auto& span : self.spans_) {
      see(span.twist.rest[0], span.twist.stiffness[0]);
      for (auto& point : span.points) {
        for (int k = 0; k < 2; ++k) see(point.bend.rest[k], point.bend.stiffness[k]);
      }
    }
  }

  static constexpr std::size_t most = 14;  // coordinates of a span, and of SplineBend
  /// Coordinates of the strains of a span, and their rates.
  struct Local {
    double x[most], rate[most];
  };
  using Square = double[most][most];

  std::size_t first_angle() const { return clamped_ ? 1 : 0; }  // knot
  bool held(std::size_t knot) const { return knot < first_angle(); }
  std::size_t angle(std::size_t knot) const {
    return 3 * (spans_.size() + 3) + knot - first_angle();
  }
  /// r' at a knot, or its rate.
  Vec direction(In z, std::size_t knot) const {
    const std::size_t span = knot > 0 ? knot - 1 : 0;
    return of_controls(knot > 0 ? spans_[span].end : spans_[span].start, &z[3 * span]);
  }
  std::size_t size(std::size_t span) const { return held(span) ? most - 1 : most; }
  /// Values at a span's knots, those of the clamp for a held knot.
  void at_knots(const Placement& p, std::size_t span, Local& local) const noexcept;
  static void at_point(const Placement& p, std::size_t span, const Span::Point& point,
                       Local& local) noexcept;
  static void pull_back(const Span& span, const Span::Point& point, const Square& h,
                        std::size_t size, double* sum) noexcept;

  std::vector<Span> spans_;
  SplineElasticity stretching_;
  std::vector<Frame> references_at_start_, references_;  // per knot; held: the clamp's
  std::vector<Replaced> replaced_;                       // by knot
  bool clamped_;
};

}  // namespace tress::models
