#include <cmath>
#include <vector>

#include "models/head/lane_block.h"
#include "models/head/maximal/der_strand.h"
#include "models/head/maximal/edge_model.h"
#include "models/maximal/joint_strain.h"
#include "models/maximal/nodal_strand.h"

namespace tress::models {
namespace {

/// DerStrand as a LaneModel.
template <class Pack, bool exact>
class DerModel : public EdgeModel<Pack, DerStrand<Pack, exact>::per_element> {
 public:
  using Real = Pack;
  using Kernel = DerStrand<Real, exact>;
  using Base = EdgeModel<Real, Kernel::per_element>;
  using Base::clamp, Base::elements;
  using V = Vec3<Real>;
  static constexpr bool iterates = exact, takes_stresses = exact;
  struct Strand {
    LaneRoot<Real> root;
    DerMaterial<Real> material;
  };
  using Element = DerEdge<Real>;
  using Clamp = LaneClamp<Real>;
  struct Scratch {
    explicit Scratch(const DerModel& model)
        : placed(model.elements()),
          now(model.elements()),
          factors(model.elements()),
          loads(model.elements()),
          tensions(exact ? model.elements() : 0) {}
    std::vector<typename Kernel::Placed> placed, now;
    std::vector<typename Kernel::Factor> factors;
    EdgeLoads<Real, exact> loads;
    std::vector<Real> tensions;  // of take_stresses()
  };

  /// As EdgeModel.
  DerModel(const LaneOptions& options, const HeadUnits& units)
      : Base(options, units),
        turning_(options.rotary_inertia),
        kernel_(options.elements,
                V((units.time * units.time / units.length) * options.gravity)) {}

  /// In the state in which models/maximal/der.cpp starts.
  void describe(const models::Strand& strand, const Vec& centre, const HeadUnits& units,
                int lane, Strand& to, Element* elements, Real* q, Real* v) const {
    Base::describe_edges(strand, centre, units, lane, to);
    const Segment& first = strand.segments.front();
    const double l = units.length, tau = units.time;
    DerMaterial<Real>& m = to.material;
    set_lane(m.inertia, lane,
             turning_ ? strand.material.density * first.section.polar() * first.length /
                            (units.mass() * l * l)
                      : 0);
    const double moment = units.stiffness() / l;
    set_lane(m.stiffness, lane,
             1 / (first.length * moment) * stiffness(strand.material, first.section));
    set_lane(m.friction, lane,
             strand.material.internal_friction / (first.length * moment * tau));
    const NodalStrand nodal(strand, "der", this->elements());
    const Vec spin = tau * nodal.root.spin;
    for (std::size_t i = 0; i < this->elements(); ++i) {
      const Frame& before = i > 0 ? nodal.natural[i - 1] : nodal.root.place.frame;
      const Vec rest = joint_strain(before, nodal.natural[i]);
      set_lane(elements[i].rest, lane, rest);
      set_lane(elements[i].twist, lane, rest.x);
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

  Real renew(Element* elements, const Clamp& clamp, Real* q, Real* v) const {
    return kernel_.renew(elements, clamp, q, v);
  }
  Real newton(const Strand& strand, const Element* elements, const Clamp& clamp,
              Weights w, const Real* q, const Real* v, const Real* a, Real* correction,
              Scratch& scratch) const {
    const auto* loads = Base::loads_at(strand, q, v, scratch);
    Real size;
    by_registers_of<Real>([&] {
      size = kernel_.newton(strand.material, elements, clamp, w, q, v, a, loads,
                            correction, scratch.placed.data(), scratch.factors.data(),
                            scratch.tensions.data());
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
  bool turning_;
  Kernel kernel_;
};

template <class T>
using StiffRods = DerModel<T, false>;
template <class T>
using ExactRods = DerModel<T, true>;

}  // namespace

AnyLaneKernel der_lanes(const LaneOptions& options, const HeadPack& pack,
                        Jacobian jacobian) {
  check_for_head(options);
  refuse_if(!options.twist, "a discrete elastic rod without twist", place_of_head,
            "leave twist on");
  return jacobian == Jacobian::exact ? lanes_of<ExactRods>(options, pack)
                                     : lanes_of<StiffRods>(options, pack);
}

}  // namespace tress::models
