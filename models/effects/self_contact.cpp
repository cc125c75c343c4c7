#include "models/effects/self_contact.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

#include "models/input_error.h"

namespace tress {
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
                    .help = "along the strand, of parts that touch each other (m)",
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

/// Lengths at rest: each point's, half to either side, all of it at the strand's ends.
SelfContact::Edge SelfContact::first_edge(const Points& p) {
  const std::size_t i = p.length.empty() || p.length[0] > 0 ? 0 : next(p, 0);
  Edge before{i, i, 0, 0, false};
  if (i >= p.length.size()) return {i, i, 0, 0, true};
  Edge edge = edge_after(p, before);
  if (edge.j < p.length.size()) edge.length += p.length[i] / 2;
  return edge;
}

SelfContact::Edge SelfContact::edge_after(const Points& p, const Edge& edge) {
  const std::size_t i = edge.j, j = next(p, i);
  Edge after{i, j, edge.from + edge.length, 0, true};
  if (j >= p.length.size()) return after;
  after.last = next(p, j) >= p.length.size();
  after.length = p.length[i] / 2 + p.length[j] / (after.last ? 1 : 2);
  return after;
}

/// The point nearest to x on edges that lie within [from, to] along the arc at rest;
/// false when none is in reach. `stride`: no edge is longer.
bool SelfContact::nearest(const Points& p, const Vec& x, double from, double to,
                          double stride, Place& place) const noexcept {
  const double reach = law_.reach();
  double least = reach * reach;
  bool found = false;
  int skip = 0;
  for (Edge edge = first_edge(p); edge.j < p.length.size(); edge = edge_after(p, edge)) {
    if (edge.from + edge.length > to) break;
    if (edge.from < from || skip-- > 0) continue;
    const StraightPiece piece(load3(&p.x[3 * edge.i]), load3(&p.x[3 * edge.j]));
    const double at = piece.nearest(x);
    const Vec gap = x - piece.at(at);
    const double square = dot(gap, gap);
    if (square < least) {
      least = square;
      place = {edge.i, edge.j, at};
      found = true;
    }
    // Edges until then are nearer to this one than the reach is short of the gap.
    const double strides = (std::sqrt(square) - reach) / stride;
    skip = strides > 1 ? static_cast<int>(std::min(strides, 1e6)) - 1 : 0;
  }
  return found;
}

template <class F>
void SelfContact::each_contact(const Points& p, F of_contact) const noexcept {
  double stride = 0;
  for (Edge edge = first_edge(p); edge.j < p.length.size(); edge = edge_after(p, edge)) {
    const Vec e = load3(&p.x[3 * edge.j]) - load3(&p.x[3 * edge.i]);
    stride = std::max(stride, norm(e));
  }
  for (Edge edge = first_edge(p); edge.j < p.length.size(); edge = edge_after(p, edge)) {
    const Vec start = load3(&p.x[3 * edge.i]), end = load3(&p.x[3 * edge.j]);
    const double samples = std::ceil(2 * edge.length / law_.inner());
    for (double k = 0.5; k < samples; ++k) {
      const double sigma = k / samples, arc = edge.from + sigma * edge.length;
      const Vec x = (1 - sigma) * start + sigma * end;
      Place place{};
      const auto meet = [&](double from, double to) {
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
      meet(0, arc - separation_);
      meet(arc + separation_, std::numeric_limits<double>::infinity());
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
    const PieceContact::Slopes slopes = contact.slopes(law_);
    for (std::size_t a = 0; a < 4; ++a) {
      contact.add_block(slopes, a, a, pos, vel, &blocks[9 * points[a]]);
    }
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

}  // namespace tress
