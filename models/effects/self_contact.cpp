#include "models/effects/self_contact.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "contract/input_error.h"

namespace tress::models {
namespace {

const std::string where = "effects.self_contact";

/// The next point after i that carries length; p.length.size() when there is none.
std::size_t next(const Points& p, std::size_t i) {
  while (++i < p.length.size() && p.length[i] == 0) {
  }
  return i;
}

}  // namespace

std::span<const Parameter> self_contact_parameters() {
  static const std::vector<Parameter> all = [] {
    const std::span<const Parameter> law = contact_parameters();
    std::vector<Parameter> list(law.begin(), law.end());
    list.push_back({.name = "separation_m",
                    .help = "least distance along the strand between parts that may "
                            "touch (m)",
                    .number = 2e-2,
                    .min = 1e-9,
                    .max = 1e6});
    return list;
  }();
  return all;
}

std::unique_ptr<const Effect> make_self_contact(const Parameters& parameters,
                                                const RootMotion&) {
  return std::make_unique<SelfContact>(ContactLaw(parameters, where),
                                       parameters.number("separation_m"));
}

SelfContact::SelfContact(const ContactLaw& law, double separation)
    : law_(law), separation_(separation) {
  if (std::isfinite(separation) && separation > law.reach()) return;
  throw InputError("separation_m is not larger than the contact's radius", where,
                   "give more than outer_radius_m: a straight strand must not touch "
                   "itself");
}

/// Rest lengths: half of each point's length to either side, all of it at strand ends.
inline SelfContact::Edge SelfContact::first_edge(const Points& p) {
  const std::size_t i = p.length.empty() || p.length[0] > 0 ? 0 : next(p, 0);
  Edge edge{i, i, 0, 0};
  if (i >= p.length.size()) return edge;
  go_on(p, edge);
  if (edge.j < p.length.size()) edge.length += p.length[i] / 2;
  return edge;
}

inline void SelfContact::go_on(const Points& p, Edge& edge) {
  edge.from += edge.length;
  edge.i = edge.j;
  edge.j = next(p, edge.i);
  if (edge.j >= p.length.size()) return;
  const bool last = next(p, edge.j) >= p.length.size();
  edge.length = p.length[edge.i] / 2 + p.length[edge.j] / (last ? 1 : 2);
}

/// The point nearest to x on edges between points `first` and `last`; false when none is
/// in reach. `stride`: no edge is longer.
bool SelfContact::nearest(const Points& p, const Vec& x, std::size_t first,
                          std::size_t last, double stride, Place& place) const noexcept {
  const double reach = law_.reach(), clear = reach + stride;
  double least = reach * reach;
  bool found = false;
  std::size_t skip = 0;
  for (std::size_t i = first; i < last; i = next(p, i + skip)) {
    const Vec start = load3(&p.x[3 * i]), lever = x - start;
    const double apart = dot(lever, lever);
    if (apart > clear * clear) {
      // Out of reach, as are all edges before: skip at least this many points.
      const double strides = (std::sqrt(apart) - clear) / stride;
      skip = static_cast<std::size_t>(std::min(strides, static_cast<double>(last - i)));
      continue;
    }
    skip = 0;
    const std::size_t j = next(p, i);
    if (j > last) break;
    const StraightPiece piece(start, load3(&p.x[3 * j]));
    const double at = piece.nearest(x);
    const Vec gap = x - piece.at(at);
    const double square = dot(gap, gap);
    if (square < least) {
      least = square;
      place = {i, j, at};
      found = true;
    }
  }
  return found;
}

template <class F>
void SelfContact::each_contact(const Points& p, F of_contact) const noexcept {
  const std::size_t count = p.length.size();
  if (count == 0) return;
  double stride = 0;
  for (Edge edge = first_edge(p); edge.j < count; go_on(p, edge)) {
    const Vec e = load3(&p.x[3 * edge.j]) - load3(&p.x[3 * edge.i]);
    stride = std::max(stride, norm(e));
  }
  const std::size_t first = first_edge(p).i;
  // They begin at the last point and the first that a sample may touch.
  Edge before = first_edge(p), after = before;
  for (Edge edge = first_edge(p); edge.j < count; go_on(p, edge)) {
    const Vec start = load3(&p.x[3 * edge.i]), end = load3(&p.x[3 * edge.j]);
    const double samples = std::ceil(2 * edge.length / law_.inner());
    for (double k = 0.5; k < samples; ++k) {
      const double sigma = k / samples, arc = edge.from + sigma * edge.length;
      const Vec x = (1 - sigma) * start + sigma * end;
      while (before.j < count && before.from + before.length <= arc - separation_) {
        go_on(p, before);
      }
      while (after.j < count && after.from < arc + separation_) go_on(p, after);
      const auto meet = [&](std::size_t from, std::size_t to) {
        Place place{};
        if (!nearest(p, x, from, to, stride, place)) return;
        const std::array<std::size_t, 4> points{edge.i, edge.j, place.i, place.j};
        PieceContact::Points at, moving;
        for (std::size_t a = 0; a < 4; ++a) {
          at[a] = load3(&p.x[3 * points[a]]);
          moving[a] = p.v.empty() ? Vec{} : load3(&p.v[3 * points[a]]);
        }
        of_contact(points,
                   PieceContact(at, moving, sigma, place.at, edge.length / samples / 2));
      };
      meet(first, before.i);
      meet(after.i, count - 1);
    }
  }
}

void SelfContact::add_load(double, const Points& p, InOut f) const noexcept {
  each_contact(p, [&](const auto& points, const PieceContact& contact) {
    const Vec force = contact.force(law_);
    for (std::size_t a = 0; a < 4; ++a) {
      double* to = &f[3 * points[a]];
      store3(load3(to) + contact.weight(a) * force, to);
    }
  });
}

void SelfContact::add_derivatives(double, const Points& p, double pos, double vel,
                                  InOut blocks) const noexcept {
  each_contact(p, [&](const auto& points, const PieceContact& contact) {
    const Coupling coupling = contact.coupling(law_, points);
    for (std::size_t a = 0; a < 4; ++a) {
      coupling.add_block(a, a, pos, vel, &blocks[9 * points[a]]);
    }
  });
}

void SelfContact::add_couplings(double, const Points& p,
                                std::vector<Coupling>& all) const {
  each_contact(p, [&](const auto& points, const PieceContact& contact) {
    all.push_back(contact.coupling(law_, points));
  });
}

double SelfContact::potential(double, const Points& p) const noexcept {
  double sum = 0;
  each_contact(p, [&](const auto&, const PieceContact& contact) {
    sum += contact.potential(law_);
  });
  return sum;
}

double SelfContact::power(double, const Points& p) const noexcept {
  double sum = 0;
  each_contact(
      p, [&](const auto&, const PieceContact& contact) { sum += contact.power(law_); });
  return sum;
}

}  // namespace tress::models
