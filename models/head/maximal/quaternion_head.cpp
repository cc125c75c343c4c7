#include <vector>

#include "models/head/lane_block.h"
#include "models/head/maximal/edge_model.h"
#include "models/head/maximal/quaternion_strand.h"
#include "models/quaternion_rods/rod_kind.h"

namespace tress::models {
namespace {

/// QuaternionStrand as a LaneModel.
template <class Pack, template <class> class EdgeOf>
class QuaternionModel
    : public EdgeModel<Pack, QuaternionStrand<Pack, EdgeOf>::per_element> {
 public:
  using Real = Pack;
  using Kernel = QuaternionStrand<Real, EdgeOf>;
  using Base = EdgeModel<Real, Kernel::per_element>;
  using V = Vec3<Real>;
  using Element = typename Kernel::Element;
  using Clamp = typename Kernel::Clamp;
  static constexpr bool iterates = true, takes_stresses = true;

  struct Strand {
    LaneRoot<Real> root;
    QuaternionOf<Real> wall;  // of the root's frame
    typename Kernel::Material material;
  };
  struct Scratch {
    explicit Scratch(const QuaternionModel& model)
        : factors(model.elements()),
          forces(model.elements()),
          stresses(model.elements()),
          loads(model.elements()) {}
    std::vector<typename Kernel::Factor> factors;
    std::vector<V> forces;
    std::vector<typename Kernel::Stresses> stresses;  // of take_stresses()
    EdgeLoads<Real, true> loads;
  };

  /// As EdgeModel.
  QuaternionModel(const LaneOptions& options, const HeadUnits& units)
      : Base(options, units),
        kind_(rod_kind<EdgeOf<double>>(options.model ? &*options.model : nullptr)),
        kernel_(options.elements,
                V((units.time * units.time / units.length) * options.gravity)) {}

  /// In the state in which models/quaternion_rods/quaternion_rod.cpp starts.
  void describe(const models::Strand& strand, const Vec& centre, const HeadUnits& units,
                int lane, Strand& to, Element* elements, Real* q, Real* v) const {
    Base::describe_edges(strand, centre, units, lane, to);
    const auto made = quaternion_strand(strand, kind_);
    const MaximalStrand& parts = made.nodal.parts;
    const double l = units.length, tau = units.time, work = units.force() * l;
    const auto set = [lane](Real& number, double x) { set_lane(number, lane, x); };
    const auto set_part = [&](auto& part, const auto& of, auto unit) {
      for (int k = 0; k < part.strains; ++k) {
        const double strain = unit(k);
        set(part.stiffness[k], of.stiffness[k] * strain * strain / work);
        set(part.friction[k], of.friction[k] * strain * strain / (work * tau));
      }
    };
    const QuaternionOf<double> wall = quaternion_of(strand.root.frame);
    set(to.wall.w, wall.w);
    set_lane(to.wall.v, lane, wall.v);
    set(to.material.inertia, parts.inertia[0] / (units.mass() * l * l));
    EdgeOf<Real>& edge = to.material.edge;
    set(edge.length, made.edges[0].length / l);
    set_part(edge, made.edges[0],
             [l](int k) { return EdgeOf<Real>::stretch_is_length && k == 0 ? l : 1; });
    const Vec spin = tau * made.nodal.root.spin;
    for (std::size_t i = 0; i < this->elements(); ++i) {
      set_part(elements[i], made.joints[i], [](int) { return 1.0; });
      for (int k = 0; k < 3; ++k) set(elements[i].rest[k], made.joints[i].rest[k]);
      const Vec vector = made.edges[i].length / l * made.nodal.initial[i].e0;
      Vec rate = cross(spin, vector);
      if (i == 0) rate = rate + (tau / l) * made.nodal.root.velocity;
      constexpr std::size_t size = Kernel::per_element;
      const std::size_t at = 3 * (this->elements() + 1) + 4 * i;
      for (std::size_t k = 0; k < 3; ++k) {
        set(q[size * i + k], (&vector.x)[k]);
        set(v[size * i + k], (&rate.x)[k]);
      }
      for (std::size_t k = 0; k < 4; ++k) {
        set(q[size * i + 3 + k], parts.z[at + k]);
        set(v[size * i + 3 + k], tau * parts.rate[at + k]);
      }
    }
  }

  Clamp clamp(const Strand& strand, const RootPose& pose) const {
    const auto own = Base::clamp(strand, pose);
    const Quaternion turn = quaternion_of(pose.frame);
    return {QuaternionOf<Real>{turn.w, turn.v} * strand.wall, own.v, own.omega};
  }
  /// There are no reference frames.
  Real renew(Element* /*elements*/, const Clamp& /*clamp*/, Real* /*q*/,
             Real* /*v*/) const {
    return Real(0);
  }
  Real newton(const Strand& strand, const Element* elements, const Clamp& clamp,
              Weights w, const Real* q, const Real* v, const Real* a, Real* correction,
              Scratch& scratch) const {
    Real size;
    by_registers_of<Real>([&] {
      size = kernel_.newton(strand.material, elements, clamp, w, q, v, a,
                            Base::loads_at(strand, q, v, scratch), correction,
                            scratch.factors.data(), scratch.forces.data(),
                            scratch.stresses.data());
    });
    return size;
  }
  Real again(const Strand& strand, const Element* elements, const Clamp& clamp, Weights w,
             const Real* q, const Real* v, const Real* a, Real* correction,
             Scratch& scratch) const {
    Real size;
    by_registers_of<Real>([&] {
      size = kernel_.again(strand.material, elements, clamp, w, q, v, a,
                           Base::loads_at(strand, q, v, scratch), correction,
                           scratch.factors.data(), scratch.forces.data());
    });
    return size;
  }
  void take_stresses(const Strand& strand, const Element* elements, const Real* q,
                     const Real& which, Scratch& scratch) const {
    kernel_.take_stresses(strand.material, elements, q, which, scratch.stresses.data());
  }

  LaneEnergies<Real> energies(const Strand& strand, const Element* elements,
                              const RootPose& pose, const Real* q, const Real* v) const {
    return kernel_.energies(strand.material, elements, clamp(strand, pose),
                            Base::root_at(strand, pose.frame), q, v);
  }

 private:
  QuaternionRodKind<EdgeOf<double>> kind_;
  Kernel kernel_;
};

template <class T>
using CordeRods = QuaternionModel<T, CordeEdgeOf>;
template <class T>
using CosseratRods = QuaternionModel<T, CosseratEdgeOf>;

}  // namespace

AnyLaneKernel corde_lanes(const LaneOptions& options, const HeadPack& pack) {
  check_for_head(options);
  return lanes_of<CordeRods>(options, pack);
}

AnyLaneKernel cosserat_lanes(const LaneOptions& options, const HeadPack& pack) {
  check_for_head(options);
  return lanes_of<CosseratRods>(options, pack);
}

}  // namespace tress::models
