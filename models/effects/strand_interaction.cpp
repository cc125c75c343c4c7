#include "models/effects/strand_interaction.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>
#include <string>
#include <utility>

#include "contract/input_error.h"
#include "models/contact/nearest_pieces.h"

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
         .help = "lagged: a strand meets the others as they were after the last step, "
                 "with a tolerance as they move between two exchanges; "
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
  motion_.hold(x, v);
  move(0, 0, x);
}

void StrandInteraction::extrapolate(double t, double end, In x, In v) {
  motion_.extrapolate(t, x, v);
  move(t, end, x);
}

void StrandInteraction::interpolate(double t, double end, In x, In v, In y, In w) {
  motion_.interpolate(t, end, x, v, y, w);
  move(t, end, x);
}

void StrandInteraction::move(double t, double end, In x) {
  x_.assign(x.begin(), x.end());
  end_ = end;
  grid_.update(x, end > t ? motion_.range(end - t) : 0);
  ++updates_;
}

StraightPiece StrandInteraction::piece(int segment, double elapsed) const {
  const auto point = static_cast<std::size_t>(grid_.point(segment));
  return {motion_.place(point, elapsed), motion_.place(point + 1, elapsed)};
}

Vec StrandInteraction::velocity(int segment, double s, double elapsed) const {
  const auto point = static_cast<std::size_t>(grid_.point(segment));
  return (1 - s) * motion_.velocity(point, elapsed) +
         s * motion_.velocity(point + 1, elapsed);
}

class StrandInteraction::OnStrand final : public Effect {
 public:
  OnStrand(const StrandInteraction& all, int strand) : all_(all), strand_(strand) {}

  std::string_view name() const override { return "strand_interaction"; }
  Needs needs() const override {
    return {.position = true, .velocity = true, .derivatives = true};
  }

  void add_load(double t, const Points& p, InOut f) const noexcept override {
    each_loaded(t, p, [&](std::size_t i, const Vec& force) {
      store3(load3(&f[3 * i]) + force, &f[3 * i]);
    });
  }

  void add_derivatives(double t, const Points& p, double pos, double vel,
                       InOut blocks) const noexcept override {
    const double elapsed = all_.motion_.elapsed(t);
    each_contact(elapsed, p, [&](std::size_t i, const NearestPiece& c) {
      const StraightPiece piece = all_.piece(c.segment, elapsed);
      const Vec v = load3(&p.v[3 * i]);
      const ContactLaw::Slopes slope =
          all_.law_.slopes(c.gap, v - all_.velocity(c.segment, c.s, elapsed));
      // Between the ends of a segment its nearest point follows x: ds/dx = `along`.
      const bool inside = c.s > 0 && c.s < 1;
      const Vec along = inside ? piece.inverse * piece.edge : Vec{};
      const Vec faster =
          all_.velocity(c.segment, 1, elapsed) - all_.velocity(c.segment, 0, elapsed);
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
  double next_breakpoint(double t) const noexcept override {
    return t < all_.end_ ? all_.end_ : std::numeric_limits<double>::infinity();
  }

  double power(double t, const Points& p) const noexcept override {
    double sum = 0;
    each_loaded(t, p, [&](std::size_t i, const Vec& force) {
      sum += dot(force, load3(&p.v[3 * i]));
    });
    return sum;
  }

 private:
  template <class F>
  void each_contact(double elapsed, const Points& p, F of_contact) const noexcept {
    find(elapsed, p);
    for (const auto& [i, c] : found_) of_contact(i, c);
  }

  /// Sets found_ for the current points. A step needs load and derivatives at the same
  /// positions, and the search dominates the cost of both.
  void find(double elapsed, const Points& p) const {
    if (found_after_ == all_.updates_ && elapsed == found_when_ &&
        std::ranges::equal(p.x, found_at_)) {
      return;
    }
    found_.clear();
    if (elapsed == 0) {
      search(p, [&](int segment) -> const StraightPiece& {
        return all_.grid_.piece(segment);
      });
    } else {
      search(p, [&](int segment) { return all_.piece(segment, elapsed); });
    }
    found_at_.assign(p.x.begin(), p.x.end());
    found_when_ = elapsed;
    found_after_ = all_.updates_;
  }

  template <class Pieces>
  void search(const Points& p, const Pieces& piece_of) const {
    for (std::size_t i = 0; i < p.length.size(); ++i) {
      if (p.length[i] == 0) continue;
      each_nearest(all_.grid_, piece_of, all_.law_.reach(), strand_, load3(&p.x[3 * i]),
                   [&](const NearestPiece& c) { found_.emplace_back(i, c); });
    }
  }

  template <class F>
  void each_loaded(double t, const Points& p, F of_force) const noexcept {
    const double elapsed = all_.motion_.elapsed(t);
    each_contact(elapsed, p, [&](std::size_t i, const NearestPiece& c) {
      const Vec u = load3(&p.v[3 * i]) - all_.velocity(c.segment, c.s, elapsed);
      of_force(i, p.length[i] * all_.law_.force(c.gap, u));
    });
  }

  const StrandInteraction& all_;
  int strand_;
  mutable std::vector<std::pair<std::size_t, NearestPiece>> found_;
  mutable std::vector<double> found_at_;
  mutable double found_when_ = 0;
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
    each_nearest(grid_, law_.inner(), strand, x, [&](const NearestPiece& c) {
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
      each_nearest(grid, reach, sample.strand, sample.x, [&](const NearestPiece& c) {
        least = std::min(least, dot(c.gap, c.gap));
      });
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
