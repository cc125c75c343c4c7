// Readouts of a rod in rotation vectors: those of the rod at its quaternions.
#include <algorithm>

#include "models/quaternion_rods/rotation_vectors.h"

namespace tress::models {

std::string RotationVectors::not_finite(double t, In q, In v) {
  place(q, v);
  return rod_->not_finite(t, q_, v_);
}

Energy RotationVectors::energy(double t, In q, In v) {
  place(q, v);
  return rod_->energetics()->energy(t, q_, v_);
}

std::optional<Momentum> RotationVectors::momentum(double t, In q, In v) {
  place(q, v);
  return rod_->energetics()->momentum(t, q_, v_);
}

double RotationVectors::power(double t, In q, In v) {
  place(q, v);
  return rod_->energetics()->power(t, q_, v_);
}

void RotationVectors::positions(double t, In q, Out x) {
  place(q);
  points_->positions(t, q_, x);
}

void RotationVectors::velocities(double t, In q, In v, Out u) {
  place(q, v);
  points_->velocities(t, q_, v_, u);
}

void RotationVectors::accelerations(double t, In q, In v, In a, Out x) {
  place(q, v, a);
  accelerations_->accelerations(t, q_, v_, a_, x);
}

std::optional<double> RotationVectors::stretch(double t, In q) {
  place(q);
  return points_->stretch(t, q_);
}

std::optional<std::array<double, 9>> RotationVectors::end_frame(double t, In q) {
  place(q);
  return points_->end_frame(t, q_);
}

/// A section of the rod turns with nodes or with one quaternion.
std::vector<int> RotationVectors::section_coordinates(int point) const {
  std::vector<int> all = sections_->section_coordinates(point);
  if (static_cast<std::size_t>(all.front()) < first_) return all;
  const std::size_t edge = (static_cast<std::size_t>(all.front()) - first_) / 4;
  all.pop_back();
  for (std::size_t k = 0; k < 3; ++k) all[k] = static_cast<int>(at(edge) + k);
  return all;
}

Frame RotationVectors::section_frame(double t, In q, int point) {
  place(q);
  return sections_->section_frame(t, q_, point);
}

SectionMotion RotationVectors::section(double t, In q, In v, In a, int point) {
  place(q, v, a);
  return sections_->section(t, q_, v_, a_, point);
}

void RotationVectors::add_moment(double t, In q, int point, const Vec& moment, InOut b) {
  place(q);
  std::ranges::fill(force_, 0.0);
  sections_->add_moment(t, q_, point, moment, force_);
  for (std::size_t k = 0; k < first_; ++k) b[k] += force_[k];
  for (std::size_t e = 0; e < edges(); ++e) {
    const Vec own = rotations_[e].pull_back(relative(force_, e));
    store3(load3(&b[at(e)]) + own, &b[at(e)]);
  }
}

}  // namespace tress::models
