#include "models/cut/graded_cut.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

#include "contract/forms/energetics.h"
#include "models/clothoid/super_clothoid.h"
#include "models/effects/gravity.h"
#include "models/reduced/super_helix.h"
#include "models/strand/geometry.h"

namespace tress::models {
namespace {

constexpr int passes = 4;
constexpr int samples = 8;                                    // of an element
constexpr double least_share = .3, least_linear_share = .15;  // of the mean density
constexpr int finer = 4;  // helices for an element of linear curvature
constexpr int least_helices = 48;
constexpr double rounding = 1e-14;

/// Part of the rod: one sample of one element.
struct Piece {
  double length;   // m
  double element;  // length of its element, m
  double rate;     // |kappa'|, 1/m^2
  double second;   // |kappa''|, 1/m^3
  Vec moves;       // world components of kappa' x e0
};

std::vector<Piece> pieces_at_rest(const LoadedRod& rod,
                                  const std::vector<double>& lengths) {
  const Strand strand = cut_into(rod, lengths);
  const std::vector<double> q = coordinates_at_rest(strand, rod.load);
  const Vec k = stiffness(rod.material, rod.section);
  const auto times = [](const Vec& a, const Vec& b) {
    return Vec{a.x * b.x, a.y * b.y, a.z * b.z};
  };
  const Vec flexible{1 / k.x, 1 / k.y, 1 / k.z};
  std::vector<Piece> all;
  Frame frame = rod.clamp;
  double start = 0;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const Vec kappa = load3(&q[3 * i]);
    const double ds = lengths[i] / samples;
    for (int j = 0; j < samples; ++j) {
      const double s = start + (j + 0.5) * ds;
      const Vec natural = rod.natural(s);
      const Vec before = rod.natural(s - ds / 2), after = rod.natural(s + ds / 2);
      const Vec changes = 1 / ds * (after - before),
                bend = after - 2.0 * natural + before;
      // A shape that is linear to rounding does not bend.
      const Vec second_changes =
          norm(bend) > rounding * norm(natural) ? 4 / (ds * ds) * bend : Vec{};
      const Frame here = frame * helix_turn(kappa, s - start);
      const Vec beyond = here.back((rod.length - s) * rod.load);
      const Vec rate = changes + times(flexible, cross(times(k, kappa - natural), kappa) +
                                                     cross(beyond, Vec{1, 0, 0}));
      const Vec second =
          second_changes -
          times(flexible,
                cross(rate, times(k, kappa - natural)) +
                    cross(kappa, times(k, rate - changes)) +
                    cross(cross(kappa, beyond) + here.back(rod.load), Vec{1, 0, 0}));
      all.push_back(
          {ds, lengths[i], norm(rate), norm(second), here * cross(rate, Vec{1, 0, 0})});
    }
    frame = frame * helix_turn(kappa, lengths[i]);
    start += lengths[i];
  }
  return all;
}

/// `share` is a density, one value for each piece.
std::vector<double> shared_equally(const std::vector<Piece>& pieces,
                                   std::vector<double> share, double least, double length,
                                   int elements) {
  double mean = 0;
  for (std::size_t k = 0; k < share.size(); ++k) {
    mean += share[k] * pieces[k].length / length;
  }
  double all = 0;
  for (std::size_t k = 0; k < share.size(); ++k) {
    share[k] = mean > 0 ? std::max(share[k], least * mean) : 1;
    all += share[k] * pieces[k].length;
  }
  std::vector<double> ends;
  double before = 0, s = 0;
  for (std::size_t k = 0; k < share.size(); ++k) {
    const double own = share[k] * pieces[k].length;
    while (std::ssize(ends) + 1 < elements &&
           before + own >= all * static_cast<double>(ends.size() + 1) / elements) {
      const double part =
          (all * static_cast<double>(ends.size() + 1) / elements - before) / own;
      ends.push_back(s + part * pieces[k].length);
    }
    before += own;
    s += pieces[k].length;
  }
  ends.push_back(length);
  std::adjacent_difference(ends.begin(), ends.end(), ends.begin());
  return ends;
}

std::vector<double> share_of_rates(const std::vector<Piece>& pieces) {
  std::vector<double> share;
  for (const Piece& piece : pieces) share.push_back(std::cbrt(piece.rate * piece.rate));
  return share;
}

double error_of(const std::vector<Piece>& pieces) {
  Vec sum;
  double most = 0;
  for (const Piece& piece : pieces) {
    sum = sum + (piece.element * piece.element * piece.length / 12) * piece.moves;
    most = std::max(most, norm(sum));
  }
  return most;
}

}  // namespace

std::vector<double> coordinates_at_rest(const Strand& strand, const Vec& load,
                                        ElementStrain strain) {
  const double line = strand.mass() / strand.length();
  Effects weight{std::make_shared<Gravity>((1 / line) * load)};
  const auto system = strain == ElementStrain::linear
                          ? super_clothoid(strand, {}, std::move(weight))
                          : super_helix(strand, {}, std::move(weight));
  const auto n = static_cast<std::size_t>(system->layout().coordinates);
  const std::size_t each = n / strand.segments.size();
  std::vector<double> q(n), zero(n), r(n), moved(n), q_typ(n), v_typ(n);
  system->initial_state(q, zero);
  system->scale(q_typ, v_typ);
  Energetics* const energetics = system->energetics();
  double energy = energetics->energy(0, q, zero).potential;
  const double rate = v_typ[0] / q_typ[0];
  double inertia = rate * rate;  // of the mass beside the stiffness
  constexpr int most = 1000;
  constexpr double near = 1e-5;  // rad: there energies differ by less than rounding
  // rad over the whole strand; many elements may turn further altogether.
  const double longest = std::max(1.0, 0.2 * static_cast<double>(n / each));
  constexpr double close = 1e-6;
  const double heaviest = 1e12 * inertia;
  for (int i = 0; i < most; ++i) {
    // From the state at rest: the step of a body that has lost its velocity.
    Status s = system->residual(0, q, zero, zero, r);
    if (s == Status::ok) s = system->linearize(0, q, zero, zero, {inertia, 0, 1});
    if (s == Status::ok) s = system->solve(r, r);
    if (s == Status::ok) {
      double turn = 0;
      for (std::size_t k = 0; k < n; ++k) {
        turn += std::abs(r[k]) * strand.segments[k / each].length;
      }
      const double part = std::min(1.0, longest / turn);
      for (std::size_t k = 0; k < n; ++k) moved[k] = q[k] - part * r[k];
      const double then = energetics->energy(0, moved, zero).potential;
      const double noise = 1e-14 * (std::abs(energy) + std::abs(then));
      if (then <= energy + noise || turn < near) {
        q = moved;
        energy = then;
        if (turn < close && inertia < 1e-3 * rate * rate) return q;
        inertia /= 4;
        continue;
      }
    }
    inertia = std::max(8 * inertia, rate * rate);
    if (inertia > heaviest) break;
  }
  throw std::runtime_error("no equilibrium of a strand under its weight");
}

Strand cut_into(const LoadedRod& rod, const std::vector<double>& lengths,
                const Shape& initial) {
  Strand strand;
  strand.material = rod.material;
  strand.root.frame = rod.clamp;
  double from = 0;
  for (const double length : lengths) {
    const auto shifted = [from](const Shape& shape) {
      return shape ? Shape([&shape, from](double s) { return shape(from + s); }) : shape;
    };
    Segment segment = make_strand(rod.material, rod.section, {1, length, 1},
                                  shifted(rod.natural), shifted(initial))
                          .segments.front();
    segment.parent = static_cast<int>(strand.segments.size()) - 1;
    strand.segments.push_back(segment);
    from += length;
  }
  return strand;
}

GradedCut graded_cut(const LoadedRod& rod, int elements) {
  GradedCut cut;
  cut.lengths.assign(static_cast<std::size_t>(elements), rod.length / elements);
  std::vector<Piece> pieces = pieces_at_rest(rod, cut.lengths);
  for (int pass = 0; pass < passes; ++pass) {
    const std::vector<double> next =
        shared_equally(pieces, share_of_rates(pieces), least_share, rod.length, elements);
    // Halfway: where elements are few, whole passes swing about the answer.
    const double part = pass == 0 ? 1 : 0.5;
    for (std::size_t i = 0; i < next.size(); ++i) {
      cut.lengths[i] += part * (next[i] - cut.lengths[i]);
    }
    pieces = pieces_at_rest(rod, cut.lengths);
  }
  cut.error = error_of(pieces);
  return cut;
}

std::vector<double> linear_cut(const LoadedRod& rod, int elements) {
  const GradedCut fine = graded_cut(rod, std::max(least_helices, finer * elements));
  const std::vector<Piece> pieces = pieces_at_rest(rod, fine.lengths);
  std::vector<double> share;
  share.reserve(pieces.size());
  for (const Piece& piece : pieces) share.push_back(std::pow(piece.second, 0.4));
  return shared_equally(pieces, share, least_linear_share, rod.length, elements);
}

}  // namespace tress::models
