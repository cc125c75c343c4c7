#pragma once

#include <compare>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "experiments/head_accuracy/curves.h"
#include "simulation/scene/scene.h"

namespace tress::experiments::head_accuracy {

using namespace simulation;

/// Compared times and hairs, and the resolution of the reference.
struct Comparison {
  double rate = 60;          // frames per second
  double horizon = 0.5;      // s, at most the scene's
  std::size_t hairs = 5000;  // looked at: a groom of more is thinned
  int elements = 32;         // of the finest run of the reference
  int substeps = 32;         // the same of steps per frame
  int threads = 1;
};

/// Settings with which a groom is computed.
struct Choice {
  std::size_t guides =
      0;  // simulated hairs: of all, if it is all, else of those looked at
  int elements = 0, substeps = 0;
  int bits = 64;
  auto operator<=>(const Choice&) const = default;
};

/// One run.
struct HeadTrial {
  Choice choice;
  Spread all;            // errors of every hair
  Spread interpolation;  // the same if guides were as in the reference
  Spread simulated;      // errors of the guides alone: of elements and steps
  double step_s = 0;     // wall time a frame: all steps
  double follow_s = 0;   // the same: reading the points, and the hairs that follow
  double bytes = 0;      // memory of guides and of hairs that follow
};

/// Throws InputError, naming the file, unless the scene runs as a head (no_head()) and
/// all its strands come from grooms. The scene is an outline's.
Scene read_head_scene(const std::string& file);

/// Runs a scene's batch by any choice and compares every hair with a fine run of every
/// hair. The combination x(h, n) = 2 x(h) - x(2 h) lacks the error of
/// linearly_implicit_euler in first order of its step h. The combination x(h, n) + (x(h,
/// n) - x(2 h, n/2))/3 lacks that of n elements in second order. Guides and followers are
/// those that `guides` and `elements` of the groom would give (choose_guides,
/// hair_that_follows).
class HeadMeasure {
 public:
  /// Computes the reference and one of half its elements and twice its steps. Throws
  /// std::runtime_error where hairs are lost.
  HeadMeasure(const Scene& given, const Comparison& comparison);

  std::size_t hairs() const { return lengths_.size(); }  // looked at
  std::size_t all_hairs() const { return all_; }         // of the scene
  double horizon() const { return static_cast<double>(frames_) / comparison_.rate; }
  const Comparison& comparison() const { return comparison_; }
  /// Returns the work of a step of an element over that of a straight one, as measured.
  /// Elements that wind farther take more quadrature points, and beyond 1.5 rad longer
  /// series.
  double element_work(int elements) const;
  /// Returns the change by the last extrapolation of the reference: a bound of its
  /// error if errors fall as assumed.
  const Spread& gap() const { return gap_; }

  /// Empty where hairs are lost.
  std::optional<HeadTrial> trial(const Choice& choice) const;
  /// Returns the errors of all hairs if `guides` guides moved as in the reference.
  Spread interpolation(std::size_t guides, int elements) const;
  /// Returns the errors of `hairs` hairs, each simulated; infinite where some failed.
  Spread simulated(std::size_t hairs, int elements, int substeps, int bits) const;

 private:
  struct Run;
  class Followers;
  Scene cut(int elements) const;
  /// Returns the guides of a scene with this mesh, computed once.
  const std::vector<std::size_t>& guides(const Scene& cut, std::size_t number) const;
  HairCurves curves(int elements, int substeps) const;
  /// use(instant, t, points of all strands), after t = 0.
  template <class Use>
  Run moved(const Scene& scene, int substeps, int bits, const Use& use) const;
  Spread of_all(const HairErrors& errors, const std::vector<std::size_t>& guides) const;

  Comparison comparison_;
  Scene whole_;  // every strand simulated
  std::size_t all_;
  std::size_t frames_, stride_;  // frames from one compared instant to the next
  std::vector<double> lengths_;  // m
  double winding_ = 0;           // of a whole hair, at most (rad)
  HairCurves reference_;
  Spread gap_;
  mutable std::map<std::pair<std::size_t, int>, std::vector<std::size_t>> guides_;
};

}  // namespace tress::experiments::head_accuracy
