#include "simulation/driven/body_joints.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>

#include "contract/input_error.h"
#include "models/joints/joined_system.h"
#include "models/strand/geometry.h"

namespace tress::simulation {
namespace {

using models::JointKind;

/// Refuses supports that a driven body does not admit.
void check(const Table& table) {
  const Parameters& values = table.values();
  const std::string on = fmt::format("on '{}', which strands drive", values.word("on"));
  refuse_if(values.word("kind") == "direction",
            "a support with kind = \"direction\" " + on, table.place("kind"),
            "give kind = \"ball\", \"clamp\" or \"hinge\"");
  for (const char* key : {"stiffness_n_per_m", "turn_stiffness_n_m_per_rad"}) {
    refuse_if(values.number(key) > 0, fmt::format("{} of a support {}", key, on),
              table.place(key), "leave it out");
  }
}

JointKind kind_of(const Table& table) {
  const std::string_view kind = table.values().word("kind");
  return kind == "ball"    ? JointKind::ball
         : kind == "hinge" ? JointKind::hinge
                           : JointKind::weld;
}

/// A body has no half edge: an infinite stiffness in series.
models::RodJoint rigid() {
  constexpr double most = std::numeric_limits<double>::infinity();
  return {{}, {most, most, most}, {most, most, most}};
}

}  // namespace

void prepare_half(const models::Strand& strand, const models::SupportedSystem& held,
                  int point, models::RodJoint& half, std::optional<Frame>& begin) {
  const models::Segment& edge =
      point == 0 ? strand.segments.front() : strand.segments.back();
  half = models::rod_joint(strand, nullptr, edge, {});
  if (!held.begins_elsewhere()) begin = models::strain_of_half(edge, point > 0);
}

std::size_t add_body_joints(std::span<const PointOnBody> supports,
                            const models::Effects& effects, JoinedStrands to) {
  if (supports.empty()) return 0;
  const auto bodies = models::driven_bodies(effects);
  models::TypicalMotion typical{0, 0};
  for (const auto& strand : to.held) {
    const models::TypicalMotion own = models::typical_motion(*strand);
    typical = {std::max(typical.length, own.length), std::max(typical.rate, own.rate)};
  }
  const std::size_t strands = to.held.size();
  std::map<std::size_t, std::unique_ptr<models::BodySystem>> made;  // by number
  for (const auto& [support, at] : supports) {
    const auto& [table, number] = support;
    check(*table);
    auto& body = made[number];
    if (body) continue;
    body = models::make_body_system(*bodies[number], models::gravity_on_bodies(effects),
                                    typical);
  }
  for (std::size_t i = 0; i < supports.size(); ++i) {
    const auto& [support, at] = supports[i];
    const auto& [table, number] = support;
    const models::Strand& strand = *to.strands[at.strand];
    models::check_unbranched(strand, table->place());
    models::Joint joint{.kind = kind_of(*table)};
    joint.axis = table->values().vec("axis");
    joint.b = at;
    refuse_if(joint.b.point == 0 && !strand.free_root,
              "a support of the root, which is clamped", table->place("at"),
              "leave it out, or give [root] motion = \"free\"");
    const auto& held = to.held[at.strand]->rows().supports();
    const bool again =
        std::ranges::any_of(
            held, [&](const auto& one) { return one.point == joint.b.point; }) ||
        std::any_of(to.joints.end() - static_cast<std::ptrdiff_t>(i), to.joints.end(),
                    [&](const models::Joint& one) { return one.b == joint.b; });
    refuse_if(again, "a second support of the same point", table->place(),
              "leave out one of them");
    prepare_half(strand, *to.held[at.strand], joint.b.point, joint.half_b, joint.begin_b);
    const auto member = std::distance(made.begin(), made.find(number));
    const Vec place =
        load3(&to.points[at.strand][3 * static_cast<std::size_t>(joint.b.point)]);
    joint.a = {strands + static_cast<std::size_t>(member),
               made[number]->add_point(place)};
    joint.half_a = rigid();
    to.joints.push_back(joint);
  }
  for (auto& [number, body] : made)
    to.held.push_back(models::as_supported(std::move(body)));
  return made.size();
}

}  // namespace tress::simulation
