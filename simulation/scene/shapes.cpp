#include "simulation/scene/shapes.h"

#include <array>
#include <cmath>
#include <numbers>

#include "contract/input_error.h"
#include "simulation/groom/random.h"
#include "simulation/table/along.h"

namespace tress::simulation {
namespace {

constexpr Parameter shape_table[] = {
    {.name = "shape",
     .help = "shape at rest; material: the curl of the material; along: that of "
             "darboux_along",
     .choices = "straight|material|helix|wavy|fuzzy|along"},
    {.name = "curl_radius_m",
     .help =
         "helix: radius r (m); with pitch 2 pi b, curvature is r/(r^2 + b^2) and twist "
         "b/(r^2 + b^2)",
     .number = 0.01,
     .min = 1e-9,
     .max = 1e3},
    {.name = "curl_pitch_m",
     .help = "helix: rise per turn, negative: left-handed (m)",
     .number = 0.02,
     .min = -1e3,
     .max = 1e3},
    {.name = "wave_per_m",
     .help = "wavy: largest curvature (1/m)",
     .number = 50,
     .min = -1e6,
     .max = 1e6},
    {.name = "wavelength_m",
     .help = "wavy: length of a wave along the strand (m)",
     .number = 0.03,
     .min = 1e-9,
     .max = 1e6},
    {.name = "fuzz_per_m",
     .help = "fuzzy: root mean square of either curvature (1/m)",
     .number = 50,
     .min = 0,
     .max = 1e6},
    {.name = "correlation_m",
     .help = "fuzzy: length along which curvature stays similar (m)",
     .number = 0.01,
     .min = 1e-6,
     .max = 1e6},
};

constexpr Use use_table[] = {{"helix", "curl_radius_m|curl_pitch_m"},
                             {"wavy", "wave_per_m|wavelength_m"},
                             {"fuzzy", "fuzz_per_m|correlation_m"},
                             {"along", "darboux_along"}};

constexpr std::size_t waves = 32;
struct Wave {
  double rate, phase1, phase2;
};

}  // namespace

std::span<const Parameter> shape_parameters() { return shape_table; }
std::span<const Use> shape_uses() { return use_table; }

Shape fuzzy_shape(double amplitude, double correlation, std::uint64_t seed,
                  std::uint64_t stream) {
  if (!std::isfinite(amplitude) || !std::isfinite(correlation) || !(correlation > 0)) {
    throw InputError("no such random shape", "shape of a strand",
                     "give a finite curvature in 1/m and a correlation length > 0 in m");
  }
  // A mean of cos(rate d) over normal rates of deviation 1/c is exp(-d^2/(2 c^2)).
  Random random(seed, stream);
  std::array<Wave, waves> all;
  for (Wave& wave : all) {
    const double full = 2 * std::numbers::pi;
    const double rate = random.normal() / correlation;
    const double phase = full * random.uniform();
    wave = {rate, phase, full * random.uniform()};
  }
  const double each = amplitude * std::sqrt(2.0 / waves);
  return [all, each](double s) {
    double first = 0, second = 0;
    for (const Wave& wave : all) {
      first += std::cos(wave.rate * s + wave.phase1);
      second += std::cos(wave.rate * s + wave.phase2);
    }
    return Vec{0, each * first, each * second};
  };
}

Shape natural_shape(const Table& table, const StrandMaterial& material, double length,
                    std::uint64_t seed, std::uint64_t stream) {
  const Parameters& p = table.values();
  const std::string_view shape = p.word("shape");
  if (shape == "helix") {
    return helix_shape(p.number("curl_radius_m"), p.number("curl_pitch_m"));
  }
  if (shape == "material" && material.curl_radius > 0) {
    return helix_shape(material.curl_radius, material.curl_pitch);
  }
  if (shape == "wavy") {
    return wavy_shape(p.number("wave_per_m"), p.number("wavelength_m"));
  }
  if (shape == "fuzzy") {
    return fuzzy_shape(p.number("fuzz_per_m"), p.number("correlation_m"), seed, stream);
  }
  if (shape == "along") return shape_along(table, length);
  return uniform_shape({});
}

}  // namespace tress::simulation
