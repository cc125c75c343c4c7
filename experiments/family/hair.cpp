// The family drawn from measured human hair.
#include <algorithm>
#include <iterator>
#include <utility>

#include "experiments/family/populations.h"
#include "experiments/family/sampling.h"

namespace tress::experiments::family {
namespace {

/// Radius, ellipticity and natural curvature go with the group; within a group they are
/// independent, as measured [Lasisi et al. 2021]. The shares are chosen.
///
/// Radius and ellipticity: sections of Asian, Caucasian and African American hair [TRI
/// Princeton, Hair Ethnicity, table 3]; ellipticity up to 2.05 at 95 % [Lasisi et al.
/// 2021]. Curvature of straight hair: radius of curl 4.4 cm [J. Cosmet. Sci. 59, 323];
/// of the others, people of mostly European and of mostly African ancestry [Lasisi et al.
/// 2021]. Standard deviations are derived from the intervals of these tables.
struct Group {
  std::string_view name;
  double share_up_to;
  LogNormal radius;  // m
  double ellipticity;
  LogNormal curvature;  // 1/m
};
constexpr Group groups[] = {
    {"straight", 0.40, {39.5e-6, 0.128}, 1.29, {26, 0.49}},
    {"wavy", 0.75, {35.4e-6, 0.137}, 1.42, {64, 0.60}},
    {"coily", 1, {36.1e-6, 0.123}, 1.70, {462, 0.30}},
};
constexpr double ellipticity_sigma = 0.20;
constexpr Range ellipticities{1, 2.6};
constexpr double most_curvature = 800;  // 1/m; the largest measured is 772

/// Hanging lengths of 24 300 people: a fit by 10 % above 34 cm and 1.9 % above 53.5 cm
/// [Robbins & Robbins 2003].
constexpr LogNormal length{0.17, 0.55};  // m
constexpr Range lengths{0.03, 0.80};

/// Dry: 3.8 GPa at a humidity of 50 % [TRI Princeton, appendix B]; the largest of 156
/// women has over twice the least [Ezawa et al. 2019]. G/E: 0.89 over 3.89 GPa [Robbins
/// 1994, appendix].
constexpr LogNormal youngs_modulus{3.8e9, 0.20};  // Pa
constexpr double dry_shear = 0.23, dry_density = 1320;

/// Wet: E is a half to a third [J. Cosmet. Sci. 72 (2021), 673], the diameter 7 % more.
/// Chosen: the share of wet hair, its G/E, and three times the damping time.
constexpr double share_wet = 0.25, wet_shear = 0.14, wet_density = 1270;
constexpr double swelling = 1.07, wet_damping = 3;
constexpr Range wet_softness{2, 3};

/// Chosen, not measured: a loss factor of 0.05 to 0.1 between 2 and 10 Hz is 1 to 8 ms.
constexpr Range damping_times{0.3e-3, 10e-3};  // s
/// Chosen, not measured.
constexpr double twist_per_curvature = 0.3;

const Group& group_at(double u) {
  return *std::ranges::find_if(groups,
                               [u](const Group& one) { return u < one.share_up_to; });
}

}  // namespace

std::vector<Rod> draw_hair(int count, std::uint64_t seed) {
  Hypercube u(count, seed, 0);
  const auto group = u.next(), long_ = u.next(), thick = u.next(), flat = u.next(),
             curl = u.next(), stiff = u.next(), state = u.next(), soft = u.next(),
             damping = u.next();
  std::vector<Rod> all = draw_drives(Family::hair, u);
  for (std::size_t i = 0; i < all.size(); ++i) {
    Rod& rod = all[i];
    const Group& of = group_at(group[i]);
    const bool wet = state[i] < share_wet;
    rod.kind = of.name;
    rod.state = wet ? "wet" : "dry";
    rod.length = std::clamp(length.at(long_[i]), lengths.low, lengths.high);
    rod.radius = of.radius.at(thick[i]) * (wet ? swelling : 1);
    rod.youngs_modulus =
        youngs_modulus.at(stiff[i]) / (wet ? wet_softness.at(soft[i]) : 1);
    rod.shear_modulus = rod.youngs_modulus * (wet ? wet_shear : dry_shear);
    rod.density = wet ? wet_density : dry_density;
    rod.ellipticity = CutNormal{of.ellipticity, ellipticity_sigma, ellipticities.low,
                                ellipticities.high}
                          .at(flat[i]);
    rod.natural_curvature = std::min(of.curvature.at(curl[i]), most_curvature);
    rod.natural_twist = twist_per_curvature * rod.natural_curvature;
    rod.internal_friction = damping_times.log_at(damping[i]) * (wet ? wet_damping : 1) *
                            rod.bending_stiffness();
    rod.drag = air_drag(rod.radius, rod.air_speed());
  }
  return all;
}

}  // namespace tress::experiments::family
