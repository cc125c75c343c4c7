#include "simulation/run/scene_head.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "models/reduced/reduced_strand.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/threads/crew.h"

namespace tress::simulation {
namespace {

using models::HeadOptions;

constexpr std::size_t parts = 64;  // of strands that are made at the same time

bool of_springs(const Scene& scene) { return scene.model->id == "mass_spring"; }

/// An option of the model that heads do not have.
NoHead no_option(const Parameters& p, const char* key, const char* remedy) {
  return {fmt::format("{} = \"{}\" does not come as a head", key, p.word(key)), remedy};
}

std::optional<NoHead> no_springs(const Parameters& p) {
  if (p.word("bending") != "angular") {
    return no_option(p, "bending", "give [model] bending = \"angular\"");
  }
  if (p.word("torsion") != "none") {
    return no_option(p, "torsion", "give [model] torsion = \"none\"");
  }
  if (p.word("tangent") != "filtered") {
    return no_option(p, "tangent", "give [model] tangent = \"filtered\"");
  }
  return {};
}

std::optional<NoHead> no_model(const Scene& scene) {
  const Parameters& p = scene.model_options;
  if (of_springs(scene)) return no_springs(p);
  if (scene.model->id != "super_helix") {
    return NoHead{fmt::format("{} does not come as a head", scene.model->id),
                  "use [model] id = \"super_helix\", or \"mass_spring\""};
  }
  if (p.word("modes") == "bend_planar") {
    return NoHead{"strands of a head bend in both directions",
                  "give [model] modes = \"bend_twist\" or \"bend\""};
  }
  if (p.word("tangent") != "stiff") {
    return no_option(p, "tangent", "give [model] tangent = \"stiff\"");
  }
  if (p.word("solver") != "recursive") {
    return no_option(p, "solver", "leave out [model] solver");
  }
  if (p.whole("quadrature") == 1 || p.whole("quadrature") > 16) {
    return NoHead{fmt::format("{} points of an element", p.whole("quadrature")),
                  "give [model] quadrature = 0, or 2 to 16"};
  }
  return {};
}

std::optional<NoHead> no_method(const Scene& scene) {
  if (scene.integrator != "semi_implicit_euler") {
    return NoHead{fmt::format("{} does not step a head", scene.integrator),
                  "use [integrator] id = \"semi_implicit_euler\""};
  }
  if (scene.rest == RestStrains::inverse) {
    return NoHead{"strands of a head have the natural strains of their tables",
                  "leave out rest = \"inverse\""};
  }
  const Options& options = scene.options;
  if (options.max_work > 0) {
    return NoHead{"a head does not count its work", "leave out [integrator] max_work"};
  }
  if (1 / scene.frame_rate / options.step > static_cast<double>(options.max_steps)) {
    return NoHead{"more than max_steps steps of dt_s from frame to frame",
                  "give a longer dt_s, or more frames_1_s"};
  }
  return {};
}

std::optional<NoHead> no_strands(const Scene& scene) {
  const std::vector<StrandSource>& sources = scene.tables->sources;
  const int elements = sources.front().table.values().whole("elements");
  for (const StrandSource& source : sources) {
    const Parameters& p = source.table.values();
    if (p.whole("elements") != elements) {
      return NoHead{
          fmt::format("strands of {} and of {} elements", elements, p.whole("elements")),
          "give all equally many elements"};
    }
    if (source.groom && p.whole("guides") > 0) {
      return NoHead{"all strands of a head are simulated", "leave out guides"};
    }
    if (source.file && p.word("cuts") != "equal") {
      return NoHead{"elements of different lengths", "give [groom] cuts = \"equal\""};
    }
    if (p.number("grading") != 1) {
      return NoHead{"elements of different lengths", "leave out grading"};
    }
  }
  if (scene.strands.front().free_root) {
    return NoHead{"free roots", "use another [root] motion"};
  }
  return {};
}

std::optional<NoHead> no_effects(const Scene& scene) {
  for (const EffectChoice& choice : scene.effects) {
    const auto effect = make_effect(scene, choice);
    if (effect != nullptr) {
      if (auto no = models::refused_by_heads(*effect))
        return NoHead{no->reason, no->remedy};
      if (of_springs(scene) && !effect->uniform_acceleration() && !effect->viscosity() &&
          effect->rigid_contact() == nullptr) {
        return NoHead{fmt::format("[effects.{}] on a head of springs", choice.entry->id),
                      "leave it out, or use [model] id = \"super_helix\""};
      }
    } else if (of_springs(scene) && &choice.parameters == scene.interaction()) {
      return NoHead{"interaction on a head of springs",
                    "leave it out, or use [model] id = \"super_helix\""};
    } else if (&choice.parameters != scene.interaction()) {
      return NoHead{fmt::format("a head does not know [effects.{}]", choice.entry->id),
                    "leave it out"};
    } else if (choice.parameters.word("coupling") == "monolithic") {
      return NoHead{"strands of a head are no system of one",
                    "give [effects.strand_interaction] coupling = \"lagged\""};
    }
  }
  return {};
}

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
  if (!of_springs(scene)) {
    options.points = scene.model_options.whole("quadrature");
    options.twist = scene.model_options.word("modes") == "bend_twist";
    options.rotary_inertia = scene.model_options.word("rotary_inertia") == "on";
  }
  options.gravity = {};
  options.motion = scene.head;
  options.effects = make_effects(scene);
  return with_uniform_effects(std::move(options));
}

std::unique_ptr<Head> empty_head(const Scene& scene, const HeadOptions& options,
                                 const HeadPack& pack) {
  return of_springs(scene) ? spring_head(options, pack) : helix_head(options, pack);
}

/// Strands of a scene as a series.
struct Held {
  const std::vector<Strand>& strands;

  std::size_t size() const { return strands.size(); }
  const Strand& strand(std::size_t k) const { return strands[k]; }
};

/// Longest strand, farthest end from the motion's place, largest angle that an element
/// winds by, largest drag over mass.
struct Extent {
  double length = 0, radius = 0, winding = 0, lightest = 0;

  void include(const Extent& other) {
    length = std::max(length, other.length);
    radius = std::max(radius, other.radius);
    winding = std::max(winding, other.winding);
    lightest = std::max(lightest, other.lightest);
  }
  void include(const Strand& strand, const HeadOptions& options) {
    length = std::max(length, strand.length());
    radius = std::max(
        radius, strand.length() + norm(strand.root.position - options.motion.position));
    lightest = std::max(lightest, strand.length() / strand.mass());
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
Extent extent_of(const Strands& series, const HeadOptions& options, Crew& crew,
                 Ranks& ranks, std::span<Vec> roots) {
  const auto rank = static_cast<std::size_t>(ranks.rank()),
             size = static_cast<std::size_t>(ranks.size());
  const auto first = [&](std::size_t r) { return series.size() * r / size; };
  std::vector<Extent> extents(parts);
  in_parts(crew, first(rank), first(rank + 1), parts,
           [&](std::size_t k, std::size_t part) {
             const Strand strand = series.strand(k);
             extents[part].include(strand, options);
             if (!roots.empty()) roots[k] = strand.root.position;
           });
  Extent all;
  for (const Extent& extent : extents) all.include(extent);
  if (!roots.empty()) {
    std::vector<std::size_t> counts(size);
    for (std::size_t r = 0; r < size; ++r) counts[r] = first(r + 1) - first(r);
    ranks.share(roots, counts);
  }
  return {ranks.largest(all.length), ranks.largest(all.radius),
          ranks.largest(all.winding), ranks.largest(all.lightest)};
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
  std::vector<Vec> roots(divided ? series.size() : 0);
  const Extent all = extent_of(series, options, crew, ranks, std::span(roots));
  options.longest = all.length;
  if (options.points == 0) options.points = models::quadrature_points(all.winding);
  const Strand strand_0 = series.strand(0);
  options.line_density =
      strand_0.material.density * strand_0.segments.front().section.area();
  const std::vector<double> equal(cost.empty() ? roots.size() : 0, 1);
  SceneHead made_head;
  made_head.division = divided ? std::make_shared<HeadDivision>(
                                     roots, cost.empty() ? std::span(equal) : cost,
                                     ranks.size(), ranks.rank())
                               : std::make_shared<HeadDivision>(series.size());
  const HeadDivision& division = *made_head.division;
  const std::size_t own = division.own().size();
  if (const Parameters* between = scene.interaction()) {
    made_head.interaction = std::make_unique<models::StrandInteraction>(
        *between, std::vector<int>(own, options.elements + 1));
  }
  std::vector<std::size_t> order(own);  // of places, by numbers
  for (std::size_t i = 0; i < own; ++i) order[division.by_number()[i]] = i;
  std::vector<std::shared_ptr<ChosenEffect>> chosen;
  made_head.head = empty_head(scene, options, pack);
  Head* const head = made_head.head.get();
  head->reserve(own);
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
        auto effect = made_head.interaction->effect(order[k]);
        if (divided) {
          chosen.push_back(std::make_shared<ChosenEffect>(std::move(effect)));
          effects.push_back(chosen.back());
        } else {
          effects.push_back(std::move(effect));
        }
      }
      head->add(made[k - begin], std::move(effects));
    }
  }
  if (!chosen.empty()) {
    made_head.halo = std::make_unique<Halo>(
        ranks, made_head.division, options.motion, *made_head.interaction,
        std::move(chosen), static_cast<std::size_t>(options.elements + 1));
  }
  if (at_rest_in_head(scene)) {
    made_head.reach = {options.motion, options.gravity, all.radius,
                       options.drag * all.lightest + options.mass_damping};
  }
  return made_head;
}

}  // namespace

std::optional<NoHead> no_head(const SceneOutline& outline, models::HeadNumber number) {
  const Scene& scene = outline.scene;
  if (scene.strands.empty()) {
    return NoHead{fmt::format("{} brings its own geometry", scene.model->id),
                  "use [model] id = \"super_helix\""};
  }
  if (auto no = no_model(scene)) return no;
  if (of_springs(scene) && number != models::HeadNumber::float64) {
    return NoHead{"springs in 32 bits, which do not resolve their strains",
                  "give --bits 64"};
  }
  if (auto no = no_method(scene)) return no;
  if (auto no = no_strands(scene)) return no;
  return no_effects(scene);
}

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
  if (outline.scene.interaction() != nullptr) {
    // Places and velocities of the points, and what StrandPartners keeps of them with as
    // many candidates as hairs of a dense head have.
    constexpr std::size_t kept_of_point = 500;
    bytes += strands * (16 * block->numbers() + kept_of_point * block->numbers() / 3);
  }
  return bytes;
}

}  // namespace tress::simulation
