#include "experiments/head_accuracy/measure.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <numeric>
#include <stdexcept>

#include "contract/input_error.h"
#include "math/helix.h"
#include "models/reduced/reduced_strand.h"
#include "simulation/export/full_hair.h"
#include "simulation/groom/guide_choice.h"
#include "simulation/head/head_classes.h"
#include "simulation/head/head_run.h"
#include "simulation/head/scene_head.h"
#include "simulation/run/timing.h"
#include "simulation/scene/strand_tables.h"
#include "simulation/scene_changes/changes.h"

namespace tress::experiments::head_accuracy {
namespace {

using models::HeadNumber;
using models::HeadPack;

constexpr std::size_t instants = 10;  // that are compared

HeadPack pack_of(int bits) {
  return models::widest_pack(bits == 64 ? HeadNumber::float64 : HeadNumber::float32);
}

StrandSeries series_of(const Scene& scene) {
  return StrandSeries(scene.tables, scene.head, scene.seed, made_singly);
}

/// Whether strand k of `size` is one of these.
std::vector<bool> marked(const std::vector<std::size_t>& some, std::size_t size) {
  std::vector<bool> mark(size);
  for (const std::size_t k : some) mark[k] = true;
  return mark;
}

void set_points(std::span<const double> x, std::vector<Vec>& points) {
  points.resize(x.size() / 3);
  for (std::size_t i = 0; i < points.size(); ++i) points[i] = load3(&x[3 * i]);
}

}  // namespace

Scene read_head_scene(const std::string& file) {
  SceneOutline outline = read_outline(file);
  Scene given = outline.scene;
  if (outline.series != nullptr) {
    for (const StrandSource& source : outline.scene.tables->sources) {
      if (source.groom) continue;
      throw InputError("a [strand] cannot be combined with hairs that may follow guides",
                       source.table.place(), "give [groom]s only");
    }
    constexpr std::size_t enough = 100;
    // Whether it has guides is what is asked; they do not run as a head.
    outline.scene = every_strand(std::move(outline.scene), enough);
  }
  if (const auto no = no_single_head(outline)) {
    throw InputError(no->reason, file, no->remedy);
  }
  if (const auto no = no_lanes(outline.scene)) {
    throw InputError("no SIMD lanes for " + no->reason, file, no->remedy);
  }
  refuse_if(given.model->id != "super_helix",
            std::string(given.model->id) + ": work is that of super-helices", file,
            "use [model] id = \"super_helix\"");
  return given;
}

HeadMeasure::HeadMeasure(const Scene& given, const Comparison& comparison)
    : comparison_(comparison),
      whole_(every_strand(given, comparison.hairs)),
      all_(series_of(given).size()) {
  const double horizon = std::min(comparison.horizon, given.duration);
  frames_ = std::max<std::size_t>(
      1, static_cast<std::size_t>(std::floor(horizon * comparison.rate + 1e-9)));
  stride_ = std::max<std::size_t>(1, frames_ / instants);
  for (const Strand& strand : whole_.strands) {
    lengths_.push_back(strand.length());
    for (const Segment& segment : strand.segments) {
      winding_ = std::max(winding_, lengths_.back() * norm(segment.natural));
    }
  }
  const int n = comparison.elements, s = comparison.substeps;
  const HairCurves other =
      extrapolated_in_step(curves(n / 2, s / 2), curves(n / 2, s / 4));
  reference_ = extrapolated_in_elements(
      extrapolated_in_step(curves(n, s), curves(n, s / 2)), other);
  HairErrors errors(reference_, lengths_);
  std::vector<std::size_t> every(hairs());
  std::iota(every.begin(), every.end(), std::size_t{0});
  std::vector<Vec> points;
  for (std::size_t at = 0; at < other.x.size(); ++at) {
    set_points(other.x[at], points);
    errors.add(at, every, points);
  }
  // Three quarters of the way are what the finer run gains, the rest is extrapolated.
  std::vector<double> each;
  for (const std::size_t k : every) each.push_back(errors.of(k) / 4);
  gap_ = spread(each);
}

double HeadMeasure::element_work(int elements) const {
  const double angle = winding_ / elements;
  const double points = (12 + models::quadrature_points(angle)) / 16.0;
  return angle * angle > helix::short_end ? 3.5 * points : points;
}

/// What a run took.
struct HeadMeasure::Run {
  double step_s = 0, read_s = 0;
  std::size_t bytes = 0, lost = 0;
};

template <class Use>
HeadMeasure::Run HeadMeasure::moved(const Scene& scene, int substeps, int bits,
                                    const Use& use) const {
  SceneHead made = make_head(scene, pack_of(bits), comparison_.threads);
  HeadRun run(std::move(made.head), comparison_.threads, std::move(made.interaction));
  const double frame = 1 / comparison_.rate, h = frame / substeps;
  std::vector<double> step_s, read_s, x;
  Run done;
  for (std::size_t f = 1; f <= frames_; ++f) {
    const double begin = static_cast<double>(f - 1) * frame;
    step_s.push_back(seconds_of([&] {
      for (int i = 0; i < substeps; ++i) run.step(begin + i * h, h);
    }));
    if (f % stride_ != 0) continue;
    const double t = static_cast<double>(f) * frame;
    read_s.push_back(seconds_of([&] { run.positions(t, x); }));
    use(f / stride_ - 1, t, x);
  }
  done.step_s = median(step_s);
  done.read_s = median(read_s);
  done.bytes = run.head().bytes();
  done.lost = run.head().losses().size();
  return done;
}

Scene HeadMeasure::cut(int elements) const { return with_elements(whole_, elements); }

const std::vector<std::size_t>& HeadMeasure::guides(const Scene& cut,
                                                    std::size_t number) const {
  const int elements = static_cast<int>(cut.strands.front().segments.size());
  std::vector<std::size_t>& chosen = guides_[{number, elements}];
  if (chosen.empty()) chosen = guides_of(cut, number);
  return chosen;
}

HairCurves HeadMeasure::curves(int elements, int substeps) const {
  HairCurves made{hairs(), elements, {}};
  const Run run = moved(
      cut(elements), substeps, 64,
      [&](std::size_t, double, const std::vector<double>& x) { made.x.push_back(x); });
  if (run.lost == 0) return made;
  throw std::runtime_error(
      fmt::format("{} of {} hairs have no solution in {} elements and {} steps a frame",
                  run.lost, hairs(), elements, substeps));
}

Spread HeadMeasure::of_all(const HairErrors& errors,
                           const std::vector<std::size_t>& guides) const {
  const std::vector<bool> guide = marked(guides, hairs());
  const double others = static_cast<double>(hairs() - guides.size()),
               weight =
                   others > 0 ? static_cast<double>(all_ - guides.size()) / others : 1;
  std::vector<double> each, weights;
  for (std::size_t k = 0; k < hairs(); ++k) {
    each.push_back(errors.of(k));
    weights.push_back(guide[k] ? 1 : weight);
  }
  return spread(each, weights);
}

/// The hairs of a scene that follow guides, as points.
class HeadMeasure::Followers {
 public:
  Followers(const Scene& cut, const std::vector<std::size_t>& guides)
      : head_(cut.head), guides_(guides) {
    const std::vector<bool> guide = marked(guides, cut.strands.size());
    for (std::size_t k = 0; k < cut.strands.size(); ++k) {
      if (!guide[k]) hairs_.push_back(k);
    }
    if (hairs_.empty()) return;
    hair_ = hair_that_follows(only(cut, guides).strands, only(cut, hairs_).strands,
                              cut.head, cut.seed);
    points_ = cut.strands.front().segments.size() + 1;
    places_.resize(hairs_.size() * points_);
  }

  void grow(double t, std::span<const Vec> guides) {
    if (hair_) hair_->grow(guides, rotation_from_rest(head_, t), places_);
  }
  /// Adds guides and hairs to the errors.
  void compare(std::size_t instant, std::span<const Vec> guides,
               HairErrors& errors) const {
    errors.add(instant, guides_, guides);
    errors.add(instant, hairs_, places_);
  }
  /// Of shapes, neighbours and weights.
  double bytes() const {
    return static_cast<double>(places_.size() * sizeof(Vec) +
                               hairs_.size() * (sizeof(GuideHair::Neighbours) + 32));
  }
  std::size_t size() const { return hairs_.size(); }

 private:
  const RootMotion& head_;
  const std::vector<std::size_t>& guides_;
  std::vector<std::size_t> hairs_;
  std::optional<GuideHair> hair_;
  std::size_t points_ = 0;
  std::vector<Vec> places_;
};

std::optional<HeadTrial> HeadMeasure::trial(const Choice& choice) const {
  const Scene scene = cut(choice.elements);
  const std::vector<std::size_t>& chosen = guides(scene, choice.guides);
  Followers followers(scene, chosen);
  HairErrors errors(reference_, lengths_);
  std::vector<double> follow_s;
  std::vector<Vec> points;
  const Run run = moved(only(scene, chosen), choice.substeps, choice.bits,
                        [&](std::size_t instant, double t, const std::vector<double>& x) {
                          follow_s.push_back(seconds_of([&] {
                            set_points(x, points);
                            followers.grow(t, points);
                          }));
                          followers.compare(instant, points, errors);
                        });
  if (run.lost > 0) return {};
  HeadTrial made;
  made.choice = choice;
  made.all = of_all(errors, chosen);
  std::vector<double> own;
  for (const std::size_t k : chosen) own.push_back(errors.of(k));
  made.simulated = spread(own);
  made.interpolation = interpolation(choice.guides, choice.elements);
  // Of a thinned groom all that follow, or all, are so many times as many.
  const auto times = [this](std::size_t looked_at, std::size_t besides) {
    if (looked_at == 0) return 0.0;
    return static_cast<double>(all_ - besides) / static_cast<double>(looked_at);
  };
  const double more_guides = followers.size() > 0 ? 1 : times(chosen.size(), 0),
               more_others = times(followers.size(), chosen.size());
  made.step_s = more_guides * run.step_s;
  made.follow_s = more_guides * run.read_s;
  if (followers.size() > 0) made.follow_s += more_others * median(follow_s);
  made.bytes =
      more_guides * static_cast<double>(run.bytes) + more_others * followers.bytes();
  return made;
}

Spread HeadMeasure::interpolation(std::size_t number, int elements) const {
  const Scene scene = cut(elements);
  const std::vector<std::size_t>& chosen = guides(scene, number);
  if (chosen.size() == hairs()) return {};
  Followers followers(scene, chosen);
  HairErrors errors(reference_, lengths_);
  std::vector<Vec> points;
  for (std::size_t at = 0; at < reference_.x.size(); ++at) {
    points.clear();
    for (const std::size_t k : chosen) {
      for (int i = 0; i <= elements; ++i) {
        points.push_back(reference_.at(at, k, static_cast<double>(i) / elements));
      }
    }
    const double t = static_cast<double>((at + 1) * stride_) / comparison_.rate;
    followers.grow(t, points);
    followers.compare(at, points, errors);
  }
  return of_all(errors, chosen);
}

Spread HeadMeasure::simulated(std::size_t number, int elements, int substeps,
                              int bits) const {
  const Scene scene = cut(elements);
  const std::vector<std::size_t>& chosen = guides(scene, number);
  HairErrors errors(reference_, lengths_);
  std::vector<Vec> points;
  const Run run = moved(only(scene, chosen), substeps, bits,
                        [&](std::size_t instant, double, const std::vector<double>& x) {
                          set_points(x, points);
                          errors.add(instant, chosen, points);
                        });
  std::vector<double> own;
  constexpr double never = std::numeric_limits<double>::infinity();
  for (const std::size_t k : chosen) own.push_back(run.lost > 0 ? never : errors.of(k));
  return spread(own);
}

}  // namespace tress::experiments::head_accuracy
