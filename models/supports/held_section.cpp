#include "models/supports/held_section.h"

#include <algorithm>

#include "contract/forms/material_points.h"
#include "contract/input_error.h"

namespace tress::models {

Sections::Kind section_to_hold(System& strand, int point, const std::string& where) {
  Sections* const all = sections(strand);
  const Sections::Kind kind =
      all == nullptr ? Sections::Kind{} : all->section_kind(point);
  if (kind.turning != Sections::Turning::nothing) return kind;
  const bool at_end = point == 0 || point + 1 == strand.material_points()->count();
  throw InputError(
      at_end ? "no coordinate of the model turns the section at this end"
             : "the direction of the model jumps at this point and cannot be held",
      where,
      at_end ? "use kind = \"ball\"; at a clamped root, a free root and a clamp of "
               "[[supports]]; or another model, such as super_helix"
             : "hold an end, or use [model] id = \"super_helix\" or \"super_clothoid\"");
}

HeldSection::HeldSection(System& strand, int point, RootMotion path, bool whole_frame,
                         const Vec& hinge, SparseForm* matrix, const std::string& where)
    : sections_(sections(strand)), point_(point), path_(std::move(path)) {
  using enum Sections::Turning;
  const Sections::Kind kind = section_to_hold(strand, point, where);
  turning_ =
      whole_frame ? kind.turning : (kind.turning == frame ? tangent : kind.turning);
  half_edge_ = kind.half_edge;
  components_ = turning_ == frame     ? std::vector{0, 1, 2}
                : turning_ == tangent ? std::vector{1, 2}
                                      : std::vector{1};
  if (norm(hinge) > 0) {
    refuse_if(turning_ == in_plane,
              "a hinge of a planar model, which turns about one axis only", where,
              "use kind = \"ball\"");
    axes_ = {{1, 0, 0}, hinge, cross({1, 0, 0}, hinge)};
    path_.frame = path_.frame * axes_;
    std::erase(components_, 1);
  }
  coordinates_ = sections_->section_coordinates(point);
  if (matrix != nullptr) find_entries(matrix->pattern(), where);
  const auto n = static_cast<std::size_t>(strand.layout().coordinates);
  for (auto* x : {&q_typ_, &change_}) x->assign(n, 0.0);
  strand.scale(q_typ_, change_);
  steps_.resize(coordinates_.size());
}

void HeldSection::find_entries(const Pattern& matrix, const std::string& where) {
  for (const int column : coordinates_) {
    const auto at = static_cast<std::size_t>(column);
    const auto from = matrix.row.begin() + matrix.start[at],
               to = matrix.row.begin() + matrix.start[at + 1];
    for (const int row : coordinates_) {
      const auto entry = std::find(from, to, row);
      refuse_if(entry == to,
                "the model's matrix does not couple the coordinates of a section", where,
                "use kind = \"ball\", or another model");
      entries_.push_back(static_cast<std::size_t>(entry - matrix.row.begin()));
    }
  }
}

void HeldSection::find_steps(double t, In q) {
  std::ranges::fill(steps_, 0.0);
  for (const Vec& axis : {Vec{1, 0, 0}, Vec{0, 1, 0}, Vec{0, 0, 1}}) {
    for (const int i : coordinates_) change_[static_cast<std::size_t>(i)] = 0;
    sections_->add_moment(t, q, point_, axis, change_);
    for (std::size_t k = 0; k < steps_.size(); ++k) {
      const double turn = change_[static_cast<std::size_t>(coordinates_[k])];
      steps_[k] = std::max(steps_[k], std::abs(turn));
    }
  }
  for (std::size_t k = 0; k < steps_.size(); ++k) {
    const double typical = q_typ_[static_cast<std::size_t>(coordinates_[k])];
    steps_[k] = difference_step / std::max(steps_[k], 1 / typical);
  }
}

}  // namespace tress::models
