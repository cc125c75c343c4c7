#include "models/effects/strand_interaction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "contract/input_error.h"

namespace tress::models {
namespace {

const std::string where_interaction = "effects.strand_interaction";

std::vector<int> checked(std::vector<int> points) {
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (points[k] >= 2) continue;
    throw InputError(
        "strand " + std::to_string(k) + " has fewer than two material points",
        where_interaction, "give strands of at least one segment");
  }
  return points;
}

}  // namespace

std::span<const Parameter> strand_interaction_parameters() {
  static const std::vector<Parameter> all = [] {
    std::vector<Parameter> list{
        {.name = "coupling",
         .help = "lagged: a strand meets the others as they were after the last step; "
                 "monolithic: as they are, all strands solved for at once",
         .choices = "lagged|monolithic"}};
    const std::span<const Parameter> law = contact_parameters();
    list.insert(list.end(), law.begin(), law.end());
    return list;
  }();
  return all;
}

StrandInteraction::StrandInteraction(const Parameters& parameters,
                                     std::vector<int> points)
    : StrandInteraction(ContactLaw(parameters, where_interaction), std::move(points)) {}

StrandInteraction::StrandInteraction(const ContactLaw& law, std::vector<int> points)
    : law_(law), grid_(checked(points), law.reach()), points_(std::move(points)) {}

void StrandInteraction::update(In x, In v) {
  x_.assign(x.begin(), x.end());
  v_.assign(v.begin(), v.end());
  grid_.update(x);
  ++updates_;
}

Vec StrandInteraction::velocity(int segment, double s) const {
  const double* v = &v_[3 * static_cast<std::size_t>(grid_.point(segment))];
  return (1 - s) * load3(v) + s * load3(v + 3);
}

/// Calls of_contact for every strand but this within reach of x, in their order.
template <class F>
void StrandInteraction::each_contact(const SegmentGrid& grid, double reach, int strand,
                                     const Vec& x, F of_contact) const {
  const std::span<const SegmentGrid::Entry> near = grid.near(x);
  const double far = reach * reach;
  for (std::size_t k = 0; k < near.size();) {
    const int other = near[k].polyline;
    if (other == strand) {
      ++k;
      continue;
    }
    Contact nearest{};
    double least = far;
    for (; k < near.size() && near[k].polyline == other; ++k) {
      const StraightPiece& piece = grid.piece(near[k].segment);
      const double s = piece.nearest(x);
      const Vec gap = x - piece.at(s);
      const double square = dot(gap, gap);
      if (!(square < least)) continue;
      least = square;
      nearest = {near[k].segment, s, gap};
    }
    if (least < far) of_contact(nearest);
  }
}

class StrandInteraction::OnStrand final : public Effect {
 public:
  OnStrand(const StrandInteraction& all, int strand) : all_(all), strand_(strand) {}

  std::string_view name() const override { return "strand_interaction"; }
  Needs needs() const override {
    return {.position = true, .velocity = true, .derivatives = true};
  }

  void add_load(double, const Points& p, InOut f) const noexcept override {
    each_loaded(p, [&](std::size_t i, const Vec& force) {
      store3(load3(&f[3 * i]) + force, &f[3 * i]);
    });
  }

  void add_derivatives(double, const Points& p, double pos, double vel,
                       InOut blocks) const noexcept override {
    each_contact(p, [&](std::size_t i, const Contact& c) {
      const StraightPiece& piece = all_.grid_.piece(c.segment);
      const Vec v = load3(&p.v[3 * i]);
      const ContactLaw::Slopes slope =
          all_.law_.slopes(c.gap, v - all_.velocity(c.segment, c.s));
      // Between the ends of a segment its nearest point follows x: ds/dx = `along`.
      const bool inside = c.s > 0 && c.s < 1;
      const Vec along = inside ? piece.inverse * piece.edge : Vec{};
      const Vec faster = all_.velocity(c.segment, 1) - all_.velocity(c.segment, 0);
      const double sliding[] = {faster.x, faster.y, faster.z};
      for (std::size_t row = 0; row < 3; ++row) {
        double* block = &blocks[9 * i + 3 * row];
        const Vec by_gap = load3(&slope.by_gap[3 * row]);
        const double by_s = dot(by_gap, piece.edge) + slope.by_velocity * sliding[row];
        const Vec by_x = by_gap - by_s * along;
        store3(load3(block) + (pos * p.length[i]) * by_x, block);
        block[row] += vel * p.length[i] * slope.by_velocity;
      }
    });
  }

  double potential(double, const Points&) const noexcept override { return 0; }

  double power(double, const Points& p) const noexcept override {
    double sum = 0;
    each_loaded(p, [&](std::size_t i, const Vec& force) {
      sum += dot(force, load3(&p.v[3 * i]));
    });
    return sum;
  }

 private:
  template <class F>
  void each_contact(const Points& p, F of_contact) const noexcept {
    find(p);
    for (const auto& [i, c] : found_) of_contact(i, c);
  }

  /// Sets found_ for the current points. A step needs load and derivatives at the same
  /// positions, and the search dominates the cost of both.
  void find(const Points& p) const {
    if (found_after_ == all_.updates_ && std::ranges::equal(p.x, found_at_)) return;
    found_.clear();
    for (std::size_t i = 0; i < p.length.size(); ++i) {
      if (p.length[i] == 0) continue;
      all_.each_contact(all_.grid_, all_.law_.reach(), strand_, load3(&p.x[3 * i]),
                        [&](const Contact& c) { found_.emplace_back(i, c); });
    }
    found_at_.assign(p.x.begin(), p.x.end());
    found_after_ = all_.updates_;
  }

  template <class F>
  void each_loaded(const Points& p, F of_force) const noexcept {
    each_contact(p, [&](std::size_t i, const Contact& c) {
      const Vec u = load3(&p.v[3 * i]) - all_.velocity(c.segment, c.s);
      of_force(i, p.length[i] * all_.law_.force(c.gap, u));
    });
  }

  const StrandInteraction& all_;
  int strand_;
  mutable std::vector<std::pair<std::size_t, Contact>> found_;
  mutable std::vector<double> found_at_;
  mutable long found_after_ = -1;
};

std::unique_ptr<const Effect> StrandInteraction::effect(std::size_t strand) const {
  return std::make_unique<OnStrand>(*this, static_cast<int>(strand));
}

/// Calls of_sample(strand, place, length that it stands for).
template <class F>
void StrandInteraction::each_sample(F of_sample) const {
  for (int i = 0; i < static_cast<int>(grid_.segments()); ++i) {
    const StraightPiece& piece = grid_.piece(i);
    const double length = std::sqrt(dot(piece.edge, piece.edge));
    const double samples = std::clamp(std::ceil(length / law_.inner()), 1.0, 64.0);
    for (double k = 0.5; k < samples; ++k) {
      of_sample(grid_.polyline(i), piece.at(k / samples), length / samples);
    }
  }
}

long StrandInteraction::touching_pairs() const {
  std::set<std::pair<int, int>> pairs;
  each_sample([&](int strand, const Vec& x, double) {
    each_contact(grid_, law_.inner(), strand, x, [&](const Contact& c) {
      pairs.insert(std::minmax(strand, grid_.polyline(c.segment)));
    });
  });
  return static_cast<long>(pairs.size());
}

double StrandInteraction::mean_distance() const {
  if (points_.size() < 2 || x_.empty()) return std::numeric_limits<double>::infinity();
  struct Sample {
    int strand;
    Vec x;
    double length;
  };
  std::vector<Sample> open, still;
  double total = 0, sum = 0;
  each_sample([&](int strand, const Vec& x, double length) {
    open.push_back({strand, x, length});
    total += length;
  });
  // Grids of increasing reach, for samples without a neighbour so far.
  for (double reach = law_.reach(); !open.empty(); reach *= 2) {
    if (!std::isfinite(reach * reach)) return std::nan("");  // so are the places
    SegmentGrid grid(points_, reach);
    grid.update(x_);
    still.clear();
    for (const Sample& sample : open) {
      double least = reach * reach;
      each_contact(grid, reach, sample.strand, sample.x,
                   [&](const Contact& c) { least = std::min(least, dot(c.gap, c.gap)); });
      if (least < reach * reach) {
        sum += sample.length * std::sqrt(least);
      } else {
        still.push_back(sample);
      }
    }
    open.swap(still);
  }
  return sum / total;
}

}  // namespace tress::models
