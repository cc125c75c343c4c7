#pragma once

#include <optional>
#include <string>
#include <vector>

#include "simulation/run/world.h"
#include "simulation/scene/support_table.h"

namespace tress::simulation {

/// One column of the time series, or one number per material point for pictures.
struct Reading {
  std::string name;  // with its unit
  std::string help;  // meaning
};

/// One instant of a scene for output and display.
struct Frame3d {
  std::vector<double> series;         // as Readout::series()
  std::vector<float> positions;       // (3 points) m, points as Readout::lines()
  std::vector<float> channels;        // (points) of the first channel, of the second ...
  std::vector<float> contacts;        // (6 contacts) place, m, and force on the strand, N
  std::vector<float> reactions = {};  // the same of supports that hold a place
};

/// Force and moment of a support on its strand, or of a joint on its end b.
struct NamedLoad {
  std::string name;           // of the support or joint
  std::optional<Vec> force;   // N; none: it holds no place
  std::optional<Vec> moment;  // N m; none: it holds no direction
};

/// Output of a scene: positions and energies of its strands, loads of its effects.
class Readout {
 public:
  /// `world`: any of this scene.
  Readout(const Scene& scene, const World& world);

  /// Returns the number of points of each line that is drawn, in the order of Frame3d's.
  /// A line is a strand, or a chain of segments of a tree, which begins at the point of
  /// attachment.
  const std::vector<int>& lines() const { return lines_; }
  /// Returns the number of points that are drawn.
  std::size_t points() const { return drawn_.size(); }

  /// Returns the columns of the time series.
  const std::vector<Reading>& series() const { return series_; }
  /// Returns the numbers at every point.
  const std::vector<Reading>& channels() const { return channels_; }
  /// Reads the present state of a world.
  Frame3d read(World& world);
  /// Returns the forces and moments of all supports and joints in a frame.
  std::vector<NamedLoad> support_loads(const Frame3d& frame) const;
  /// The next World counts its steps from 0.
  void restart() {
    before_ = {};
    steps_before_.clear();
  }
  /// Numbers of all material points as those of the points that are drawn.
  std::vector<float> at_drawn(const std::vector<float>& of_points) const;

 private:
  void find_lines(const World& world);
  void read_points(World& world, Frame3d& frame);
  void read_steps(const World& world, double interval, Frame3d& frame);
  void read_loads(World& world, std::size_t k, std::size_t first,
                  std::span<const ContactForce> contacts, Frame3d& frame);

  const Scene& scene_;
  std::vector<int> lines_;
  std::vector<std::size_t> drawn_;  // material points, line after line
  std::vector<Reading> series_, channels_;
  Effects effects_;
  std::vector<NamedSupport> supports_;  // then the joints
  std::size_t first_load_ = 0;          // of a support, among the columns
  std::vector<Lumps> lumps_;            // of each strand
  std::vector<double> tangent_;
  std::optional<std::size_t> step_channel_;
  // At the last frame.
  Stats before_;
  std::vector<long> steps_before_;
};

}  // namespace tress::simulation
