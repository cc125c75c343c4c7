#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "models/head/der_strand.h"
#include "models/head/stepping_head.h"
#include "models/maximal/joint_strain.h"
#include "models/maximal/nodal_strand.h"

namespace tress::models {
namespace {

/// DerStrand as a Model of models/head/stepping_head.h.
template <class Pack, bool exact>
class DerModel {
 public:
  using Real = Pack;
  using Kernel = DerStrand<Real, exact>;
  using V = Vec3<Real>;
  struct Strand {
    LaneRoot<Real> root;
    DerMaterial<Real> material;
  };
  using Element = DerEdge<Real>;
  using Clamp = DerClamp<Real>;
  struct Scratch {
    explicit Scratch(std::size_t edges) : placed(edges), now(edges), factors(edges) {}
    std::vector<typename Kernel::Placed> placed, now;
    std::vector<typename Kernel::Factor> factors;
  };

  DerModel(const HeadOptions& options, const HeadUnits& units, Instructions instructions)
      : instructions_(instructions),
        n_(static_cast<std::size_t>(options.elements)),
        drag_(options.drag),
        mass_damping_(options.mass_damping),
        turning_(options.rotary_inertia),
        kernel_(options.elements,
                V((units.time * units.time / units.length) * options.gravity)) {}

  std::size_t elements() const { return n_; }
  std::size_t unknowns() const { return Kernel::per_element * n_; }
  double unit(const HeadUnits& units, std::size_t k) const {
    return k % Kernel::per_element == 3 ? 1 : units.length;
  }

  /// In the state in which models/maximal/der.cpp starts.
  void describe(const models::Strand& strand, const Vec& centre, const HeadUnits& units,
                int lane, Strand& to, Element* elements, Real* q, Real* v) const {
    const Segment& first = strand.segments.front();
    const double l = units.length, tau = units.time, unit_mass = units.density * l;
    const double density = strand.material.density * first.section.area();
    set_lane(to.root.from, lane, (1 / l) * (strand.root.position - centre));
    set_lane(to.root.frame, lane, strand.root.frame);
    DerMaterial<Real>& m = to.material;
    set_lane(m.length, lane, first.length / l);
    set_lane(m.mass, lane, density * first.length / unit_mass);
    set_lane(m.drag, lane,
             (drag_ + mass_damping_ * density) * first.length * tau / unit_mass);
    set_lane(m.inertia, lane,
             turning_ ? strand.material.density * first.section.polar() * first.length /
                            (unit_mass * l * l)
                      : 0);
    set_lane(m.stretch, lane,
             strand.material.youngs_modulus * first.section.area() / first.length * tau *
                 tau / unit_mass);
    const double moment = units.stiffness() / l;
    set_lane(m.stiffness, lane,
             1 / (first.length * moment) * stiffness(strand.material, first.section));
    set_lane(m.friction, lane,
             strand.material.internal_friction / (first.length * moment * tau));
    set_lane(m.rate, lane, typical_rate(strand) * tau);
    const NodalStrand nodal(strand, "der", n_);
    const Vec spin = tau * nodal.root.spin;
    for (std::size_t i = 0; i < n_; ++i) {
      const Frame& before = i > 0 ? nodal.natural[i - 1] : nodal.root.place.frame;
      set_lane(elements[i].rest, lane, joint_strain(before, nodal.natural[i]));
      const Frame& frame = nodal.initial[i];
      set_lane(elements[i].tangent, lane, frame.e0);
      set_lane(elements[i].direction, lane, frame.e1);
      const Vec edge = first.length / l * frame.e0;
      Vec rate = cross(spin, edge);
      if (i == 0) rate = rate + (tau / l) * nodal.root.velocity;
      const double of_q[] = {edge.x, edge.y, edge.z, 0};
      const double of_v[] = {rate.x, rate.y, rate.z, dot(spin, frame.e0)};
      for (std::size_t k = 0; k < 4; ++k) {
        set_lane(q[4 * i + k], lane, of_q[k]);
        set_lane(v[4 * i + k], lane, of_v[k]);
      }
    }
  }

  Clamp clamp(const Strand& strand, const RootPose& pose) const {
    const V from = frame_of(pose.frame) * strand.root.from, omega(pose.omega);
    return {frame_of(pose.frame) * strand.root.frame, V(pose.v) + cross(omega, from),
            omega};
  }
  void renew(Element* elements, const Clamp& clamp, Real* q, Real* v) const {
    kernel_.renew(elements, clamp, q, v);
  }
  /// The first edge starts at the root, wherever that has gone.
  void predict(const Strand& strand, const RootPose& from, const RootPose& to, double h,
               const Real* q, const Real* v, Real* q_bar) const {
    for (std::size_t k = 0; k < unknowns(); ++k) q_bar[k] = q[k] + Real(h) * v[k];
    const Frame turned{to.frame.e0 - from.frame.e0, to.frame.e1 - from.frame.e1,
                       to.frame.e2 - from.frame.e2};
    const V moved = V(to.x - from.x) + frame_of(turned) * strand.root.from;
    store3(load3(q_bar) - moved, q_bar);
  }
  Real newton(const Strand& strand, const Element* elements, const Clamp& clamp,
              Weights w, const Real* q, const Real* v, const Real* a, Real* correction,
              Scratch& scratch) const {
    Real size;
    by(instructions_, [&] {
      size = kernel_.newton(strand.material, elements, clamp, w, q, v, a, correction,
                            scratch.placed.data(), scratch.factors.data());
    });
    return size;
  }
  Real again(const Strand& strand, const Element* elements, const Clamp& clamp, Weights w,
             const Real* q, const Real* v, const Real* a, Real* correction,
             Scratch& scratch) const {
    Real size;
    by(instructions_, [&] {
      size = kernel_.again(strand.material, elements, clamp, w, q, v, a, correction,
                           scratch.placed.data(), scratch.factors.data(),
                           scratch.now.data());
    });
    return size;
  }

  /// Places are known to a rounding of the longest strand, sizes are over edges.
  double resolved(const Strand& strand, Weights w, int lane) const {
    constexpr double eps = std::numeric_limits<typename Real::Scalar>::epsilon();
    return eps / lane_of(strand.material.length, lane) *
           std::max(1.0, w.vel / (w.pos * lane_of(strand.material.rate, lane)));
  }

  LaneEnergies<Real> energies(const Strand& strand, const Element* elements,
                              const RootPose& pose, const Real* q, const Real* v) const {
    return kernel_.energies(strand.material, elements, clamp(strand, pose),
                            frame_of(pose.frame) * strand.root.from, q, v);
  }
  double mass(const Strand& strand, int lane) const {
    return static_cast<double>(n_) * lane_of(strand.material.mass, lane);
  }
  template <class Use>
  void velocities(const Clamp& clamp, const Real* v, Use use) const {
    use(0, clamp.v);
    V at{};  // the first rate is that of a place, not of an edge
    for (std::size_t i = 0; i < n_; ++i) {
      at = at + load3(v + 4 * i);
      use(i + 1, at);
    }
  }
  template <class Use>
  void positions(const Strand& strand, const Frame& head, const Real* q, Use use) const {
    V at = frame_of(head) * strand.root.from;
    use(0, at);
    for (std::size_t i = 0; i < n_; ++i) {
      at = at + load3(q + 4 * i);
      use(i + 1, at);
    }
  }

 private:
  static FrameOf<Real> frame_of(const Frame& f) { return {f.e0, f.e1, f.e2}; }

  Instructions instructions_;
  std::size_t n_;
  double drag_, mass_damping_;
  bool turning_;
  Kernel kernel_;
};

}  // namespace

std::unique_ptr<Head> der_head(const HeadOptions& options, const HeadPack& pack) {
  check_for_head(options);
  refuse_if(!options.twist, "a discrete elastic rod without twist", place_of_head,
            "leave twist on");
  if (options.method == HeadMethod::semi_implicit_euler) {
    return on_pack(pack, [&]<class T>(Instructions set) -> std::unique_ptr<Head> {
      return std::make_unique<SteppingHead<DerModel<T, false>>>(options, set);
    });
  }
  return on_pack(pack, [&]<class T>(Instructions set) -> std::unique_ptr<Head> {
    return std::make_unique<SteppingHead<DerModel<T, true>>>(options, set);
  });
}

}  // namespace tress::models
