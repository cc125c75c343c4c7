#pragma once

#include <array>
#include <vector>

#include "contract/parameters.h"
#include "models/effects/effect.h"
#include "models/motion/root_motion.h"

namespace tress::models {

/// Returns the parameters of the effect.
std::span<const Parameter> ring_parameters();

/// An elastic ring of no width through which the strand slides without friction. Its
/// place is X(t). Between its points the strand is x(s), a polynomial through four of
/// them. The place that is closest to the ring has the arc length s*. With
///
///     d = x(s*) - X,   f = -k d - c P (u - X'),   E = k |d|^2/2,
///
/// with P the projection across the tangent and u the velocity of the material at s*. The
/// force is across the strand, because d.x'(s*) = 0: nothing holds the material along it.
/// Point j bears w_j(s*) f. The tangent is exact: the derivative of s* by the places of
/// the points is part of it. An end that comes into the ring stays there, as with a knot.
/// The polynomials of neighbouring intervals meet at the point between them with tangents
/// that differ a little. On the outer side of a bend, s* therefore stays at that point
/// for some while. On the inner side, s* and the load jump by a little. O(points).
class Ring final : public Effect {
 public:
  /// Parameters of the ring.
  struct Settings {
    double stiffness = 0;  // k, N/m
    double damping = 0;    // c, N s/m
    RootMotion path{};     // X
  };
  /// Throws InputError on a stiffness that is not above 0, and on a negative damping.
  explicit Ring(Settings settings);

  std::string_view name() const override { return "ring"; }
  Needs needs() const override {
    return {.position = true,
            .velocity = s_.damping > 0,
            .derivatives = true,
            .couplings = true};
  }
  void add_load(double t, const Points& p, InOut f) const noexcept override;
  void add_derivatives(double t, const Points& p, double pos, double vel,
                       InOut blocks) const noexcept override;
  void add_couplings(double t, const Points& p,
                     std::vector<Coupling>& all) const override;
  double potential(double t, const Points& p) const noexcept override;
  double power(double t, const Points& p) const noexcept override;
  double next_breakpoint(double t) const noexcept override {
    return s_.path.next_breakpoint(t);
  }

  /// The place of the strand in the ring.
  struct Inside {
    std::size_t first = 0, count = 0;         // points that determine it
    std::array<double, 4> weight{}, slope{};  // w_j and their derivatives by s
    double s = 0;                             // s*, m
    Vec d;                                    // m
    Vec tangent;                              // x'(s*)
    Vec second;                               // x''(s*), 1/m
    double curvature = 0;                     // d.x''(s*)
    bool at_end = false;                      // whether s* is an end of the strand
    bool at_point = false;                    // whether s* stays at a point between two
  };
  /// Finds the place.
  Inside inside(double t, const Points& p) const noexcept;

 private:
  Inside at(double s, std::size_t interval, const Vec& ring,
            const Points& p) const noexcept;
  Vec relative(double t, const Points& p, const Inside& in) const noexcept;
  Vec slip(double t, const Points& p, const Inside& in) const noexcept;
  Vec force(double t, const Points& p, const Inside& in) const noexcept;
  Coupling coupling(double t, const Points& p, const Inside& in) const noexcept;

  Settings s_;
};

/// Makes the effect.
std::unique_ptr<const Effect> make_ring(const Parameters& parameters,
                                        const RootMotion& head);

}  // namespace tress::models
