#pragma once

#include <string>
#include <vector>

#include "contract/forms/sections.h"
#include "contract/forms/sparse_form.h"
#include "models/motion/root_motion.h"
#include "models/supports/section_gap.h"

namespace tress::models {

/// Step of central differences in units of typical sizes: the cube root of the roundoff.
inline constexpr double difference_step = 6e-6;

/// Returns the kind of the section at a point of a strand. Throws InputError naming
/// `where` if the model has none there.
Sections::Kind section_to_hold(System& strand, int point, const std::string& where);

/// Section of a strand that a support turns, with its rotation from the path's frame
/// (SectionGap). Components of the rotation that are not held are free. With a hinge,
/// both frames have the axis of the hinge as e1, and that component is free. A rotation
/// about e1 has no other component, whatever its angle.
class HeldSection {
 public:
  /// Holds the section at a point: all of its rotation, or its tangent alone, except a
  /// rotation about `hinge` (Support::hinge). Throws
  /// InputError naming `where` if the model does not determine the rotation. `strand`
  /// must outlive it; `matrix` is its S (null: full).
  HeldSection(System& strand, int point, RootMotion path, bool whole_frame,
              const Vec& hinge, SparseForm* matrix, const std::string& where);

  /// Returns the held components of the rotation: indices of its axes.
  const std::vector<int>& components() const { return components_; }
  /// Returns the coordinates that turn the section, ascending.
  const std::vector<int>& coordinates() const { return coordinates_; }
  /// Returns true if an elastic half edge lies between the model's frame and the section.
  bool half_edge() const { return half_edge_; }
  /// Lets the half edge follow a natural turn (NaturalMotion::turn) that must outlive
  /// this.
  void follow(const Frame& turn) { natural_ = &turn; }
  /// Returns the path whose frame holds the section.
  const RootMotion& path() const { return path_; }

  /// Returns the rotation of a section that the wall's frame sees in this frame.
  SectionGap seen(const Frame& section) {
    RootPose wall;
    wall.frame = axes_;
    return {turning_, wall, {naturally(section) * axes_, {}, {}}};
  }
  /// Returns the rotation, without its derivatives.
  SectionGap gap(double t, In q) { return {turning_, path_.at(t), at_rest(t, q)}; }
  /// Returns the rotation and its derivatives at a state.
  SectionGap gap(double t, In q, In v, In a) {
    return {turning_, path_.at(t), moving(t, q, v, a)};
  }
  /// b += J^T moment of a stress on the rotation at a state.
  void pull(double t, In q, const SectionGap& gap, const Vec& stress, InOut b) {
    sections_->add_moment(t, q, point_, gap.moment(stress), b);
  }

  /// Returns the moment of a stress on the rotation at a state, as section_load().
  SectionLoad load(double t, In q, In v, In a, const Vec& stress, const Vec& stiffness,
                   const Vec& friction) {
    return load(t, moving(t, q, v, a), stress, stiffness, friction);
  }
  /// Returns that of a constant stress.
  SectionLoad load(double t, In q, const Vec& stress) {
    return load(t, at_rest(t, q), stress, {}, {});
  }

  /// Adds factor d force/dx to s, by central differences. `force`(x, b) adds to the
  /// entries of b at the section's coordinates. With `of_places`, x is q, in steps that
  /// turn the section by difference_step; else any vector, in steps of one. Relative
  /// error 1e-10.
  template <class Force>
  void add_derivative(double t, In x, bool of_places, double factor, Force force,
                      InOut s) {
    if (of_places) find_steps(t, x);
    shifted_.assign(x.begin(), x.end());
    const std::size_t count = coordinates_.size();
    for (std::size_t k = 0; k < count; ++k) {
      const auto column = static_cast<std::size_t>(coordinates_[k]);
      const double step = of_places ? steps_[k] : 1;
      for (const int i : coordinates_) change_[static_cast<std::size_t>(i)] = 0;
      shifted_[column] = x[column] - step;
      force(shifted_, change_);
      for (const int i : coordinates_) change_[static_cast<std::size_t>(i)] *= -1;
      shifted_[column] = x[column] + step;
      force(shifted_, change_);
      shifted_[column] = x[column];
      for (std::size_t i = 0; i < count; ++i) {
        const auto row = static_cast<std::size_t>(coordinates_[i]);
        const std::size_t entry =
            entries_.empty() ? column * x.size() + row : entries_[k * count + i];
        s[entry] += factor / (2 * step) * change_[row];
      }
    }
  }

 private:
  SectionLoad load(double t, const SectionMotion& at, const Vec& stress,
                   const Vec& stiffness, const Vec& friction) {
    SectionLoad made =
        section_load(turning_, path_.at(t), at, stress, stiffness, friction);
    made.point = point_;
    return made;
  }
  SectionMotion at_rest(double t, In q) {
    return {naturally(sections_->section_frame(t, q, point_)) * axes_, {}, {}};
  }
  SectionMotion moving(double t, In q, In v, In a) {
    SectionMotion all = sections_->section(t, q, v, a, point_);
    all.frame = naturally(all.frame) * axes_;
    return all;
  }
  Frame naturally(const Frame& section) const {
    return natural_ == nullptr ? section : section * *natural_;
  }
  void find_entries(const Pattern& matrix, const std::string& where);
  void find_steps(double t, In q);

  Sections* sections_;
  int point_;
  RootMotion path_;
  Frame axes_;  // in components of the section, and of the path's frame before
  Sections::Turning turning_;
  bool half_edge_;
  const Frame* natural_ = nullptr;  // turn of a half edge whose natural shape moves
  std::vector<int> components_, coordinates_;
  // Of the coordinates' block in S, by columns; empty: S is full.
  std::vector<std::size_t> entries_;
  std::vector<double> q_typ_, steps_, shifted_, change_;
};

}  // namespace tress::models
