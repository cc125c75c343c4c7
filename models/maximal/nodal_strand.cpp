#include "models/maximal/nodal_strand.h"

#include <algorithm>
#include <cmath>

#include "models/constrained/curve.h"
#include "models/constrained/joints.h"
#include "models/maximal/rod_edge.h"

namespace tress::models {
namespace {

/// The path of a point fixed to the root's frame, for constraints.
class RootPath final : public Curve {
 public:
  RootPath(RootMotion motion, const Vec& offset)
      : motion_(std::move(motion)), offset_(offset) {}
  CurvePoint at(double t) const noexcept override { return RootPath::at(t, by_time); }
  CurvePoint at(double t, double since) const noexcept override {
    const RootPose pose = motion_.at(t, since);
    const Vec d = pose.frame * offset_, turned = cross(pose.omega, d);
    return {pose.x + d,
            pose.v + turned,
            pose.a + cross(pose.alpha, d) + cross(pose.omega, turned),
            {}};
  }

 private:
  RootMotion motion_;
  Vec offset_;
};

std::vector<Frame> edge_frames(const Strand& strand, ShapeOf shape,
                               const StrandPlace& root) {
  const std::vector<StrandPlace> ends = joints(strand, shape, root);
  const std::vector<StrandPlace> between = middles(strand, shape, root);
  std::vector<Frame> frames;
  for (std::size_t i = 0; i < between.size(); ++i) {
    frames.push_back(edge_frame(between[i].frame, ends[i + 1].x - ends[i].x, 0.0));
  }
  return frames;
}

}  // namespace

RootStart root_start(const Strand& strand) {
  if (strand.free_root) {
    const FreeRoot& root = *strand.free_root;
    return {{root.position, root.frame}, root.velocity, root.spin};
  }
  const RootPose pose = strand.root.at(0);
  return {{pose.x, pose.frame}, pose.v, pose.omega};
}

double typical_rate(const Strand& strand) {
  constexpr double earth = 10;  // m/s^2
  const double length = strand.length();
  const Segment& first = strand.segments.front();
  const double stiffness = strand.material_of(first).youngs_modulus *
                           std::min(first.section.inertia1(), first.section.inertia2());
  return std::sqrt(earth / length +
                   stiffness * length / (strand.mass() * std::pow(length, 4)));
}

NodalStrand::NodalStrand(const Strand& strand, const std::string& model,
                         std::size_t others) {
  check_unbranched(strand, model);
  root = root_start(strand);
  initial = edge_frames(strand, ShapeOf::initial, root.place);
  natural = edge_frames(strand, ShapeOf::natural, root.place);
  const Frame& last = natural.back();
  const Frame tip = joints(strand, ShapeOf::natural, root.place).back().frame;
  parts.to_tip = {last.back(tip.e0), last.back(tip.e1), last.back(tip.e2)};
  const Frame& first = natural.front();
  parts.to_root = {first.back(root.place.frame.e0), first.back(root.place.frame.e1),
                   first.back(root.place.frame.e2)};
  parts.clamped = !strand.free_root.has_value();
  parts.root = strand.root;
  const std::size_t nodes = initial.size() + 1, coordinates = 3 * nodes;
  parts.nodes = static_cast<int>(nodes);
  parts.z.assign(coordinates + others, 0.0);
  parts.rate = parts.z;
  // The relevant scale of a node is its distance from its neighbours.
  const double edge = strand.length() / static_cast<double>(initial.size());
  const double rate = typical_rate(strand);
  parts.z_typ.assign(coordinates, edge);
  parts.z_typ.resize(coordinates + others, 1.0);
  parts.z_rate = parts.z_typ;
  for (double& speed : parts.z_rate) speed *= rate;
  parts.inertia.assign(others, 0.0);
  for (const Segment& segment : strand.segments) parts.edges.push_back(segment.length);
  Vec x = root.place.x;
  for (std::size_t i = 0; i < nodes; ++i) {
    store3(x, &parts.z[3 * i]);
    store3(root.velocity_of(x), &parts.rate[3 * i]);
    if (i + 1 < nodes) x = x + strand.segments[i].length * initial[i].e0;
    double mass = 0, carried = 0;
    for (const std::size_t k : {i, i + 1}) {  // segments on either side
      if (k == 0 || k > strand.segments.size()) continue;
      const Segment& segment = strand.segments[k - 1];
      carried += segment.length / 2;
      mass += strand.material_of(segment).density * segment.section.area() *
              segment.length / 2;
    }
    const NodeMean at{.first = static_cast<int>(i)};
    parts.mass.push_back({at, mass, carried, parts.length});
    if (i + 1 < nodes) parts.length += strand.segments[i].length;
    parts.shown.push_back(at);
  }
}

Anchor root_anchor(const RootMotion& motion, const Vec& offset) {
  return {{}, std::make_shared<RootPath>(motion, offset)};
}

Node constraint_node(const MaximalStrand& strand, int i) {
  if (!strand.clamped) return {Node::Kind::particle, i};
  return i == 0 ? Node{Node::Kind::anchor, 0} : Node{Node::Kind::particle, i - 1};
}

std::unique_ptr<ConstraintSet> inextensible(const MaximalStrand& parts,
                                            const Strand& strand) {
  Constraints constraints;
  for (std::size_t i = 0; i < strand.segments.size(); ++i) {
    const auto node = static_cast<int>(i);
    constraints.push_back(distance(constraint_node(parts, node),
                                   constraint_node(parts, node + 1),
                                   strand.segments[i].length));
  }
  std::vector<Anchor> anchors;
  if (parts.clamped) anchors.push_back(root_anchor(parts.root, {}));
  const int particles = parts.nodes - (parts.clamped ? 1 : 0);
  const int others = static_cast<int>(parts.z.size()) - 3 * parts.nodes;
  return std::make_unique<ConstraintSet>(std::move(constraints), std::move(anchors),
                                         particles, others, strand.length());
}

LinearKind maximal_solver(const Parameters& parameters) {
  const std::string_view word = parameters.word("solver");
  if (word == "banded") return LinearKind::banded;
  return word == "klu" ? LinearKind::klu : LinearKind::automatic;
}

}  // namespace tress::models
