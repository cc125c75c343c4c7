#pragma once

#include <string>
#include <vector>

#include "experiments/scenes/world.h"

namespace tress {

/// One column of the time series, or one number per material point for pictures.
struct Reading {
  std::string name;  // with its unit
  std::string help;
};

/// One instant of a scene, as it is written and shown.
struct Frame3d {
  std::vector<double> series;    // as Readout::series()
  std::vector<float> positions;  // (3 points) m
  std::vector<float> channels;   // (points) of the first channel, of the second ...
};

/// What is told of a scene: places and energies of its strands, what its effects do.
/// Energies by kind come from twins of every strand that have no effect, or one alone, so
/// that they are exactly those that the model itself counts.
class Readout {
 public:
  explicit Readout(const Scene& scene);

  const std::vector<Reading>& series() const { return series_; }
  const std::vector<Reading>& channels() const { return channels_; }
  Frame3d read(World& world);
  /// The next World counts its steps from 0.
  void restart() { before_ = {}; }

 private:
  struct Twins {
    std::unique_ptr<System> bare;
    std::vector<std::unique_ptr<System>> with;  // one effect each
  };

  void read_energies(World& world, std::vector<double>& row);
  void read_points(World& world, Frame3d& frame);
  void read_loads(World& world, std::size_t k, std::size_t first, Frame3d& frame);

  const Scene& scene_;
  std::vector<Reading> series_, channels_;
  std::vector<Twins> twins_;
  Effects effects_;
  std::vector<std::vector<double>> mass_, length_;  // lumped at each strand's points
  std::vector<double> tangent_;
  Stats before_;
};

}  // namespace tress
