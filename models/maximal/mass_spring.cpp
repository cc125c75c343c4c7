#include "models/entry.h"
#include "models/maximal/maximal_system.h"
#include "models/maximal/nodal_strand.h"
#include "models/maximal/spring_builder.h"

namespace tress::models {
namespace {

/// Strand of point masses at the segments' ends and springs between them [Rosenblum,
/// Carlson & Tripp 1991]. With edges e of rest length l:
///
///     stretch   EA/l (|e| - l)^2/2
///     bending   angular: EI/(2 l) (|kb| - rest)^2 per joint, |kb| = 2 tan(angle/2), l
///               the mean of its edges, EI that of both axes;
///               second_neighbour: 4 EI/l^3 (d - rest)^2/2, d the distance to the next
///               node but one: the bending stiffness against a middle node that moves
///               across a chord with fixed ends
///     torsion   altitude: GJ/(2 l) ((h - rest)/h')^2 per four nodes, h the altitude of
///               their tetrahedron (spring_strain.h) and h' its slope over the dihedral
///               angle at rest [Selle, Lentine & Fedkiw 2008]
///
/// Friction acts with gamma in place of EI and GJ on the rates of the same strains, with
/// none on stretch. It sees the rate of a joint's angle only, not of its direction.
///
/// The clamp is a body with a frame: a wall half an edge before the first edge's middle,
/// with a bending spring over l/2 in each of two directions.
///
/// Points have no frame. The consequences, with figures from
/// tests/models/maximal/test_spring_statics.cpp:
///
/// - angular alone holds the rest angle of a joint but not its direction: a curl may
///   unroll into any shape with the same angles. Nothing is lost for a straight rest
///   shape (an isotropic rod with a free tip has no twist at rest). A joint of a curled
///   strand that happens to be straight has no bending direction (Hinge::delta).
/// - second_neighbour has no linear stiffness against bending from straight: k angle^4,
///   EI l^2 curvature^4/8 per length, which vanishes as l^2. The strand converges to a
///   rope: a cantilever of weight w hangs at a horizontal distance of (4/3) (3 EI l^2/(8
///   w))^(1/4) from its clamp. That is 4.9 % of L for w L^2/EI = 10 and N = 160, where a
///   rod has 65.6 %. A rest angle a is held with sin(a)^2 of the stiffness.
/// - altitude holds the direction of curls. For rest angles below about 4e-3 rad there is
///   no tetrahedron and no spring. The limit of small l is not Kirchhoff's rod: torsion
///   of the centre line replaces twist, so the section cannot roll. A curly hair under
///   its weight differs from the rod by 3.7 % of L, its energy by 2 %.
///
/// Selle et al. switch between the altitudes of a tetrahedron and add particles next to a
/// straight strand to form tetrahedra. The single fixed altitude, its stiffness and the
/// wall's are our reconstruction.
struct MassSpringOptions {
  Bending bending = Bending::angular;
  bool altitude = false;      // torsion springs
  bool inextensible = false;  // |e| = l by constraints with multipliers
  bool stretch = true;        // springs along edges, also allowed with constraints
  SpringJacobian jacobian = SpringJacobian::exact;
  LinearKind solver = LinearKind::automatic;
};

constexpr Parameter torsion_parameter{.name = "torsion",
                                      .help = "springs that hold the direction of curls",
                                      .choices = "none|altitude"};

/// Throws InputError naming `model` unless the strand is a chain.
std::unique_ptr<System> mass_spring(const Strand& strand, const std::string& model,
                                    const MassSpringOptions& options, Effects effects) {
  NodalStrand nodal(strand, model, 0);
  MaximalStrand& parts = nodal.parts;
  SpringBuilder builder(strand, nodal);
  if (options.inextensible) parts.constraints = inextensible(parts, strand);
  if (options.stretch) builder.add_stretch();
  builder.add_bending(options.bending);
  if (options.altitude) builder.add_altitudes();
  parts.elasticity =
      std::make_unique<SpringElasticity>(std::move(builder.springs), options.jacobian);
  parts.effects = std::move(effects);
  parts.solver = options.solver;
  return std::make_unique<MaximalSystem>(std::move(parts));
}

std::span<const Parameter> mass_spring_parameters() {
  static constexpr std::array all{
      Parameter{.name = "bending",
                .help = "springs on angles, or to the next node but one",
                .choices = "angular|second_neighbour"},
      torsion_parameter,
      Parameter{.name = "jacobian",
                .help = "Jacobian of the springs: exact, or positive semidefinite",
                .choices = "exact|filtered"},
      maximal_solver_parameter};
  return all;
}

std::unique_ptr<System> make_mass_spring(const Strand& strand,
                                         const Parameters& parameters, Effects effects) {
  MassSpringOptions options;
  if (parameters.word("bending") == "second_neighbour") {
    options.bending = Bending::second_neighbour;
  }
  options.altitude = parameters.word("torsion") == "altitude";
  if (parameters.word("jacobian") == "filtered")
    options.jacobian = SpringJacobian::filtered;
  options.solver = maximal_solver(parameters);
  return mass_spring(strand, "mass_spring", options, std::move(effects));
}

/// The variant with edges of constant length, held by n multipliers: the inextensible
/// chain [Baraff 1996] with bending and rest angles. Additional springs along the edges
/// serve an integrator that releases lengths and corrects them (predictor_corrector).
std::span<const Parameter> inextensible_strand_parameters() {
  static constexpr std::array all{
      torsion_parameter,
      Parameter{.name = "stretch_springs",
                .help = "along the links, for integrators that correct lengths",
                .choices = "none|linear"},
      maximal_solver_parameter};
  return all;
}

std::unique_ptr<System> make_inextensible_strand(const Strand& strand,
                                                 const Parameters& parameters,
                                                 Effects effects) {
  MassSpringOptions options;
  options.inextensible = true;
  options.stretch = parameters.word("stretch_springs") == "linear";
  options.altitude = parameters.word("torsion") == "altitude";
  options.solver = maximal_solver(parameters);
  return mass_spring(strand, "inextensible_strand", options, std::move(effects));
}

}  // namespace

ModelEntry mass_spring_entry() {
  return {.id = "mass_spring",
          .summary = "point masses with springs for stretch, bending and torsion; 3n",
          .source = "Rosenblum 1991; Selle 2008",
          .parameters = mass_spring_parameters(),
          .make = on_described_strand<make_mass_spring>,
          .on_strand = make_mass_spring};
}

ModelEntry inextensible_strand_entry() {
  return {.id = "inextensible_strand",
          .summary =
              "n rigid links with bending springs and rest angles; 3n with n multipliers",
          .source = "Baraff 1996; Rosenblum 1991",
          .parameters = inextensible_strand_parameters(),
          .make = on_described_strand<make_inextensible_strand>,
          .on_strand = make_inextensible_strand};
}

}  // namespace tress::models
