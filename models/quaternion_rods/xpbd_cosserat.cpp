#include <algorithm>

#include "models/entry.h"
#include "models/quaternion_rods/quaternion_rod.h"

namespace tress::models {
namespace {

/// Cosserat rod of position-based methods [Kugelstadt & Schoemer 2016, with the
/// compliances of Deul et al. 2018]. The rod has n edges between nodes x_i, and edge i
/// has a quaternion q_i for its material frame R. With e an edge and l its length at
/// rest,
///
///     C_s = R^T e/l - e0                            stretch and shear
///     C_b = 2 vec(conj(q_j) q_{j+1} - its rest)     twist and bending
///     E = sum_edges l (C_s^T diag(EA, k GA, k GA) C_s + nu (|q|^2 - 1)^2)/2
///       + sum_joints C_b^T diag(GJ, EI1, EI2) C_b/(2 l),
///
/// l of a joint is the mean of its edges. The papers measure C_s in world axes, with one
/// stiffness, and normalise quaternions after each correction. Here C_s is in the
/// section's axes, R is the frame of q/|q|, and nu keeps the norms as in corde.cpp. The
/// whole model thus derives from an energy: xpbd uses its ComplianceForm, every other
/// integrator the general contract, and the two can be compared. Joints, wall at the
/// clamp and friction (gamma/l on C_b') are those of corde.cpp; there is no friction on
/// C_s.
///
/// stretch_factor softens EA alone, as codes do that cannot follow a hair's: the rod then
/// stretches by its weight over stretch_factor EA.
///
/// In rotation vectors (rotation_vectors.h), norms are 1 and nu has no effect.
///
/// Order 2 as corde. Stretch and shear have the material's stiffness, so a light
/// cantilever bends lower by 4 EI/(k GA L^2) of its deflection and nothing locks. The
/// norm softens joints as in corde.cpp, by 2 (u l)^2/norm in bending of curvature u.
///
/// Quaternions have the section's inertia, (r/l)^2 of a node's, plus edge_inertia rho A
/// l^3, by default none. The papers' weights are free parameters comparable to a node's,
/// and xpbd needs such weights. With the section's inertia all corrections of shear go
/// into quaternions and convergence takes thousands of sweeps. Because quaternions turn
/// far on the way, the limit is not the motion of this energy. With 1/2, nodes and
/// quaternions of an edge have equal weights. It slows swinging and bending in the order
/// l^2 of the scheme (the error of a release becomes 1.7 times as large). It slows
/// twisting most: waves of twist run at sqrt(GJ/(rho A edge_inertia))/l instead of
/// sqrt(G/rho).
///
/// The stiffest oscillations turn edges against their shear. With the section's inertia
/// their frequency is sqrt(k GA/(2 rho I)) for any l: explicit methods need steps below
/// the time of a shear wave across the section.
///
/// Rotations between neighbours stay below 180 degrees, tensions below k GA (beyond it
/// edges turn out of their frames).
struct XpbdCosseratOptions {
  double stretch_factor = 1;  // stiffness against stretch over EA
  double shear_factor = 0.9;  // k [Cowper 1966: 6 (1 + p)/(7 + 6 p), solid circle, p 1/2]
  double norm = 100;          // nu l^2/EI
  double edge_inertia = 0;    // of quaternions, beyond the section's, over rho A l^3
};

CosseratEdge edge(const Material& material, const Segment& segment,
                  const XpbdCosseratOptions& options) {
  const CrossSection& section = segment.section;
  const double l = segment.length;
  const double bending =
      material.youngs_modulus * std::max(section.inertia1(), section.inertia2());
  const double shear = l * options.shear_factor * material.shear_modulus * section.area();
  return {
      .length = l,
      .stiffness = {l * options.stretch_factor * material.youngs_modulus * section.area(),
                    shear, shear, options.norm * bending / l},
      .friction = {}};
}

std::span<const Parameter> xpbd_cosserat_parameters() {
  static constexpr std::array all{
      Parameter{.name = "stretch_factor",
                .help = "stiffness against stretch over EA",
                .number = XpbdCosseratOptions{}.stretch_factor,
                .min = 1e-12},
      Parameter{.name = "shear_factor",
                .help = "stiffness against shear over GA",
                .number = XpbdCosseratOptions{}.shear_factor,
                .min = 1e-6},
      Parameter{.name = "norm",
                .help = "stiffness of the quaternions' norms over EI/l^2",
                .number = XpbdCosseratOptions{}.norm,
                .min = 1},
      Parameter{.name = "edge_inertia",
                .help = "inertia of the quaternions in addition to the section's own, "
                        "over rho A l^3",
                .number = XpbdCosseratOptions{}.edge_inertia,
                .min = 0},
      coordinates_parameter,
      renewal_parameter,
      maximal_solver_parameter};
  return all;
}

std::unique_ptr<System> make_xpbd_cosserat(const Strand& strand,
                                           const Parameters& parameters,
                                           Effects effects) {
  return quaternion_rod(strand, rod_kind<CosseratEdge>(&parameters), std::move(effects),
                        parameters);
}

}  // namespace

template <>
QuaternionRodKind<CosseratEdge> rod_kind(const Parameters* options) {
  XpbdCosseratOptions own;
  if (options != nullptr) {
    own = {.stretch_factor = options->number("stretch_factor"),
           .shear_factor = options->number("shear_factor"),
           .norm = options->number("norm"),
           .edge_inertia = options->number("edge_inertia")};
  }
  return {
      .model = "xpbd_cosserat",
      .edge_of = [own](const Material& material,
                       const Segment& segment) { return edge(material, segment, own); },
      .rotary = own.edge_inertia};
}

ModelEntry xpbd_cosserat_entry() {
  return {.id = "xpbd_cosserat",
          .summary =
              "Cosserat rod of n edges as compliant constraints; 3n positions and n "
              "quaternions",
          .source = "Kugelstadt & Schoemer 2016; Deul 2018",
          .parameters = xpbd_cosserat_parameters(),
          .make = on_described_strand<make_xpbd_cosserat>,
          .on_strand = make_xpbd_cosserat};
}

}  // namespace tress::models
