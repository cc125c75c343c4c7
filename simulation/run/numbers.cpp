#include "simulation/run/numbers.h"

#include <cmath>
#include <limits>

#include "contract/constants.h"
#include "simulation/run/readout.h"

namespace tress::simulation {
namespace {

double rms_root_acceleration(const Scene& scene, const RootMotion& root) {
  double squares = 0;
  for (std::size_t f = 0; f <= scene.last_frame(); ++f) {
    const Vec a = root.at(scene.time_of(f)).a;
    squares += dot(a, a);
  }
  return std::sqrt(squares / static_cast<double>(scene.last_frame() + 1));
}

/// kg/m of the first segment.
double line_density(const Strand& strand) {
  const models::Segment& first = strand.segments.front();
  return strand.material_of(first).density * first.section.area();
}

}  // namespace

ScaleNumbers scale_numbers(const Scene& scene) {
  const Strand& strand = scene.strands.front();
  const Vec moduli = stiffness(strand, strand.segments.front());
  const double bending = std::min(moduli.y, moduli.z);
  const double scale = line_density(strand) * std::pow(strand.length(), 3) / bending;
  const Vec fall = models::uniform_acceleration(make_effects(scene));
  return {norm(fall) * scale, rms_root_acceleration(scene, strand.root) * scale,
          moduli.x / bending};
}

double load_over_weight(const Scene& scene, std::string_view effect) {
  World world(scene);
  Readout readout(scene, world);
  std::size_t channel = 0;
  const auto& channels = readout.channels();
  const std::string name = "load " + std::string(effect);
  while (channel < channels.size() && channels[channel].name != name) ++channel;
  if (channel == channels.size()) return std::numeric_limits<double>::quiet_NaN();
  double squares = 0;
  std::size_t count = 0;
  for (std::size_t f = 0; f <= scene.last_frame(); ++f) {
    if (f > 0 && world.advance(scene.time_of(f)) != Status::ok) break;
    const Frame3d frame = readout.read(world);
    const std::size_t points = frame.positions.size() / 3;
    for (std::size_t i = 0; i < points; ++i) {
      squares += std::pow(static_cast<double>(frame.channels[channel * points + i]), 2);
    }
    count += points;
  }
  return std::sqrt(squares / static_cast<double>(count)) /
         (earth_gravity * line_density(scene.strands.front()));
}

}  // namespace tress::simulation
