#include "models/strand/geometry.h"

#include <cmath>

#include "contract/input_error.h"
#include "math/helix.h"

namespace tress::models {
namespace {

/// y -> along_y y + along_u darboux x y + along_z darboux x (darboux x y).
struct Turned {
  const Vec& darboux;
  Vec operator()(double along_y, double along_u, double along_z, const Vec& y) const {
    const Vec u = cross(darboux, y);
    return along_y * y + along_u * u + along_z * cross(darboux, u);
  }
};

constexpr Vec e0{1, 0, 0}, e1{0, 1, 0}, e2{0, 0, 1};

HelixFunctions<double> functions(const Vec& turning, double s) {
  return helix_functions(s, dot(turning, turning), s);
}

/// The end of a helix of constant Darboux vector (math/helix.h) that starts at `from`.
StrandPlace along(const StrandPlace& from, const Vec& darboux, double s) {
  const HelixFunctions<double> f = functions(darboux, s);
  return {from.x + from.frame * Turned{darboux}(s, f.A, f.B, e0),
          from.frame * helix_turn(darboux, s)};
}

const Vec& darboux(const Segment& segment, ShapeOf shape) {
  return shape == ShapeOf::natural ? segment.natural : segment.initial;
}

}  // namespace

Frame helix_turn(const Vec& darboux, double s) {
  const HelixFunctions<double> f = functions(darboux, s);
  const Turned turned{darboux};
  return {turned(1, f.S, f.A, e0), turned(1, f.S, f.A, e1), turned(1, f.S, f.A, e2)};
}

StrandPlace root_place(const Strand& strand) {
  if (strand.free_root) return {strand.free_root->position, strand.free_root->frame};
  const RootPose pose = strand.root.at(0);
  return {pose.x, pose.frame};
}

Frame half_turn(const Segment& segment, ShapeOf shape, bool tip) {
  return helix_turn(darboux(segment, shape), (tip ? 0.5 : -0.5) * segment.length);
}

Frame strain_of_half(const Segment& segment, bool tip) {
  if (norm(segment.initial - segment.natural) == 0) return {};
  return inverse(half_turn(segment, ShapeOf::natural, tip)) *
         half_turn(segment, ShapeOf::initial, tip);
}

Frame chord_at_end(const Segment& segment, ShapeOf shape, bool tip) {
  const StrandPlace end = along({}, darboux(segment, shape), segment.length);
  const Vec chord = (1 / norm(end.x)) * (tip ? end.frame.back(end.x) : end.x);
  const Vec axis = cross(e0, chord);
  const double sine = norm(axis);
  if (sine == 0) return {};
  return rotation((1 / sine) * axis, std::atan2(sine, chord.x));
}

std::vector<StrandPlace> joints(const Strand& strand, ShapeOf shape,
                                const StrandPlace& root) {
  std::vector<StrandPlace> places{root};
  for (const Segment& segment : strand.segments) {
    places.push_back(along(places.back(), darboux(segment, shape), segment.length));
  }
  return places;
}

std::vector<StrandPlace> middles(const Strand& strand, ShapeOf shape,
                                 const StrandPlace& root) {
  std::vector<StrandPlace> places = joints(strand, shape, root);
  places.pop_back();
  for (std::size_t i = 0; i < places.size(); ++i) {
    const Segment& segment = strand.segments[i];
    places[i] = along(places[i], darboux(segment, shape), segment.length / 2);
  }
  return places;
}

void check_unbranched(const Strand& strand, const std::string& model) {
  check(strand);
  for (std::size_t i = 0; i < strand.segments.size(); ++i) {
    const Segment& segment = strand.segments[i];
    const bool straight_on = segment.mount.e0.x == 1 && segment.mount.e1.y == 1;
    if (segment.parent != static_cast<int>(i) - 1 || !straight_on) {
      throw InputError("segment " + std::to_string(i) + " branches off", model,
                       "give a chain of segments, or use super_helix_tree");
    }
  }
}

}  // namespace tress::models
