#include "models/quaternion_rods/rod_kind.h"

#include "contract/input_error.h"
#include "models/quaternion_rods/quaternion_rod.h"
#include "models/quaternion_rods/rotation_vectors.h"

namespace tress::models {

template <class Edge>
QuaternionStrandParts<Edge> quaternion_strand(const Strand& strand,
                                              const QuaternionRodKind<Edge>& kind) {
  const std::size_t n = strand.segments.size();
  QuaternionStrandParts<Edge> made{NodalStrand(strand, kind.model, 4 * n), {}, {}};
  const NodalStrand& nodal = made.nodal;
  MaximalStrand& parts = made.nodal.parts;
  const Quaternion root = quaternion_of(nodal.root.place.frame);
  Quaternion now = root, natural = root;  // neighbours on the same side of the sphere
  for (std::size_t i = 0; i < n; ++i) {
    const Segment& segment = strand.segments[i];
    made.edges.push_back(kind.edge_of(strand.material_of(segment), segment));
    now = nearer(now, quaternion_of(nodal.initial[i]));
    const std::size_t at = 3 * (n + 1) + 4 * i;
    store_quaternion(now, &parts.z[at]);
    store_quaternion(rate_of(now, nodal.root.spin), &parts.rate[at]);
    const CrossSection& section = segment.section;
    const double l = segment.length;
    std::fill_n(&parts.inertia[4 * i], 4,
                4 * strand.material_of(segment).density * l *
                    (section.polar() + kind.rotary * section.area() * l * l));
    const Quaternion before = natural;
    natural = nearer(before, quaternion_of(nodal.natural[i]));
    if (i == 0 && !parts.clamped) continue;
    made.joints.emplace_back(rod_joint(strand, i > 0 ? &strand.segments[i - 1] : nullptr,
                                       segment, turn_between(before, natural)));
  }
  return made;
}

template <class Edge>
std::unique_ptr<System> quaternion_rod(const Strand& strand,
                                       const QuaternionRodKind<Edge>& kind,
                                       Effects effects, const Parameters& options) {
  const bool distant = needs(effects).couplings;
  QuaternionStrandParts<Edge> made = quaternion_strand(strand, kind);
  MaximalStrand& parts = made.nodal.parts;
  parts.elasticity = std::make_unique<QuaternionRod<Edge>>(
      std::move(made.edges), std::move(made.joints), parts.clamped);
  parts.effects = std::move(effects);
  parts.solver = maximal_solver(options);
  auto rod = std::make_unique<MaximalSystem>(std::move(parts));
  if (options.word(coordinates_parameter.name) == "quaternion") return rod;
  const auto refuse = [&](bool has, const char* what) {
    refuse_if(has, std::string("rotation vectors do not take ") + what,
              "model " + kind.model, "give [model] coordinates = \"quaternion\"");
  };
  refuse(distant, "contact of a strand with itself");
  refuse(rod->contact_form() != nullptr, "exact contact");
  return std::make_unique<RotationVectors>(std::move(rod), strand.segments.size(),
                                           options.number(renewal_parameter.name),
                                           maximal_solver(options));
}

template QuaternionStrandParts<CordeEdge> quaternion_strand(
    const Strand&, const QuaternionRodKind<CordeEdge>&);
template QuaternionStrandParts<CosseratEdge> quaternion_strand(
    const Strand&, const QuaternionRodKind<CosseratEdge>&);
template std::unique_ptr<System> quaternion_rod(const Strand&,
                                                const QuaternionRodKind<CordeEdge>&,
                                                Effects, const Parameters&);
template std::unique_ptr<System> quaternion_rod(const Strand&,
                                                const QuaternionRodKind<CosseratEdge>&,
                                                Effects, const Parameters&);

}  // namespace tress::models
