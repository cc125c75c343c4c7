#pragma once

#include <optional>
#include <string>
#include <vector>

#include "contract/forms/material_points.h"
#include "contract/forms/point_accelerations.h"
#include "models/joints/joint.h"
#include "models/supports/held_section.h"

namespace tress::models {

/// One end of a joint: a material point of a strand and the section there. Vectors are
/// those of all strands, one after the other.
class JointEnd {
 public:
  /// `strand` must outlive it; `first` is its first coordinate among those of all
  /// strands. Throws InputError naming `where` if the model has no such point, does not
  /// compute its acceleration, or its point cannot move.
  JointEnd(System& strand, std::size_t first, int point, const std::string& where);
  /// Prepares the frame of the section for joints that turn it. Throws InputError naming
  /// `where` if the model has no frame there.
  void hold_section(const std::string& where);

  /// Lets a half edge follow a natural turn (NaturalMotion::turn) that must outlive this.
  void follow(const Frame& turn) { natural_ = &turn; }

  /// Returns the first coordinate of the strand.
  std::size_t first() const { return first_; }
  /// Returns the number of coordinates of the strand.
  std::size_t size() const { return size_; }
  /// Returns the material point.
  int point() const { return point_; }
  /// Returns true if an elastic half edge lies between the frame and the section.
  bool half_edge() const { return section_ && section_->half_edge(); }

  /// Returns the place of the point, m.
  Vec place(double t, In q);
  /// Returns the velocity of the point, m/s.
  Vec velocity(double t, In q, In v);
  /// Returns the acceleration of the point, m/s^2.
  Vec acceleration(double t, In q, In v, In a);
  /// Returns the frame of the section.
  Frame frame(double t, In q) { return naturally(of_model(t, q)); }
  /// Returns the frame of the section where half an edge has the natural shape of the
  /// model, whatever it has at t.
  Frame of_model(double t, In q) { return sections_->section_frame(t, part(q), point_); }
  /// Returns the motion of the section.
  SectionMotion section(double t, In q, In v, In a) {
    SectionMotion m = sections_->section(t, part(q), part(v), part(a), point_);
    m.frame = naturally(m.frame);
    return m;
  }

  /// b += J^T force.
  void add_force(double t, In q, const Vec& force, InOut b);
  /// b += J^T moment.
  void add_moment(double t, In q, const Vec& moment, InOut b) {
    sections_->add_moment(t, part(q), point_, moment, part(b));
  }
  /// s += factor d(J^T moment)/dq of a constant moment, where s is the strand's matrix.
  void add_curvature(double t, In q, const Vec& moment, double factor, InOut s);

 private:
  Frame naturally(const Frame& section) const {
    return natural_ == nullptr ? section : section * *natural_;
  }
  template <class Span>
  Span part(Span all) const {
    return all.subspan(first_, size_);
  }

  System& strand_;
  MaterialPoints& points_;
  PointAccelerations& accelerations_;
  Sections* sections_;
  std::size_t first_, size_;
  int point_;
  const Frame* natural_ = nullptr;  // turn of a half edge whose natural shape moves
  std::optional<HeldSection> section_;
  std::vector<double> x_;  // scratch
};

}  // namespace tress::models
