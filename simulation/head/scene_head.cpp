#include "simulation/head/scene_head.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "contract/input_error.h"
#include "models/contact/contact_law.h"
#include "models/contact/strand_partners.h"
#include "models/reduced/reduced_strand.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/threads/crew.h"

namespace tress::simulation {
namespace {

using models::HeadOptions;

constexpr std::size_t parts = 64;  // of strands that are made at the same time

/// Whether what acts beside gravity and drag does no work in the frame of the head.
bool at_rest_in_head(const Scene& scene) {
  return std::ranges::all_of(scene.effects, [&](const EffectChoice& choice) {
    const auto effect = make_effect(scene, choice);
    return effect != nullptr && (effect->uniform_acceleration() || effect->viscosity() ||
                                 (effect->rigid_contact() != nullptr &&
                                  choice.parameters.word("moves") == "head"));
  });
}

HeadOptions options_of(const Scene& scene) {
  HeadOptions options;
  options.elements = static_cast<int>(scene.strands.front().segments.size());
  if (!steps_springs(scene)) {
    options.points = scene.model_options.whole("quadrature");
    options.twist = scene.model_options.word("modes") == "bend_twist";
    options.rotary_inertia = scene.model_options.word("rotary_inertia") == "on";
  }
  options.gravity = {};
  options.method = head_method(scene).value();
  options.newton_tolerance = scene.options.newton_tolerance;
  options.newton_iterations = scene.options.newton_iterations;
  options.tolerance = scene.options.tolerance;
  options.min_step = scene.options.min_step;
  options.motion = scene.head;
  options.effects = make_effects(scene);
  return with_uniform_effects(std::move(options));
}

std::unique_ptr<Head> empty_head(const Scene& scene, const HeadOptions& options,
                                 const HeadPack& pack) {
  return steps_springs(scene)  ? spring_head(options, pack)
         : steps_chains(scene) ? chain_head(options, pack)
                               : helix_head(options, pack);
}

/// Points of an element that winds by so much, as reduced_strand() takes them.
int points_of(const Scene& scene, double winding) {
  return steps_chains(scene) ? 4 : models::quadrature_points(winding);
}

/// Strands of a scene as a series.
struct Held {
  const std::vector<Strand>& strands;

  std::size_t size() const { return strands.size(); }
  const Strand& strand(std::size_t k) const { return strands[k]; }
};

/// Longest strand, largest angle that an element winds by.
struct Extent {
  double length = 0, winding = 0;

  void include(const Extent& other) {
    length = std::max(length, other.length);
    winding = std::max(winding, other.winding);
  }
  void include(const Strand& strand) {
    length = std::max(length, strand.length());
    for (const Segment& segment : strand.segments) {
      for (const Vec& shape : {segment.natural, segment.initial}) {
        winding = std::max(winding, segment.length * norm(shape));
      }
    }
  }
};

/// What has to be known of all strands of a scene before any is made into a head's; each
/// rank looks at its share of them.
template <class Strands>
Extent extent_of(const Strands& series, Crew& crew, Ranks& ranks, std::span<Vec> roots) {
  const auto rank = static_cast<std::size_t>(ranks.rank()),
             size = static_cast<std::size_t>(ranks.size());
  const auto first = [&](std::size_t r) { return series.size() * r / size; };
  std::vector<Extent> extents(parts);
  in_parts(crew, first(rank), first(rank + 1), parts,
           [&](std::size_t k, std::size_t part) {
             const Strand& strand = series.strand(k);
             extents[part].include(strand);
             if (!roots.empty()) roots[k] = strand.root.position;
           });
  Extent all;
  for (const Extent& extent : extents) all.include(extent);
  if (!roots.empty()) {
    std::vector<std::size_t> counts(size);
    for (std::size_t r = 0; r < size; ++r) counts[r] = first(r + 1) - first(r);
    ranks.share(roots, counts);
  }
  return {ranks.largest(all.length), ranks.largest(all.winding)};
}

/// make_head() for a StrandSeries, or for Held strands.
template <class Strands>
SceneHead head_of(const Scene& scene, const Strands& series, const HeadPack& pack,
                  int threads, Ranks& ranks, std::span<const double> cost) {
  Crew crew(threads);
  HeadOptions options = options_of(scene);
  const bool divided = ranks.size() > 1;
  if (divided && series.size() < static_cast<std::size_t>(ranks.size())) {
    throw InputError(fmt::format("{} strands for {} ranks", series.size(), ranks.size()),
                     scene.name, "give fewer ranks");
  }
  // Strands that may touch each other lie beside each other in memory, too.
  const bool by_roots = divided || scene.interaction() != nullptr;
  std::vector<Vec> roots(by_roots ? series.size() : 0);
  const Extent all = extent_of(series, crew, ranks, std::span(roots));
  options.longest = all.length;
  if (options.points == 0) options.points = points_of(scene, all.winding);
  const Strand strand_0 = series.strand(0);
  options.line_density =
      strand_0.material.density * strand_0.segments.front().section.area();
  const std::vector<double> equal(cost.empty() ? roots.size() : 0, 1);
  SceneHead made_head;
  made_head.division = by_roots ? std::make_shared<HeadDivision>(
                                      roots, cost.empty() ? std::span(equal) : cost,
                                      ranks.size(), ranks.rank())
                                : std::make_shared<HeadDivision>(series.size());
  const HeadDivision& division = *made_head.division;
  const std::size_t own = division.own().size();
  if (const Parameters* between = scene.interaction()) {
    made_head.interaction = std::make_unique<models::StrandInteraction>(
        *between, std::vector<int>(own, options.elements + 1));
  }
  std::vector<std::shared_ptr<ChosenEffect>> chosen;
  made_head.head = empty_head(scene, options, pack);
  Head* const head = made_head.head.get();
  made_head.guard = std::make_unique<HeadGuard>(scene, options, at_rest_in_head(scene));
  made_head.guarded = scene.guard;
  head->reserve(own);
  made_head.guard->reserve(own);
  constexpr std::size_t at_once = 1024;
  std::vector<Strand> made(std::min(at_once, own));
  for (std::size_t begin = 0; begin < own; begin += at_once) {
    const std::size_t end = std::min(begin + at_once, own);
    in_parts(crew, begin, end, parts, [&](std::size_t k, std::size_t) {
      made[k - begin] = series.strand(division.own()[k]);
    });
    for (std::size_t k = begin; k < end; ++k) {
      models::Effects effects;
      if (made_head.interaction) {
        auto effect = made_head.interaction->effect(division.order()[k]);
        if (divided) {
          chosen.push_back(std::make_shared<ChosenEffect>(std::move(effect)));
          effects.push_back(chosen.back());
        } else {
          effects.push_back(std::move(effect));
        }
      }
      made_head.guard->add(made[k - begin], effects);
      head->add(made[k - begin], std::move(effects));
    }
  }
  if (!chosen.empty()) {
    made_head.halo = std::make_unique<Halo>(
        ranks, made_head.division, options.motion, *made_head.interaction,
        std::move(chosen), static_cast<std::size_t>(options.elements + 1));
  }
  return made_head;
}

}  // namespace

SceneHead make_head(const SceneOutline& outline, const HeadPack& pack, int threads) {
  OneRank alone;
  return make_head(outline, pack, threads, alone);
}

SceneHead make_head(const Scene& scene, const HeadPack& pack, int threads) {
  OneRank alone;
  return head_of(scene, Held{scene.strands}, pack, threads, alone, {});
}

SceneHead make_head(const SceneOutline& outline, const HeadPack& pack, int threads,
                    Ranks& ranks, std::span<const double> cost) {
  return head_of(outline.scene, *outline.series, pack, threads, ranks, cost);
}

double longest_step(const Scene& scene) {
  const Options& options = scene.options;
  if (options.tolerance == 0) return options.step;
  return options.max_step > 0 ? options.max_step
                              : std::numeric_limits<double>::infinity();
}

std::size_t head_bytes(const SceneOutline& outline, const HeadPack& pack,
                       std::size_t strands) {
  HeadOptions options = options_of(outline.scene);
  options.longest = 1;
  if (options.points == 0) options.points = 8;
  const std::unique_ptr<Head> block = empty_head(outline.scene, options, pack);
  const auto lanes = static_cast<std::size_t>(pack.lanes);
  for (std::size_t k = 0; k < lanes; ++k) block->add(outline.scene.strands.front());
  const std::size_t blocks = (strands + lanes - 1) / lanes;
  std::size_t bytes = block->bytes() * blocks;
  if (const Parameters* between = outline.scene.interaction()) {
    const models::ContactLaw law(*between, outline.scene.name);
    const auto& segments = outline.scene.strands.front().segments;
    const std::size_t of_point =
        models::StrandPartners::bytes_of_point(segments.front().length, law.reach());
    // Places and velocities of the points, and what others keep of them.
    bytes += strands * (16 * block->numbers() + of_point * block->numbers() / 3);
  }
  return bytes;
}

}  // namespace tress::simulation
