#pragma once

#include <memory>
#include <span>

#include "contract/parameters.h"
#include "models/contact/contact_law.h"
#include "models/coupling/piece_contact.h"
#include "models/effects/effect.h"
#include "models/motion/root_motion.h"

namespace tress::models {

/// Returns the parameters of the effect.
std::span<const Parameter> self_contact_parameters();

/// Self-contact of a strand, as in plectonemes. The polyline through the points that
/// carry length, in their order along an unbranched strand, repels and drags itself
/// (ContactLaw). Its samples are at most half the inner radius apart at rest. Each sample
/// interacts with half of its length, because the other side has samples too. Its
/// partners are the nearest point of the part that begins `separation` (m, along the arc
/// at rest) before it, and that of the part after it. Forces are distributed to the four
/// points about a contact and sum to zero (PieceContact). If two places are equally near,
/// as inside a corner of the polyline, the force jumps from one to the other. A coil of
/// 20 elements came to rest there, and implicit steps are solved on the jump
/// (integrators/stage/stage.h). The repulsion is in potential(). The search along the
/// strand takes strides too short to skip a contact: O(n) for n points without near
/// contacts, O(n^2) at worst.
class SelfContact final : public Effect {
 public:
  /// Throws InputError unless `separation` is finite and exceeds the law's reach: a
  /// straight strand would touch itself.
  SelfContact(const ContactLaw& law, double separation);

  std::string_view name() const override { return "self_contact"; }
  bool contact() const override { return true; }
  Needs needs() const override {
    return {.position = true, .velocity = true, .derivatives = true, .couplings = true};
  }
  void add_load(double t, const Points& p, InOut f) const noexcept override;
  void add_derivatives(double t, const Points& p, double pos, double vel,
                       InOut blocks) const noexcept override;
  void add_couplings(double t, const Points& p,
                     std::vector<Coupling>& all) const override;
  double potential(double t, const Points& p) const noexcept override;
  double power(double t, const Points& p) const noexcept override;

 private:
  /// Edge of the polyline from point i to point j, with the arc at rest.
  struct Edge {
    std::size_t i, j;
    double from, length;  // m
  };
  struct Place {
    std::size_t i, j;  // points of the edge
    double at;         // position on the edge
  };
  static Edge first_edge(const Points& p);
  static void go_on(const Points& p, Edge& edge);  // to the next edge
  template <class F>
  void each_contact(const Points& p, F of_contact) const noexcept;
  bool nearest(const Points& p, const Vec& x, std::size_t first, std::size_t last,
               double stride, Place& place) const noexcept;

  ContactLaw law_;
  double separation_;
};

/// Makes the effect.
std::unique_ptr<const Effect> make_self_contact(const Parameters& parameters,
                                                const RootMotion& head);

}  // namespace tress::models
