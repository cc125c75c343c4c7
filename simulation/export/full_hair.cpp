#include "simulation/export/full_hair.h"

#include <algorithm>

#include "contract/input_error.h"
#include "simulation/groom/guide_choice.h"
#include "simulation/scene/strand_tables.h"

namespace tress::simulation {
namespace {

constexpr std::size_t most_frames = 60;

}  // namespace

Frame rotation_from_rest(const RootMotion& head, double t) {
  const Frame now = head.at(t).frame;
  const auto column = [&](const Vec& axis) { return now * head.frame.back(axis); };
  return {column({1, 0, 0}), column({0, 1, 0}), column({0, 0, 1})};
}

GuideHair hair_that_follows(std::span<const Strand> guides,
                            std::span<const Strand> followers, const RootMotion& head,
                            std::uint64_t seed) {
  std::vector<Vec> roots, hair_roots, of_guides, of_hairs;
  const auto add = [](const Strand& strand, std::vector<Vec>& root, std::vector<Vec>& x) {
    root.push_back(strand.root.position);
    for (const Vec& point : initial_points(strand)) x.push_back(point);
  };
  for (const Strand& strand : guides) add(strand, roots, of_guides);
  for (const Strand& strand : followers) add(strand, hair_roots, of_hairs);
  const std::size_t points = of_guides.size() / guides.size();
  // Guides as far apart as usual share their hairs, also the third one of sparse guides
  // and where tips spread; those on both sides of a parting are farther.
  constexpr double parted = 6;
  GuideHairOptions options{.clumpiness = 0, .seed = seed, .linear = true};
  const GuideHair near(roots, hair_roots, points, options);
  double sum = 0;
  for (std::size_t h = 0; h < near.hairs(); ++h) {
    const auto tip = [&](std::size_t k) {
      return of_guides[(near.neighbours(h).guide[k] + 1) * points - 1];
    };
    sum += norm(tip(0) - tip(1));
  }
  options.tip_limit =
      std::max(options.tip_limit, parted * sum / static_cast<double>(near.hairs()));
  GuideHair hair(roots, hair_roots, points, options);
  hair.keep_shapes(of_guides, rotation_from_rest(head, 0), of_hairs);
  return hair;
}

FullHair::FullHair(const Scene& scene, std::span<const int> guides, std::size_t hairs)
    : head_(scene.head) {
  const bool follows = !scene.followers.empty();
  if (hairs == 0 && !follows) return;
  if (hairs > 0 && follows) {
    throw InputError("--hairs cannot be combined with a groom whose hairs follow guides",
                     "--hairs", "leave it out, or the groom's guides");
  }
  refuse_if(scene.tables != nullptr && scene.tables->skin != nullptr,
            "hairs between strands follow one rigid motion, and a skin deforms",
            follows ? "guides" : "--hairs", "leave it out: every strand is simulated");
  const bool alike = std::ranges::all_of(guides, [&](int n) { return n == guides[0]; });
  const auto as_guides = [&](const Strand& strand) {
    return static_cast<int>(strand.segments.size()) + 1 == guides[0];
  };
  const std::size_t least = follows ? 1 : 3;
  if (scene.strands.size() < least || guides.size() != scene.strands.size() || !alike ||
      !std::ranges::all_of(scene.followers, as_guides)) {
    throw InputError(
        "hairs between strands need three strands or more with equal "
        "numbers of elements",
        follows ? "guides" : "--hairs", "leave it out for scene " + scene.name);
  }
  std::vector<Vec> roots;
  for (const Strand& strand : scene.strands) roots.push_back(strand.root.position);
  points_ = static_cast<std::size_t>(guides[0]);
  if (follows) {
    hair_ = hair_that_follows(scene.strands, scene.followers, head_, scene.seed);
    return;
  }
  hair_.emplace(roots, scatter_roots(roots, hairs, scene.seed), points_,
                GuideHairOptions{.seed = scene.seed});
}

std::vector<int> FullHair::lines(std::span<const int> guides) const {
  std::vector<int> all(guides.begin(), guides.end());
  all.insert(all.end(), hairs(), static_cast<int>(points_));
  return all;
}

std::vector<DrawnLine> FullHair::drawn(std::vector<DrawnLine> guides) const {
  const auto simulated = static_cast<int>(guides.size());
  for (std::size_t h = 0; h < hairs(); ++h) {
    const double radius = guides[hair_->neighbours(h).guide[0]].radius;
    guides.push_back({simulated + static_cast<int>(h), radius});
  }
  return guides;
}

std::vector<Frame3d> FullHair::frames(std::span<const Frame3d> guides) const {
  std::vector<Frame3d> all;
  const std::size_t stride = (guides.size() + most_frames - 1) / most_frames;
  for (std::size_t f = 0; f < guides.size(); f += stride) {
    all.push_back(grown(guides[f]));
  }
  return all;
}

Frame3d FullHair::grown(const Frame3d& guides) const {
  const std::size_t simulated = guides.positions.size() / 3, drawn = hairs() * points_;
  std::vector<Vec> of_guides(simulated), places(drawn);
  Frame3d full{guides.series, guides.positions, {}, guides.contacts, guides.reactions};
  for (std::size_t i = 0; i < simulated; ++i) {
    of_guides[i] = load3(&guides.positions[3 * i]);
  }
  hair_->grow(of_guides, rotation_from_rest(head_, guides.series[0]), places);
  for (const Vec& x : places) {
    for (const double c : {x.x, x.y, x.z}) {
      full.positions.push_back(static_cast<float>(c));
    }
  }
  for (std::size_t first = 0; first < guides.channels.size(); first += simulated) {
    const auto of_channel = guides.channels.begin() + static_cast<std::ptrdiff_t>(first);
    full.channels.insert(full.channels.end(), of_channel,
                         of_channel + static_cast<std::ptrdiff_t>(simulated));
    for (std::size_t h = 0; h < hairs(); ++h) {
      const auto own = of_channel + static_cast<std::ptrdiff_t>(
                                        hair_->neighbours(h).guide[0] * points_);
      full.channels.insert(full.channels.end(), own,
                           own + static_cast<std::ptrdiff_t>(points_));
    }
  }
  return full;
}

}  // namespace tress::simulation
