#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "experiments/adaptive_mesh/adaptive_mesh.h"
#include "simulation/groom/helix_fit.h"
#include "simulation/run/readout.h"
#include "simulation/run/world.h"
#include "simulation/scene_changes/changes.h"

namespace tress::experiments::adaptive_mesh {
namespace {

constexpr int arc_parts = 4;  // of the curve between two points

SpaceCurve curve_of(const simulation::Frame3d& frame, int points) {
  std::vector<Vec> all;
  for (std::size_t i = 0; i < static_cast<std::size_t>(points); ++i) {
    all.push_back(
        {frame.positions[3 * i], frame.positions[3 * i + 1], frame.positions[3 * i + 2]});
  }
  return {all, arc_parts, "shape of the reference"};
}

/// |kappa'|^(2/3) of strains of equal elements of a strand of length 1: of the joints
/// from `first` to its mirror, with their neighbours' beyond.
Density density_of(const std::vector<Vec>& strains, std::size_t first) {
  const std::size_t n = strains.size();
  const auto rate_at = [&](std::size_t joint) {
    const std::size_t k = std::clamp(joint, first, n - first);
    return static_cast<double>(n) * norm(strains[k] - strains[k - 1]);
  };
  Density density(cells);
  for (std::size_t c = 0; c < cells; ++c) {
    // The mean of |kappa'|^2 by the trapezoidal rule, a joint or more within.
    const double from = static_cast<double>(c * n) / cells,
                 to = static_cast<double>((c + 1) * n) / cells;
    double square = 0;
    int samples = 0;
    for (auto joint = static_cast<std::size_t>(from);
         joint <= static_cast<std::size_t>(std::ceil(to)); ++joint, ++samples) {
      const double rate = rate_at(joint);
      square += rate * rate;
    }
    density[c] = std::cbrt(square / samples);
  }
  return density;
}

Density density_of(const SpaceCurve& curve) {
  const auto chain =
      simulation::fit_helices(curve, simulation::cut_equally(curve.length(), cells));
  std::vector<Vec> strains;
  for (const Vec& kappa : chain.darboux) strains.push_back(curve.length() * kappa);
  // The spline is straight at its two ends, where a clamped strand is not.
  return density_of(strains, 2);
}

std::vector<Vec> strains_of(simulation::World& world, double length) {
  const std::vector<double> q = world.snapshot().strands.front().q;
  std::vector<Vec> strains;
  for (std::size_t i = 0; i + 2 < q.size(); i += 3) {
    strains.push_back(length * Vec(load3(&q[i])));
  }
  return strains;
}

/// A cut as a density: each of its elements has one share of all.
Density density_of_cut(const Strand& strand) {
  Density density(cells);
  const double length = strand.length();
  double s = 0;
  for (const Segment& segment : strand.segments) {
    for (std::size_t c = 0; c < cells; ++c) {
      const double cell = static_cast<double>(c),
                   from = std::max(s / length, cell / cells),
                   to = std::min((s + segment.length) / length, (cell + 1) / cells);
      if (to > from) density[c] += (to - from) * length / segment.length;
    }
    s += segment.length;
  }
  return density;
}

}  // namespace

Shapes shapes_of(const simulation::Scene& given, int fine, int instants) {
  const simulation::Scene scene = simulation::with_elements(given, fine);
  simulation::World world(scene);
  simulation::Readout readout(scene, world);
  const Strand& strand = scene.strands.front();
  const bool helices =
      scene.model->id == "super_helix" &&
      world.snapshot().strands.front().q.size() == 3 * strand.segments.size();
  Shapes shapes;
  for (int i = 0; i <= instants; ++i) {
    if (world.advance(scene.duration * i / instants) != Status::ok) {
      throw std::runtime_error(world.failure());
    }
    shapes.at.push_back(curve_of(readout.read(world), readout.lines().front()));
    shapes.density.push_back(helices ? density_of(strains_of(world, strand.length()), 1)
                                     : density_of(shapes.at.back()));
  }
  return shapes;
}

Density density_at_rest(const simulation::Scene& scene, const Shapes& shapes) {
  return simulation::may_cut_at_rest(scene)
             ? density_of_cut(
                   simulation::with_elements_at_rest(scene, cells).strands.front())
             : shapes.density.front();
}

double turning_of(const Shapes& shapes) {
  double most = 0;
  for (const SpaceCurve& curve : shapes.at) {
    most = std::max(most, simulation::turning(curve).back());
  }
  return most;
}

}  // namespace tress::experiments::adaptive_mesh
