#include <cmath>
#include <vector>

#include "models/head/lane_block.h"
#include "models/head/maximal/edge_model.h"
#include "models/head/maximal/spring_strand.h"
#include "models/maximal/nodal_strand.h"

namespace tress::models {
namespace {

/// SpringStrand as a LaneModel.
template <class Pack, bool exact>
class SpringModel : public EdgeModel<Pack, SpringStrand<Pack, exact>::per_element> {
 public:
  using Real = Pack;
  using Kernel = SpringStrand<Real, exact>;
  using Base = EdgeModel<Real, Kernel::per_element>;
  using Base::clamp, Base::elements;
  using V = Vec3<Real>;
  static constexpr bool iterates = exact, takes_stresses = exact;

  struct Strand {
    LaneRoot<Real> root;
    SpringMaterial<Real> material;
  };
  using Element = SpringEdge<Real>;
  using Clamp = LaneClamp<Real>;
  struct Scratch {
    explicit Scratch(const SpringModel& model)
        : placed(model.elements()),
          factors(model.elements()),
          loads(model.elements()),
          now(exact ? model.elements() : 0),
          tensions(now.size()) {}
    std::vector<typename Kernel::Placed> placed;
    std::vector<typename Kernel::Factor> factors;
    EdgeLoads<Real, exact> loads;
    std::vector<typename Kernel::Placed> now;
    std::vector<Real> tensions;  // of take_stresses()
  };

  /// As EdgeModel.
  SpringModel(const LaneOptions& options, const HeadUnits& units)
      : Base(options, units),
        kernel_(options.elements,
                V((units.time * units.time / units.length) * options.gravity)) {}

  /// In the state in which models/maximal/mass_spring.cpp starts.
  void describe(const models::Strand& strand, const Vec& centre, const HeadUnits& units,
                int lane, Strand& to, Element* elements, Real* q, Real* v) const {
    Base::describe_edges(strand, centre, units, lane, to);
    const Segment& first = strand.segments.front();
    const double l = units.length, tau = units.time;
    SpringMaterial<Real>& m = to.material;
    const double moment = first.length * units.stiffness() / l;
    const Vec bending = stiffness(strand.material, first.section);
    set_lane(m.bending, lane, (bending.y + bending.z) / (2 * moment));
    set_lane(m.friction, lane, strand.material.internal_friction / (moment * tau));
    const NodalStrand nodal(strand, "mass_spring", 0);
    const Frame& wall = nodal.root.place.frame;
    const Vec spin = tau * nodal.root.spin;
    for (std::size_t i = 0; i < this->elements(); ++i) {
      const Vec at_rest[] = {i > 0 ? nodal.natural[i - 1].e0 : wall.e0,
                             nodal.natural[i].e0};
      const Vec kb =
          (2 / (1 + dot(at_rest[0], at_rest[1]))) * cross(at_rest[0], at_rest[1]);
      set_lane(elements[i].rest, lane, i > 0 ? norm(kb) : dot(wall.e1, kb));
      set_lane(elements[i].about_e2, lane, i > 0 ? 0 : dot(wall.e2, kb));
      const Vec edge = first.length / l * nodal.initial[i].e0;
      Vec rate = cross(spin, edge);
      if (i == 0) rate = rate + (tau / l) * nodal.root.velocity;
      for (std::size_t k = 0; k < 3; ++k) {
        set_lane(q[3 * i + k], lane, (&edge.x)[k]);
        set_lane(v[3 * i + k], lane, (&rate.x)[k]);
      }
    }
  }

  /// There are no reference frames.
  Real renew(Element* /*elements*/, const Clamp& /*clamp*/, Real* /*q*/,
             Real* /*v*/) const {
    return Real(0);
  }

  Real newton(const Strand& strand, const Element* elements, const Clamp& clamp,
              Weights w, const Real* q, const Real* v, const Real* a, Real* correction,
              Scratch& scratch) const {
    const auto* loads = Base::loads_at(strand, q, v, scratch);
    Real size;
    by_registers_of<Real>([&] {
      const auto solve = [&](auto*... tensions) {
        return kernel_.newton(strand.material, elements, clamp, w, q, v, a, loads,
                              correction, scratch.placed.data(), scratch.factors.data(),
                              tensions...);
      };
      if constexpr (exact) {
        size = solve(scratch.tensions.data());
      } else {
        size = solve();
      }
    });
    return size;
  }
  Real again(const Strand& strand, const Element* elements, const Clamp& clamp, Weights w,
             const Real* q, const Real* v, const Real* a, Real* correction,
             Scratch& scratch) const {
    const auto* loads = Base::loads_at(strand, q, v, scratch);
    Real size;
    by_registers_of<Real>([&] {
      size = kernel_.again(strand.material, elements, clamp, w, q, v, a, loads,
                           correction, scratch.placed.data(), scratch.factors.data(),
                           scratch.now.data());
    });
    return size;
  }
  void take_stresses(const Strand& strand, const Element* /*edges*/, const Real* q,
                     const Real& which, Scratch& scratch) const {
    take_tensions<Kernel::per_element>(strand.material, elements(), q, which,
                                       scratch.tensions.data());
  }

  LaneEnergies<Real> energies(const Strand& strand, const Element* elements,
                              const RootPose& pose, const Real* q, const Real* v) const {
    return kernel_.energies(strand.material, elements, clamp(strand, pose),
                            Base::root_at(strand, pose.frame), q, v);
  }

 private:
  Kernel kernel_;
};

template <class T>
using StiffSprings = SpringModel<T, false>;
template <class T>
using ExactSprings = SpringModel<T, true>;

}  // namespace

AnyLaneKernel spring_lanes(const LaneOptions& options, const HeadPack& pack,
                           Jacobian jacobian) {
  check_for_head(options);
  // The strain of a hair under its weight is about 1e-6: single precision resolves it to
  // 6 %.
  refuse_if(pack.number != HeadNumber::float64,
            "springs in single precision, which does not resolve their strains",
            place_of_head, "use 64 bits");
  return jacobian == Jacobian::exact ? lanes_of<ExactSprings, false>(options, pack)
                                     : lanes_of<StiffSprings, false>(options, pack);
}

}  // namespace tress::models
