#include "models/entry.h"
#include "models/maximal/maximal_system.h"
#include "models/maximal/nodal_strand.h"
#include "models/maximal/spring_builder.h"

namespace tress::models {
namespace {

/// Strand of points without frames, with energies that are quadratic in lengths and
/// angles [Shi et al. 2023], for tight curls. With edges of rest length l:
///
///     stretch   EA/l (|e| - l)^2/2
///     bending   EI/l (theta - rest)^2/2 per joint, theta the angle of its edges
///     torsion   GJ/l (psi - rest)^2/2 per four nodes, psi the dihedral angle about the
///               middle edge (angle_strain.h)
///
/// and friction with gamma in place of EI and GJ, none on stretch. An angle that bends to
/// a half-turn has finite energy, where the curvature of mass_spring grows beyond bounds.
///
/// A reconstruction: the three energies are those of the authors' published code (files
/// QUADRATIC_STRETCHING, QUADRATIC_UNIT_BENDING and TET_STRAND_TWIST of HOBAK). There the
/// weights are free: bending times its length, torsion times the volume of a tetrahedron.
/// Here they are a rod's, with EI that of both axes and l of joints the mean of their
/// edges. The clamp is mass_spring's. The code leaves out the torsion of edges that are
/// nearly parallel; here it fades there. The angle is counted from its rest value, so
/// that it jumps where it has turned by half a turn, not where it is half a turn.
///
/// As with mass_spring's altitudes, torsion of the centre line replaces twist, so the
/// section cannot roll. A joint that is straight at rest has no torsion. The limit of
/// small l is therefore Kirchhoff's rod for a straight rest shape only. A curly hair
/// under its weight rests 5.3 % of L away from Kirchhoff's rod
/// (tests/models/maximal/test_spring_statics.cpp). A joint that is pulled straight loses
/// its torsion, and one that bends the other way has it half a turn off. A strand much
/// softer than its load therefore has no smooth motion there.
std::span<const Parameter> lifted_curls_parameters() {
  static constexpr std::array all{
      Parameter{.name = "jacobian",
                .help = "Jacobian of the springs: exact, or positive semidefinite",
                .choices = "exact|filtered"},
      maximal_solver_parameter};
  return all;
}

std::unique_ptr<System> make_lifted_curls(const Strand& strand,
                                          const Parameters& parameters, Effects effects) {
  NodalStrand nodal(strand, "lifted_curls", 0);
  SpringBuilder builder(strand, nodal);
  builder.add_stretch();
  builder.add_bending(Bending::angle);
  builder.add_dihedrals();
  MaximalStrand& parts = nodal.parts;
  parts.elasticity = std::make_unique<SpringElasticity>(
      std::move(builder.springs), parameters.word("jacobian") == "filtered"
                                      ? SpringJacobian::filtered
                                      : SpringJacobian::exact);
  parts.effects = std::move(effects);
  parts.solver = maximal_solver(parameters);
  return std::make_unique<MaximalSystem>(std::move(parts));
}

}  // namespace

ModelEntry lifted_curls_entry() {
  return {.id = "lifted_curls",
          .summary =
              "point masses, energies of lengths, angles and dihedral angles; 3n: "
              "from the code of its authors",
          .source = "Shi 2023",
          .parameters = lifted_curls_parameters(),
          .make = on_described_strand<make_lifted_curls>,
          .on_strand = make_lifted_curls};
}

}  // namespace tress::models
