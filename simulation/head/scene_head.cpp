#include "simulation/head/scene_head.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>
#include <vector>

#include "contract/input_error.h"
#include "models/contact/contact_law.h"
#include "models/contact/strand_partners.h"
#include "models/head/reduced_parts.h"
#include "models/reduced/reduced_strand.h"
#include "simulation/head/lane_guard.h"
#include "simulation/head/replicated_head.h"
#include "simulation/rest/held_shape.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene_changes/strand_options.h"
#include "simulation/threads/crew.h"

namespace tress::simulation {
namespace {

constexpr std::size_t parts = 64;  // of strands that are made at the same time

/// Returns whether effects other than gravity and drag do no work in the frame of the
/// head.
bool at_rest_in_head(const Scene& scene) {
  return std::ranges::all_of(scene.effects, [&](const EffectChoice& choice) {
    const auto effect = make_effect(scene, choice);
    return effect != nullptr && (!models::depends_on_place(*effect) ||
                                 (effect->rigid_contact() != nullptr &&
                                  choice.parameters.word("moves") == "head"));
  });
}

HeadOptions options_of(const Scene& scene) {
  HeadOptions options;
  options.elements = static_cast<int>(scene.strands.front().segments.size());
  if (steps_quaternions(scene)) options.model = scene.model_options;
  if (!steps_edges(scene)) {
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
  if (steps_springs(scene)) return spring_head(options, pack);
  if (steps_rods(scene)) return der_head(options, pack);
  if (scene.model->id == "corde") return corde_head(options, pack);
  if (steps_quaternions(scene)) return cosserat_head(options, pack);
  if (steps_clothoids(scene)) return clothoid_head(options, pack);
  return steps_chains(scene) ? chain_head(options, pack) : helix_head(options, pack);
}

/// Whether the points of an element that winds by so much are too many for lanes.
bool too_curved(const Scene& scene, double winding) {
  return steps_clothoids(scene) &&
         chosen_points(scene, winding) > models::most_points_of_element;
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
  void include(const Scene& scene, const Strand& strand) {
    length = std::max(length, strand.length());
    winding = std::max(winding, largest_winding(scene, strand));
  }
};

/// What has to be known of all strands of a scene before any is made into a head's; each
/// rank looks at its share of them.
template <class Strands>
Extent extent_of(const Scene& scene, const Strands& series, Crew& crew, Ranks& ranks,
                 std::span<Vec> roots) {
  const auto rank = static_cast<std::size_t>(ranks.rank()),
             size = static_cast<std::size_t>(ranks.size());
  const auto first = [&](std::size_t r) { return series.size() * r / size; };
  std::vector<Extent> extents(parts);
  in_parts(crew, first(rank), first(rank + 1), parts,
           [&](std::size_t k, std::size_t part) {
             const Strand& strand = series.strand(k);
             extents[part].include(scene, strand);
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

/// use(strands, place of the first) of a rank's own strands, by their places.
template <class Strands, class Use>
void each_own(const Strands& series, const HeadDivision& division, Crew& crew, Use use) {
  constexpr std::size_t at_once = 1024;
  const std::size_t own = division.own().size();
  std::vector<Strand> made;
  for (std::size_t begin = 0; begin < own; begin += at_once) {
    made.resize(std::min(at_once, own - begin));
    in_parts(crew, 0, made.size(), parts, [&](std::size_t k, std::size_t) {
      made[k] = series.strand(division.own()[begin + k]);
    });
    use(std::span<const Strand>(made), begin);
  }
}

template <class Strands>
void add_in_lanes(const Scene& scene, const Strands& series, const HeadPack& pack,
                  const Extent& all, Crew& crew, Ranks& ranks, SceneHead& to) {
  HeadOptions options = options_of(scene);
  options.longest = all.length;
  const Strand strand_0 = series.strand(0);
  options.line_density =
      strand_0.material.density * strand_0.segments.front().section.area();
  const HeadDivision& division = *to.division;
  const std::size_t own = division.own().size();
  if (const Parameters* between = scene.interaction()) {
    to.interaction = std::make_unique<models::StrandInteraction>(
        *between, std::vector<int>(own, options.elements + 1));
  }
  std::vector<std::shared_ptr<ChosenEffect>> chosen;
  to.head = empty_head(scene, options, pack);
  auto guard = std::make_unique<LaneGuard>(scene, options, at_rest_in_head(scene));
  to.head->reserve(own);
  guard->reserve(own);
  each_own(series, division, crew, [&](std::span<const Strand> made, std::size_t begin) {
    for (std::size_t k = 0; k < made.size(); ++k) {
      models::Effects effects;
      if (to.interaction) {
        auto effect = to.interaction->effect(division.order()[begin + k]);
        if (ranks.size() > 1) {
          chosen.push_back(std::make_shared<ChosenEffect>(std::move(effect)));
          effects.push_back(chosen.back());
        } else {
          effects.push_back(std::move(effect));
        }
      }
      guard->add(made[k], effects);
      to.head->add(made[k], std::move(effects));
    }
  });
  to.guard = std::move(guard);
  if (chosen.empty()) return;
  to.halo = std::make_unique<Halo>(ranks, to.division, options.motion, *to.interaction,
                                   std::move(chosen),
                                   static_cast<std::size_t>(options.elements + 1));
}

/// Strands see all others, those of other ranks too, where they begin.
template <class Strands>
void look_at_start(const Scene& scene, const Strands& series, SceneHead& to) {
  Scene whole = scene;
  whole.strands.clear();
  for (std::size_t k = 0; k < series.size(); ++k) {
    whole.strands.push_back(series.strand(k));
  }
  const std::vector<double> x = points_at_start(whole);
  to.interaction->update(x, std::vector<double>(x.size()));
}

template <class Strands>
void replicate(const Scene& scene, const Strands& series, Crew& crew, SceneHead& to) {
  const std::size_t elements = scene.strands.front().segments.size();
  const bool held = scene.rest == RestStrains::inverse;
  if (const Parameters* between = scene.interaction()) {
    to.interaction = std::make_unique<models::StrandInteraction>(
        *between, std::vector<int>(series.size(), static_cast<int>(elements) + 1));
    if (held) look_at_start(scene, series, to);
  }
  const HeadDivision& division = *to.division;
  const auto between = [&](std::size_t number) {
    return to.interaction ? models::Effects{to.interaction->effect(number)}
                          : models::Effects{};
  };
  auto head = std::make_unique<ReplicatedHead>(scene, static_cast<int>(elements));
  head->reserve(division.own().size());
  Scene some = scene;
  each_own(series, division, crew, [&](std::span<const Strand> made, std::size_t begin) {
    const auto numbers = division.own().subspan(begin, made.size());
    some.strands.assign(made.begin(), made.end());
    if (held) {
      for (HeldShape& one : held_shapes(
               some, [&](std::size_t k) { return between(numbers[k]); }, crew, numbers)) {
        to.held.push_back(std::move(one));
      }
    }
    for (std::size_t k = 0; k < made.size(); ++k) {
      const HeldShape* const holds = held ? &to.held[begin + k] : nullptr;
      const Strand strand = held ? stiffer(made[k], *holds) : made[k];
      head->add({strand, between(numbers[k]), holds}, numbers[k]);
    }
  });
  to.lanes = false;
  to.guard = head->guard();
  to.head = std::move(head);
}

/// With a tolerance strands take steps that their batch does not see.
void watch_bodies(const Scene& scene, SceneHead& to) {
  if (scene.options.tolerance > 0) return;
  std::vector<int> before(to.head->numbers() / 3);
  std::iota(before.begin(), before.end(), -1);
  BodyPassages passages(make_effects(scene), std::move(before));
  if (passages.any()) to.passages = std::make_unique<HeadPassages>(std::move(passages));
}

/// make_head() for a StrandSeries, or for Held strands.
template <class Strands>
SceneHead head_of(const Scene& given, const Strands& series, const HeadPack& pack,
                  int threads, Ranks& ranks, std::span<const double> cost) {
  Crew crew(threads);
  const bool divided = ranks.size() > 1;
  if (divided && series.size() < static_cast<std::size_t>(ranks.size())) {
    throw InputError(fmt::format("{} strands for {} ranks", series.size(), ranks.size()),
                     given.name, "give fewer ranks");
  }
  // Strands that may touch each other lie beside each other in memory, too.
  const bool by_roots = divided || given.interaction() != nullptr;
  std::vector<Vec> roots(by_roots ? series.size() : 0);
  const Extent all = extent_of(given, series, crew, ranks, std::span(roots));
  Scene scene = given;
  if (const int points = chosen_points(given, all.winding); points > 0) {
    scene.model_options.set("quadrature", std::to_string(points));
  }
  const std::vector<double> equal(cost.empty() ? roots.size() : 0, 1);
  SceneHead made;
  made.division = by_roots ? std::make_shared<HeadDivision>(
                                 roots, cost.empty() ? std::span(equal) : cost,
                                 ranks.size(), ranks.rank())
                           : std::make_shared<HeadDivision>(series.size());
  made.guarded = scene.guard;
  const bool narrow = pack.number == models::HeadNumber::float32;
  if (no_lanes(scene, pack.number) || (!narrow && too_curved(given, all.winding))) {
    replicate(scene, series, crew, made);
  } else {
    add_in_lanes(scene, series, pack, all, crew, ranks, made);
    watch_bodies(scene, made);
  }
  return made;
}

/// A block.
std::unique_ptr<Head> few_strands(const Scene& scene, const HeadPack& pack, bool lanes) {
  if (!lanes) {
    const auto elements = static_cast<int>(scene.strands.front().segments.size());
    auto head = std::make_unique<ReplicatedHead>(scene, elements);
    head->add(scene.strands.front());
    return head;
  }
  HeadOptions options = options_of(scene);
  options.longest = 1;
  if (options.points == 0) options.points = 8;
  std::unique_ptr<Head> head = empty_head(scene, options, pack);
  for (int k = 0; k < pack.lanes; ++k) head->add(scene.strands.front());
  return head;
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

double longest_step(const Scene& scene, bool lanes) {
  const Options& options = scene.options;
  if (lanes ? options.tolerance == 0 : scene.interaction() != nullptr) {
    return options.step;
  }
  if (!lanes) return std::numeric_limits<double>::infinity();
  return options.max_step > 0 ? options.max_step
                              : std::numeric_limits<double>::infinity();
}

std::size_t head_bytes(const SceneOutline& outline, const HeadPack& pack,
                       std::size_t strands) {
  const Scene& scene = outline.scene;
  const bool in_lanes = !no_lanes(scene, pack.number);
  const std::unique_ptr<Head> block = few_strands(scene, pack, in_lanes);
  const auto lanes = static_cast<std::size_t>(in_lanes ? pack.lanes : 1);
  const std::size_t blocks = (strands + lanes - 1) / lanes;
  std::size_t bytes = block->bytes() * blocks;
  if (const Parameters* between = scene.interaction()) {
    const models::ContactLaw law(*between, scene.name);
    const auto& segments = scene.strands.front().segments;
    const std::size_t of_point =
        models::StrandPartners::bytes_of_point(segments.front().length, law.reach());
    // Places and velocities of the points, and what others keep of them.
    bytes += strands * (16 * block->numbers() + of_point * block->numbers() / 3);
  }
  return bytes;
}

}  // namespace tress::simulation
