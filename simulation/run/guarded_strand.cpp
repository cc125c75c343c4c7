#include "simulation/run/guarded_strand.h"

#include <algorithm>
#include <limits>

#include "models/reduced/trees.h"
#include "models/strand/strand_parameters.h"

namespace tress::simulation {
namespace {

/// Sum of the magnitudes of all uniform loads.
double uniform_load(const GuardedStrand& strand) {
  const std::vector<double> zeros(3 * strand.rest.size());
  const Points p = strand.lumps.points(zeros, zeros, zeros);
  std::vector<double> load(zeros.size());
  for (const auto& effect : strand.effects) {
    if (strand.uniform(*effect)) effect->add_load(0, p, load);
  }
  double sum = 0;
  for (std::size_t i = 0; i < load.size(); i += 3) sum += norm(load3(&load[i]));
  return sum;
}

double softest_bending(const Strand& strand) {
  double least = std::numeric_limits<double>::infinity();
  for (const Segment& segment : strand.segments) {
    const Vec moduli = stiffness(strand, segment);
    least = std::min({least, moduli.y, moduli.z});
  }
  return least;
}

Strand tree(const Parameters& parameters) {
  Strand made;
  made.material = material(parameters);
  made.segments = tree_segments(parameters.word("tree"));
  made.root = root_motion(parameters);
  made.free_root = free_root(parameters);
  return made;
}

}  // namespace

Lumps lumps(const Strand& strand) {
  Lumps all;
  all.mass.resize(strand.segments.size() + 1);
  all.length = all.mass;
  all.arc = all.mass;
  for (std::size_t i = 0; i < strand.segments.size(); ++i) {
    const Segment& segment = strand.segments[i];
    const std::size_t start =
        segment.parent < 0 ? 0 : static_cast<std::size_t>(segment.parent) + 1;
    all.arc[i + 1] = all.arc[start] + segment.length;
    all.longest = std::max(all.longest, all.arc[i + 1]);
    for (const std::size_t end : {start, i + 1}) {
      all.length[end] += segment.length / 2;
      all.mass[end] += strand.material_of(segment).density * segment.section.area() *
                       segment.length / 2;
    }
  }
  return all;
}

GuardedStrand guarded_strand(const Strand& strand, Effects effects) {
  GuardedStrand made;
  if (!strand.free_root && !strand.root.fixed()) made.root = strand.root;
  made.effects = std::move(effects);
  made.lumps = lumps(strand);
  made.rest.assign(1, 0.0);
  for (const Segment& segment : strand.segments) made.rest.push_back(segment.length);
  made.mass = strand.mass();
  made.weight_work = uniform_load(made) * strand.length();
  made.bending_energy = softest_bending(strand) / strand.length();
  return made;
}

std::vector<GuardedStrand> guarded_strands(const ModelEntry& model,
                                           const Parameters& parameters) {
  if (parameters.knows("tree")) {
    return {guarded_strand(tree(parameters), strand_effects(parameters))};
  }
  if (model.on_strand == nullptr) return {};
  return {guarded_strand(strand(parameters), strand_effects(parameters))};
}

}  // namespace tress::simulation
