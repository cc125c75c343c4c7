#include "models/supports/point_moment.h"

#include <cmath>
#include <utility>

#include "contract/forms/material_points.h"
#include "contract/input_error.h"

namespace tress::models {
namespace {

/// The moment at the start for a factor of 1, world components.
Vec at_start(System& strand, const PointMoment& moment) {
  if (norm(moment.follower) == 0) return moment.dead;
  std::vector<double> q(static_cast<std::size_t>(strand.layout().coordinates)), v = q;
  strand.initial_state(q, v);
  return moment.dead +
         sections(strand)->section_frame(0, q, moment.point) * moment.follower;
}

/// The axis about which a supported section turns freely at all times, world components;
/// 0: none.
Vec free_axis(const Sections::Kind& section, const Support& support) {
  const Frame wall = support.path.at(0).frame;
  Vec axis;
  if (norm(support.hinge) > 0) {
    axis = wall * support.hinge;
  } else if (support.section == HeldPart::tangent &&
             section.turning == Sections::Turning::frame) {
    axis = wall.e0;
  }
  for (const RootMotion::Part& turn : support.path.rotations) {
    if (norm(cross(turn.direction, axis)) > 1e-9 * norm(turn.direction)) return {};
  }
  return axis;
}

/// Refuses components of a moment that can turn nothing in this model.
void check(System& strand, const PointMoment& moment, const std::string& where) {
  using enum Sections::Turning;
  Sections* const all = sections(strand);
  const Sections::Turning turning =
      all == nullptr ? nothing : all->section_kind(moment.point).turning;
  const int last = strand.material_points()->count() - 1;
  const bool at_end = moment.point == 0 || moment.point == last;
  refuse_if(turning == nothing,
            at_end ? "the model has no section there: the moment would act on a clamped "
                     "root, or on points that do not turn"
                   : "the direction of the model jumps at this point: a moment there "
                     "has no rotation on which it does work",
            where,
            at_end ? "give another place, or a model with sections, such as "
                     "\"super_helix\""
                   : "give at = 1, or use \"super_helix\" or \"super_clothoid\"");
  refuse_if(turning == tangent && norm(moment.follower) > 0,
            "the sections of the model have a direction but no twist: no axes that the "
            "moment could follow",
            where, "give moment_n_m alone, or a model with twist");
  if (turning != in_plane) return;
  const Frame section = [&] {
    std::vector<double> q(static_cast<std::size_t>(strand.layout().coordinates)), v = q;
    strand.initial_state(q, v);
    return all->section_frame(0, q, moment.point);
  }();
  const Vec whole = section.back(moment.dead) + moment.follower;
  const double across = std::hypot(whole.x, whole.z);
  refuse_if(across > 1e-9 * norm(whole),
            "a planar model turns about the normal of its plane only, and the moment has "
            "other components",
            where, "give a moment about that normal, or modes = \"bend_twist\"");
}

/// The moment after the checks, which must come before the section is taken.
PointMoment checked(System& strand, PointMoment moment, const std::string& where) {
  check(strand, moment, where);
  return moment;
}

}  // namespace

void refuse_on_half_edge(System& strand, const PointMoment& moment, const Vec& free_axis,
                         const std::string& where) {
  Sections* const all = sections(strand);
  if (all == nullptr || !all->section_kind(moment.point).half_edge) return;
  const Vec whole = at_start(strand, moment);
  const double length = norm(free_axis);
  const Vec held = length > 0
                       ? whole - (dot(whole, free_axis) / (length * length)) * free_axis
                       : whole;
  refuse_if(norm(held) > 1e-9 * norm(whole),
            "the section is held, and the edges of the model do not bend: the moment "
            "would act on an edge, half an element away",
            where,
            "leave the moment out, which the support or joint takes if it is rigid, or "
            "use \"super_helix\", \"super_clothoid\" or \"dynamic_spline\"");
}

void refuse_on_support(System& strand, const PointMoment& moment, const Support& support,
                       const std::string& where) {
  if (support.point != moment.point || support.section == HeldPart::nothing) return;
  refuse_on_half_edge(strand, moment,
                      free_axis(sections(strand)->section_kind(moment.point), support),
                      where);
}

MomentOnSection::MomentOnSection(System& strand, PointMoment moment, SparseForm* matrix,
                                 const std::string& where)
    : sections_(sections(strand)),
      moment_(checked(strand, std::move(moment), where)),
      section_(strand, moment_.point, {}, true, {}, matrix, where),
      zero_(static_cast<std::size_t>(strand.layout().coordinates)) {}

Vec MomentOnSection::at(double t, In q) {
  Vec sum = moment_.dead;
  if (norm(moment_.follower) > 0) {
    sum = sum + sections_->section_frame(t, q, moment_.point) * moment_.follower;
  }
  return moment_.factor(t) * sum;
}

/// b += factor J^T m.
void MomentOnSection::pull(double t, In q, double factor, InOut b) {
  sections_->add_moment(t, q, moment_.point, factor * at(t, q), b);
}

void MomentOnSection::add_tangent(double t, In q, double factor, InOut s) {
  if (factor == 0) return;
  section_.add_derivative(
      t, q, true, factor, [&](In x, InOut b) { pull(t, x, -1, b); }, s);
}

SectionLoad MomentOnSection::load(double t, In q) {
  SectionLoad made;
  made.point = moment_.point;
  made.moment = at(t, q);
  if (norm(moment_.follower) > 0) {
    const Vec follows =
        moment_.factor(t) *
        (sections_->section_frame(t, q, moment_.point) * moment_.follower);
    made.by_turn = cross_matrix<double>(-1.0 * follows);
  }
  return made;
}

double MomentOnSection::power(double t, In q, In v, const Vec& turning) {
  const Vec omega = sections_->section(t, q, v, zero_, moment_.point).omega;
  return dot(at(t, q), omega - turning);
}

}  // namespace tress::models
