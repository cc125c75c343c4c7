#include <cmath>
#include <vector>

#include "models/head/maximal/edge_model.h"
#include "models/head/maximal/node_loads.h"
#include "models/head/maximal/spring_strand.h"
#include "models/head/stepping/stepping_head.h"
#include "models/maximal/nodal_strand.h"

namespace tress::models {
namespace {

/// SpringStrand as a Model of models/head/stepping/stepped_model.h.
template <class Pack>
class SpringModel : public EdgeModel<Pack, SpringStrand<Pack>::per_element> {
 public:
  using Real = Pack;
  using Kernel = SpringStrand<Real>;
  using Base = EdgeModel<Real, Kernel::per_element>;
  using Base::clamp, Base::elements;
  using V = Vec3<Real>;
  static constexpr bool iterates = false, takes_bodies = true;
  static constexpr double most_stretched = 1.5;  // runs end where an edge is longer

  struct Strand {
    LaneRoot<Real> root;
    SpringMaterial<Real> material;
  };
  using Element = SpringEdge<Real>;
  using Clamp = LaneClamp<Real>;
  struct Scratch {
    explicit Scratch(const SpringModel& model)
        : placed(model.elements()), factors(model.elements()), bodies(model.elements()) {}
    std::vector<typename Kernel::Placed> placed;
    std::vector<typename Kernel::Factor> factors;
    NodeLoads<Real> bodies;
    const NodeLoad<Real>* loads = nullptr;  // of find_loads()
  };

  SpringModel(const HeadOptions& options, const HeadUnits& units,
              Instructions instructions)
      : Base(options),
        instructions_(instructions),
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

  Real length(const Strand& strand) const {
    return Real(static_cast<double>(this->elements())) * strand.material.length;
  }
  void find_loads(const Strand& strand, std::span<const NearBody> bodies,
                  const RootPose& pose, const HeadUnits& units, double h, const Real* q,
                  const Real* v, Scratch& scratch) const {
    by(instructions_, [&] {
      scratch.loads =
          scratch.bodies.find(bodies, units, h, Base::root_at(strand, pose.frame),
                              strand.material.length, strand.material.drag, q, v);
    });
  }
  Real newton(const Strand& strand, const Element* elements, const Clamp& clamp,
              Weights w, const Real* q, const Real* v, const Real* a, Real* correction,
              Scratch& scratch) const {
    Real finite;
    by(instructions_, [&] {
      finite = kernel_.newton(strand.material, elements, clamp, w, q, v, a, scratch.loads,
                              correction, scratch.placed.data(), scratch.factors.data());
    });
    return finite;
  }

  LaneEnergies<Real> energies(const Strand& strand, const Element* elements,
                              const RootPose& pose, const Real* q, const Real* v) const {
    return kernel_.energies(strand.material, elements, clamp(strand, pose),
                            Base::root_at(strand, pose.frame), q, v);
  }

 private:
  Instructions instructions_;
  Kernel kernel_;
};

}  // namespace

std::unique_ptr<Head> spring_head(const HeadOptions& options, const HeadPack& pack) {
  check_for_head(options);
  refuse_if(options.method != HeadMethod::semi_implicit_euler,
            "a method that iterates, with point masses and springs", place_of_head,
            "use semi_implicit_euler");
  // The strain of a hair under its weight is some 1e-6: 32 bits know it to 6 %.
  refuse_if(pack.number != HeadNumber::float64,
            "springs in 32 bits, which do not resolve their strains", place_of_head,
            "use 64 bits");
  return on_pack<false>(pack, [&]<class T>(Instructions set) -> std::unique_ptr<Head> {
    return std::make_unique<SteppingHead<SpringModel<T>>>(options, set);
  });
}

}  // namespace tress::models
