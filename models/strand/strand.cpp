#include "models/strand/strand.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "contract/input_error.h"
#include "models/strand/strain.h"

namespace tress::models {
namespace {

using std::numbers::pi;

/// Gauss-Legendre on [-1, 1], 8 points, the positive half [Abramowitz & Stegun, 25.4.30].
struct GaussPoint {
  double x, weight;
};
constexpr GaussPoint gauss8[] = {{0.18343464249564980, 0.36268378337836198},
                                 {0.52553240991632899, 0.31370664587788729},
                                 {0.79666647741362674, 0.22238103445337447},
                                 {0.96028985649753623, 0.10122853629037626}};

/// Returns the linear function nearest to a shape in the mean square. Its mean is that of
/// the shape, its slope 3 times the mean of (2 x - 1) shape; the slope of a constant is
/// exactly zero.
LinearStrain projection(const Shape& shape, double from, double length) {
  const double half = length / 2;
  LinearStrain sum;
  for (const auto& [x, weight] : gauss8) {
    const Vec before = shape(from + half * (1 - x)), after = shape(from + half * (1 + x));
    sum.mean = sum.mean + weight / 2 * (before + after);
    sum.half = sum.half + 1.5 * weight * x * (after - before);
  }
  return sum;
}

void require(bool holds, const std::string& problem, const std::string& where,
             const std::string& remedy) {
  if (!holds) throw InputError(problem, where, remedy);
}

bool positive(double x) { return std::isfinite(x) && x > 0; }

void check(const Discretisation& cut) {
  const std::string where = "discretisation of a strand";
  require(cut.elements >= 1, "there are no elements", where, "give at least 1");
  require(positive(cut.length), "length is not positive", where,
          "give a length > 0 in m");
  require(positive(cut.grading), "grading is not positive", where,
          "give last length over first length, > 0");
}

void check(const Segment& segment, int index) {
  const std::string where = "segment " + std::to_string(index);
  require(segment.parent >= -1 && segment.parent < index,
          "parent " + std::to_string(segment.parent) + " does not precede", where,
          "give the index of an earlier segment, or -1 for the root");
  require(positive(segment.length), "length is not positive", where,
          "give a length > 0 in m");
  require(is_rotation(segment.mount), "mount is not a rotation", where,
          "give three orthogonal unit axes, right-handed");
  require(is_finite(segment.natural) && is_finite(segment.initial) &&
              is_finite(segment.natural_half) && is_finite(segment.initial_half),
          "natural or initial shape is not finite", where,
          "give finite twist and curvatures in 1/m");
  check(segment.section, where);
  const MaterialFactors& factors = segment.factors;
  require(positive(factors.modulus) && positive(factors.density) &&
              std::isfinite(factors.friction) && factors.friction >= 0,
          "a factor of the material is not positive", where,
          "give finite factors > 0; that of friction may be 0");
}

void check(const FreeRoot& root) {
  const std::string where = "free root";
  require(is_finite(root.position) && is_finite(root.velocity) && is_finite(root.spin),
          "position, velocity or spin is not finite", where, "give finite numbers");
  require(is_rotation(root.frame), "frame is not a rotation", where,
          "give three orthogonal unit axes, right-handed");
}

}  // namespace

double Strand::length() const {
  std::vector<double> to_tip;
  double longest = 0;
  for (const Segment& segment : segments) {
    const double before =
        segment.parent < 0 ? 0 : to_tip[static_cast<std::size_t>(segment.parent)];
    to_tip.push_back(before + segment.length);
    longest = std::max(longest, to_tip.back());
  }
  return longest;
}

double Strand::mass() const {
  double volume = 0;  // at the strand's density
  for (const Segment& segment : segments) {
    volume += segment.factors.density * segment.section.area() * segment.length;
  }
  return material.density * volume;
}

Material Strand::material_of(const Segment& segment) const {
  Material own = material;
  own.density *= segment.factors.density;
  own.youngs_modulus *= segment.factors.modulus;
  own.shear_modulus *= segment.factors.modulus;
  own.internal_friction *= segment.factors.friction;
  return own;
}

bool Strand::uniform() const {
  const Segment& first = segments.front();
  return std::ranges::all_of(segments, [&](const Segment& segment) {
    return segment.section == first.section && segment.factors == first.factors;
  });
}

Vec stiffness(const Strand& strand, const Segment& segment) {
  return stiffness(strand.material_of(segment), segment.section);
}

Shape uniform_shape(Vec darboux) {
  return [darboux](double) { return darboux; };
}

Shape helix_shape(double radius, double pitch) {
  require(positive(radius) && std::isfinite(pitch), "no such helix", "shape of a strand",
          "give a radius > 0 and a finite pitch in m");
  const double c = pitch / (2 * pi);
  const double square = radius * radius + c * c;
  return uniform_shape({c / square, radius / square, 0});
}

Shape wavy_shape(double amplitude, double wavelength) {
  require(std::isfinite(amplitude) && positive(wavelength), "no such wave",
          "shape of a strand",
          "give a finite amplitude in 1/m and a wavelength > 0 in m");
  return [amplitude, rate = 2 * pi / wavelength](double s) {
    return Vec{0, amplitude * std::cos(rate * s), 0};
  };
}

Strand make_strand(const Material& material, const CrossSection& section,
                   const Discretisation& cut, const Shape& natural,
                   const Shape& initial) {
  check(cut);
  require(static_cast<bool>(natural), "there is no natural shape", "strand",
          "give one, for instance uniform_shape({})");
  const double ratio =
      cut.elements == 1 ? 1 : std::pow(cut.grading, 1.0 / (cut.elements - 1));
  double first = 0;  // cut.length over the sum of ratio^i
  for (int i = 0; i < cut.elements; ++i) first += std::pow(ratio, i);
  first = cut.length / first;

  Strand strand;
  strand.material = material;
  double from = 0;
  for (int i = 0; i < cut.elements; ++i) {
    Segment segment;
    segment.parent = i - 1;
    segment.length = first * std::pow(ratio, i);
    segment.section = section;
    const LinearStrain at_rest = projection(natural, from, segment.length);
    const LinearStrain start =
        initial ? projection(initial, from, segment.length) : at_rest;
    segment.natural = at_rest.mean;
    segment.natural_half = at_rest.half;
    segment.initial = start.mean;
    segment.initial_half = start.half;
    from += segment.length;
    strand.segments.push_back(segment);
  }
  check(strand);
  return strand;
}

void check(const Strand& strand) {
  check(strand.material, "material of a strand");
  require(!strand.segments.empty(), "there are no segments", "strand", "give at least 1");
  int index = 0;
  for (const Segment& segment : strand.segments) check(segment, index++);
  if (strand.free_root) {
    check(*strand.free_root);
  } else {
    check(strand.root, "root motion");
  }
}

}  // namespace tress::models
