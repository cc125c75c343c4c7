#include "experiments/validation/rods/rod.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace tress::experiments::validation {
namespace {

constexpr CrossSection round_section{40e-6, 40e-6};
constexpr double youngs_modulus = 3e9, density = 1300;

constexpr std::array<std::string_view, 2> points = {"mass_spring", "inextensible_strand"};

bool among(std::span<const std::string_view> models, const ModelVariant& variant) {
  return std::ranges::find(models, variant.model->id) != models.end();
}

}  // namespace

double TestRod::bending() const { return youngs_modulus * round_section.inertia1(); }

double TestRod::twisting() const { return bending() / (1 + poisson_ratio); }

double TestRod::line_mass() const { return density * round_section.area(); }

double TestRod::rate() const {
  return std::sqrt(bending() / line_mass()) / (length * length);
}

double TestRod::force() const { return bending() / (length * length); }

double TestRod::gravity(double gamma) const {
  return gamma * bending() / (line_mass() * std::pow(length, 3));
}

Strand TestRod::strand(int elements, const Frame& clamp) const {
  Material material;
  material.density = density;
  material.youngs_modulus = youngs_modulus;
  material.shear_modulus = Material::shear_modulus_of(youngs_modulus, poisson_ratio);
  Strand strand = make_strand(
      material, round_section,
      {.elements = elements, .length = length, .grading = grading}, natural, initial);
  strand.root.frame = clamp;
  return strand;
}

Frame horizontal_clamp() { return {}; }
Frame hanging_clamp() { return {{0, 0, -1}, {0, 1, 0}, {1, 0, 0}}; }
Frame standing_clamp() { return {{0, 0, 1}, {0, 1, 0}, {-1, 0, 0}}; }

std::unique_ptr<System> on_strand(const ModelVariant& variant, const Strand& strand,
                                  Effects effects) {
  Parameters parameters(variant.model->parameters,
                        "model " + std::string(variant.model->id));
  for (const auto& [key, value] : variant.settings) parameters.set(key, value);
  return variant.model->on_strand(strand, parameters, std::move(effects));
}

End held_section(const ModelVariant& variant, const Strand& strand, End::Section section,
                 const Frame& frame) {
  constexpr std::array<std::string_view, 5> framed_in_the_middle = {
      "articulated_chain", "force_transport", "der", "corde", "xpbd_cosserat"};
  End end{.section = section, .frame = frame};
  if (!among(framed_in_the_middle, variant)) return end;
  const Segment& last = strand.segments.back();
  const Vec moduli = stiffness(strand.material, last.section);
  const double half = last.length / 2;
  end.compliance = {half / moduli.x, half / moduli.y, half / moduli.z};
  end.rest = half * last.natural;
  return end;
}

std::string no_section(const ModelVariant& variant) {
  constexpr std::array<std::string_view, 1> accelerations = {"kirchhoff_nodal"};
  if (among(points, variant)) return "points have no section to be held";
  if (among(accelerations, variant)) {
    return "its equations are accelerations of curvatures: no place for the moment that "
           "holds a section";
  }
  return {};
}

std::string no_curl(const ModelVariant& variant) {
  return among(points, variant)
             ? "springs hold the angles between edges, not the direction of a curl"
             : std::string();
}

}  // namespace tress::experiments::validation
