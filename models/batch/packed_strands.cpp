#include "models/batch/packed_strands.h"

#include <algorithm>
#include <string>

#include "contract/input_error.h"

namespace tress::models {
namespace {

constexpr std::size_t width = Pack::lanes;

constexpr const char* place = "batch of strands";

/// Quadrature points per segment, equal for all segments of a strand.
int points(const ReducedStrand& strand) {
  const ReducedSegment& segment = strand.segments.front();
  return Pack::lanes * static_cast<int>(segment.last_block - segment.first_block);
}

void check_alike(const std::vector<ReducedStrand>& strands) {
  const ReducedStrand& first = strands.front();
  refuse_if(
      first.jacobian != ReducedJacobian::elastic || first.method != TreeMethod::recursive,
      "only the elastic Jacobian is solved for several strands at once, recursively",
      place, "use jacobian = elastic and solver = recursive");
  for (const ReducedStrand& strand : strands) {
    refuse_if(strand.free_root.has_value(), "a free root", place, "clamp all roots");
    refuse_if(!std::ranges::equal(strand.segments, first.segments, {},
                                  &ReducedSegment::parent, &ReducedSegment::parent),
              "strands of different segments", place,
              "cut all into equally many segments, hanging on one another alike");
  }
}

ReducedSegmentOf<Pack> packed_segment(const std::vector<const ReducedStrand*>& strands,
                                      std::size_t i) {
  ReducedSegmentOf<Pack> all;
  all.parent = strands.front()->segments[i].parent;
  for (int lane = 0; lane < Pack::lanes; ++lane) {
    const ReducedSegment& one = strands[static_cast<std::size_t>(lane)]->segments[i];
    all.mounted = all.mounted || one.mounted;
    set_lane(all.length, lane, one.length);
    set_lane(all.mount, lane, one.mount);
    set_lane(all.rotor, lane, one.rotor);
    set_lane(all.held, lane, one.held);
    set_lane(all.rest, lane, one.rest);
    set_lane(all.initial, lane, one.initial);
    set_lane(all.stiffness, lane, one.stiffness);
    set_lane(all.friction, lane, one.friction);
    set_lane(all.inertia, lane, one.inertia);
  }
  return all;
}

/// Point `point` of all strands.
PointBlock packed_point(const std::vector<const ReducedStrand*>& strands,
                        std::size_t point) {
  PointBlock all;
  for (int lane = 0; lane < Pack::lanes; ++lane) {
    const PointBlock& four =
        strands[static_cast<std::size_t>(lane)]->blocks[point / width];
    const int at = static_cast<int>(point % width);
    all.s.set(lane, four.s[at]);
    all.mass.set(lane, four.mass[at]);
    all.length.set(lane, four.length[at]);
  }
  return all;
}

}  // namespace

ReducedOptions with_same_points(std::span<const Strand> strands, Unknown unknown,
                                ReducedOptions options) {
  int most = 0;
  for (const Strand& strand : strands) {
    most = std::max(most, points(reduced_strand(strand, unknown, options, {})));
  }
  options.quadrature = most;
  return options;
}

PackedStrands packed(std::span<const Strand> all_strands, Unknown unknown,
                     const ReducedOptions& options, std::vector<Effects> effects) {
  refuse_if(all_strands.empty() || all_strands.size() > width,
            std::to_string(all_strands.size()) + " strands", place, "give one to four");
  refuse_if(effects.size() != all_strands.size(),
            std::to_string(effects.size()) + " lists of effects for " +
                std::to_string(all_strands.size()) + " strands",
            place, "give every strand one, empty if nothing acts on it");
  std::vector<ReducedStrand> strands;
  for (const Strand& strand : all_strands) {
    strands.push_back(reduced_strand(strand, unknown, options, {}));
  }
  check_alike(strands);
  std::vector<const ReducedStrand*> in_lanes;
  PackedStrands all;
  for (std::size_t lane = 0; lane < width; ++lane) {
    in_lanes.push_back(&strands[lane < strands.size() ? lane : 0]);
    all.roots.push_back(in_lanes.back()->root);
    all.root_rotor.set(static_cast<int>(lane), in_lanes.back()->root_rotor);
  }
  all.effects = std::move(effects);
  for (std::size_t i = 0; i < strands.front().segments.size(); ++i) {
    const ReducedSegment& first = strands.front().segments[i];
    ReducedSegmentOf<Pack> segment = packed_segment(in_lanes, i);
    segment.first_block = all.blocks.size();
    for (std::size_t p = width * first.first_block; p < width * first.last_block; ++p) {
      all.blocks.push_back(packed_point(in_lanes, p));
    }
    segment.last_block = all.blocks.size();
    all.segments.push_back(segment);
  }
  return all;
}

}  // namespace tress::models
