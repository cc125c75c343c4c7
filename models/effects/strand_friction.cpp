#include "models/effects/strand_friction.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace tress::models {
namespace {

constexpr Parameter parameters_of_friction[] = {
    {.name = "friction",
     .help = "Coulomb's coefficient; hair on hair 0.2 to 0.5",
     .number = 0.3,
     .min = 0,
     .max = 10},
    {.name = "thickness_m",
     .help = "distance of the axes of strands that touch; 0: the sum of their radii (m)",
     .number = 0,
     .min = 0,
     .max = 0.1},
    {.name = "own",
     .help = "whether a strand touches itself too, as in knots",
     .choices = "yes|no"},
    {.name = "tolerance_m_s",
     .help = "largest speed by which the law may be violated (m/s)",
     .number = 1e-6,
     .min = 1e-14,
     .max = 1},
    {.name = "sweeps",
     .help = "over all contacts in a step, at most",
     .number = 300,
     .min = 1,
     .max = 1e6,
     .whole = true},
};

// Of a contact's own compliance: without it sweeps stall where contacts are more than
// unknowns, with ten times as much they converge at half the rate where they are not.
constexpr double proximal = 1e-2;

// Of the thickness and of what points move in a step: by so much forces may move them
// farther before pairs are gathered again.
constexpr double more_room = 0.25;

// A step ends where forces drive no further pairs into each other; a heap settles what
// is left in the next step.
constexpr int most_rounds = 8;

// Part of an overlap at the start of a step that may be left at its end: what is undone
// at once is a speed in the next step.
constexpr double kept = 0.8;

// Part of the thickness by which a pair that has a contact may be nearer than that at
// another place before it gets a second one.
constexpr double second_place = 0.1;

// Of the thickness: so much farther apart a pair that touched in the last step counts
// still, since forces of others may close it again.
constexpr double stays = 0.5;

// Of the thickness: contacts nearer than this along both strands are one.
constexpr double joint = 0.25;

/// The bend of a strand that touches itself is a half turn at least.
constexpr double half_turn = 0.5 * std::numbers::pi;

StrandFriction::Law law_of(const Parameters& p) {
  return {.friction = p.number("friction"),
          .thickness = p.number("thickness_m"),
          .own = p.word("own") == "yes",
          .tolerance = p.number("tolerance_m_s"),
          .sweeps = p.whole("sweeps")};
}

std::vector<int> counts_of(std::span<const StrandFriction::OfStrand> strands) {
  std::vector<int> points;
  for (const auto& strand : strands) points.push_back(strand.points);
  return points;
}

double widest_of(const StrandFriction::Law& law,
                 std::span<const StrandFriction::OfStrand> strands) {
  if (law.thickness > 0) return law.thickness;
  double widest = 0;
  for (const auto& strand : strands) widest = std::max(widest, 2 * strand.radius);
  return widest;
}

/// Within this distance of the middle of a segment is all that may touch it at rest.
double reach_of(const StrandFriction::Law& law,
                std::span<const StrandFriction::OfStrand> strands) {
  double longest = 0;
  for (const auto& strand : strands) longest = std::max(longest, strand.longest);
  return 0.5 * longest + widest_of(law, strands);
}

/// Axes with the normal first.
Mat3 axes_of(const Vec& normal) {
  const Vec aside = std::abs(normal.x) < 0.6 ? Vec{1, 0, 0} : Vec{0, 1, 0};
  const Vec across = cross(normal, aside);
  const Vec first = (1 / norm(across)) * across;
  return {normal, first, cross(normal, first)};
}

/// Order of contacts.
constexpr auto by_pair = [](const auto& a, const auto& b) {
  return std::pair(a.first, a.second) < std::pair(b.first, b.second);
};

}  // namespace

std::span<const Parameter> strand_friction_parameters() { return parameters_of_friction; }

StrandFriction::StrandFriction(const Parameters& parameters,
                               std::span<const OfStrand> strands)
    : StrandFriction(law_of(parameters), strands) {}

StrandFriction::StrandFriction(const Law& law, std::span<const OfStrand> strands)
    : law_(law),
      grid_(counts_of(strands), reach_of(law, strands)),
      widest_(widest_of(law, strands)) {
  std::size_t first_point = 0;
  for (std::size_t k = 0; k < strands.size(); ++k) {
    const auto points = static_cast<std::size_t>(strands[k].points);
    strands_.push_back({.first_point = first_point,
                        .radius = strands[k].radius,
                        .touched = {},
                        .place = std::vector<int>(points, -1),
                        .compliance = {},
                        .body = -1});
    first_point += points;
  }
  boxes_.resize(grid_.segments());
  arc_.resize(first_point);
}

void StrandFriction::begin(double h, In from, In to, In u) {
  h_ = h;
  from_.assign(from.begin(), from.end());
  to_.assign(to.begin(), to.end());
  now_ = to_;
  u_.assign(u.begin(), u.end());
  before_ = std::exchange(known_, {});
  for (Touched& strand : strands_) {
    for (const int point : strand.touched) {
      strand.place[static_cast<std::size_t>(point)] = -1;
    }
    strand.touched.clear();
    strand.body = -1;
    const std::size_t first = strand.first_point;
    arc_[first] = 0;
    for (std::size_t i = first + 1; i < first + strand.place.size(); ++i) {
      arc_[i] = arc_[i - 1] + norm(load3(&from_[3 * i]) - load3(&from_[3 * i - 3]));
    }
  }
  touching_.clear();
  stale_.clear();
  rounds_ = 0;
  outcome_ = {};
}

double StrandFriction::thickness(int first, int second) const {
  if (law_.thickness > 0) return law_.thickness;
  return strands_[strand_of(first)].radius + strands_[strand_of(second)].radius;
}

std::array<std::size_t, 4> StrandFriction::ends(int first, int second) const {
  const std::size_t a = point_of(first), b = point_of(second);
  return {a, a + 1, b, b + 1};
}

void StrandFriction::place_boxes() {
  for (std::size_t i = 0; i < boxes_.size(); ++i) {
    const std::size_t at = point_of(static_cast<int>(i));
    Vec least = load3(&from_[3 * at]), most = least;
    for (const std::size_t point : {at, at + 1}) {
      for (const double* x : {&from_[3 * point], &now_[3 * point]}) {
        least = {std::min(least.x, x[0]), std::min(least.y, x[1]),
                 std::min(least.z, x[2])};
        most = {std::max(most.x, x[0]), std::max(most.y, x[1]), std::max(most.z, x[2])};
      }
    }
    boxes_[i] = {least, most};
  }
}

bool StrandFriction::apart(int first, int second, double thick) const {
  const Box& a = boxes_[static_cast<std::size_t>(first)];
  const Box& b = boxes_[static_cast<std::size_t>(second)];
  return a.least.x > b.most.x + thick || b.least.x > a.most.x + thick ||
         a.least.y > b.most.y + thick || b.least.y > a.most.y + thick ||
         a.least.z > b.most.z + thick || b.least.z > a.most.z + thick;
}

MovingPieces StrandFriction::pieces(int first, int second) const {
  MovingPieces all;
  const std::array<std::size_t, 4> points = ends(first, second);
  for (std::size_t end = 0; end < 4; ++end) {
    all.from[end] = load3(&from_[3 * points[end]]);
    all.to[end] = load3(&now_[3 * points[end]]);
  }
  return all;
}

double StrandFriction::arc(int piece, double part) const {
  const double* from = &arc_[point_of(piece)];
  return (1 - part) * from[0] + part * from[1];
}

/// Whether two contacts of the same strands are one, seen by two pieces at a joint.
bool StrandFriction::one_place(const Known& a, const Known& b) const {
  const double near = joint * thickness(a.first, a.second);
  return std::abs(arc(a.first, a.at.s) - arc(b.first, b.at.s)) < near &&
         std::abs(arc(a.second, a.at.t) - arc(b.second, b.at.t)) < near;
}

/// The one of these, ordered by pair, that is the contact found; their end: none.
std::vector<StrandFriction::Known>::iterator StrandFriction::seen(
    const Known& found, std::vector<Known>& all) const {
  for (int i = found.first - 1; i <= found.first + 1; ++i) {
    // A piece before the first or after the last is that of another strand.
    if (i < 0 || i == static_cast<int>(boxes_.size()) ||
        strand_of(i) != strand_of(found.first)) {
      continue;
    }
    Known from{i, found.second - 1, {}, {}};
    auto at = std::lower_bound(all.begin(), all.end(), from, by_pair);
    for (; at != all.end() && at->first == i && at->second <= found.second + 1; ++at) {
      if (strand_of(at->second) == strand_of(found.second) && one_place(*at, found)) {
        return at;
      }
    }
  }
  return all.end();
}

void StrandFriction::look(int first, int second) {
  const bool same = strand_of(first) == strand_of(second);
  if (same && (!law_.own || second - first < 2)) return;
  const double thick = thickness(first, second);
  Known found{first, second, {}, {}};
  const auto last = std::lower_bound(before_.begin(), before_.end(), found, by_pair);
  const bool touched = last != before_.end() && !by_pair(found, *last) &&
                       dot(last->force, last->force) > 0;
  const double reach = touched ? (1 + stays) * thick : thick;
  if (apart(first, second, reach)) return;
  const std::optional<PieceTouch> at = touch(pieces(first, second), reach);
  if (!at) return;
  found.at = *at;
  // Along a bend a strand is near itself by its thickness.
  if (same && arc(second, at->t) - arc(first, at->s) < half_turn * thick) return;
  if (seen(found, known_) != known_.end()) return;
  // Of two pieces at a joint the nearer one has the normal; the other is met at its end.
  if (const auto same_place = seen(found, found_); same_place != found_.end()) {
    if (gap(*same_place, now_) <= gap(found, now_)) return;
    found_.erase(same_place);
  }
  const bool again = std::binary_search(known_.begin(), known_.end(), found, by_pair);
  if (again && gap(found, now_) > -second_place * thick) return;
  if (!again && touched) found.force = last->force;
  found_.push_back(found);
}

/// The largest distance of a point from where it is, m.
double StrandFriction::farthest(In from) const {
  double square = 0;
  for (std::size_t i = 0; i < now_.size(); i += 3) {
    const Vec moved = load3(&now_[i]) - load3(&from[i]);
    square = std::max(square, dot(moved, moved));
  }
  return std::sqrt(square);
}

/// Pairs whose boxes of the step are near each other, with room for forces to move them.
void StrandFriction::gather() {
  const double moved = farthest(from_);
  room_ = more_room * (widest_ + moved);
  gathered_ = now_;
  grid_.update(from_, 2 * (moved + room_));
  near_.clear();
  for (int i = 0; i < static_cast<int>(boxes_.size()); ++i) {
    int last = i;
    for (const SegmentGrid::Entry& entry : grid_.near(grid_.piece(i).at(0.5))) {
      if (entry.segment <= last) continue;  // they ascend, some appear twice
      last = entry.segment;
      if (!apart(i, last, widest_ + 2 * room_)) near_.emplace_back(i, last);
    }
  }
}

bool StrandFriction::find() {
  if (rounds_++ == most_rounds) return false;
  place_boxes();
  if (rounds_ == 1 || farthest(gathered_) > room_) gather();
  found_.clear();
  for (const auto& [first, second] : near_) look(first, second);
  stale_.clear();
  if (found_.empty()) return false;
  known_.insert(known_.end(), found_.begin(), found_.end());
  std::ranges::stable_sort(known_, by_pair);
  touch_points();
  return true;
}

/// The gap that the step may leave, <= 0.
double StrandFriction::deepest(const Known& known) const {
  return std::min(0.0, kept * gap(known, from_));
}

/// Takes the points of contacts found last.
void StrandFriction::touch_points() {
  for (const Known& known : found_) {
    for (const int piece : {known.first, known.second}) {
      const std::size_t k = strand_of(piece);
      Touched& strand = strands_[k];
      const std::size_t first = point_of(piece) - strand.first_point;
      for (const std::size_t point : {first, first + 1}) {
        if (strand.place[point] >= 0) continue;
        strand.place[point] = 0;
        strand.touched.push_back(static_cast<int>(point));
        stale_.push_back(k);
      }
    }
  }
  touching_.insert(touching_.end(), stale_.begin(), stale_.end());
  for (auto* strands : {&stale_, &touching_}) {
    std::ranges::sort(*strands);
    strands->erase(std::unique(strands->begin(), strands->end()), strands->end());
  }
  for (const std::size_t k : stale_) {
    Touched& strand = strands_[k];
    std::ranges::sort(strand.touched);
    for (std::size_t i = 0; i < strand.touched.size(); ++i) {
      strand.place[static_cast<std::size_t>(strand.touched[i])] = static_cast<int>(i);
    }
  }
}

/// Less the thickness, m.
double StrandFriction::gap(const Known& known, In x) const {
  const std::array<double, 4> weights = known.at.weights();
  const std::array<std::size_t, 4> points = ends(known.first, known.second);
  Vec sum;
  for (std::size_t end = 0; end < 4; ++end) {
    sum = sum + weights[end] * load3(&x[3 * points[end]]);
  }
  return dot(known.at.normal, sum) - thickness(known.first, known.second);
}

ContactProblem::Contact StrandFriction::contact(const Known& known) const {
  ContactProblem::Contact contact{};
  contact.axes = axes_of(known.at.normal);
  const std::array<double, 4> weights = known.at.weights();
  const std::array<std::size_t, 4> points = ends(known.first, known.second);
  Vec u;
  for (std::size_t end = 0; end < 4; ++end) {
    const Touched& strand = strands_[strand_of(end < 2 ? known.first : known.second)];
    u = u + weights[end] * load3(&u_[3 * points[end]]);
    contact.ends[end] = {strand.body, strand.place[points[end] - strand.first_point],
                         weights[end]};
  }
  contact.free = contact.axes * u;
  contact.free.x = (gap(known, to_) - deepest(known)) / h_;
  contact.force = contact.axes * known.force;
  return contact;
}

void StrandFriction::respond(std::size_t strand, In compliance) {
  std::vector<Mat3>& blocks = strands_[strand].compliance;
  blocks.clear();
  for (std::size_t i = 0; i < compliance.size(); i += 9) {
    const double* row = &compliance[i];
    blocks.push_back({load3(row), load3(row + 3), load3(row + 6)});
  }
}

void StrandFriction::solve() {
  problem_.clear();
  for (const std::size_t k : touching_) {
    Touched& strand = strands_[k];
    strand.body =
        problem_.add_body(strand.compliance, static_cast<int>(strand.touched.size()));
  }
  for (const Known& known : known_) problem_.add(contact(known));
  const ContactProblem::Outcome outcome =
      problem_.solve(law_.friction, proximal, law_.tolerance, law_.sweeps);
  outcome_ = {outcome_.sweeps + outcome.sweeps, outcome.violation};
  for (std::size_t i = 0; i < known_.size(); ++i) {
    const ContactProblem::Contact& solved = problem_.contacts()[i];
    known_[i].force = solved.force * solved.axes;
  }
}

void StrandFriction::place(std::size_t strand, In x) {
  std::ranges::copy(
      x, now_.begin() + static_cast<std::ptrdiff_t>(3 * strands_[strand].first_point));
}

std::vector<double> StrandFriction::forces(std::size_t strand) const {
  std::vector<double> all;
  for (const Vec& f : problem_.forces(static_cast<std::size_t>(strands_[strand].body))) {
    all.insert(all.end(), {f.x, f.y, f.z});
  }
  return all;
}

void StrandFriction::add_loads(std::size_t strand, InOut f) const {
  if (strands_[strand].body < 0) return;
  const std::vector<double> all = forces(strand);
  for (std::size_t i = 0; i < strands_[strand].touched.size(); ++i) {
    double* to = &f[3 * static_cast<std::size_t>(strands_[strand].touched[i])];
    store3(load3(to) + load3(&all[3 * i]), to);
  }
}

std::vector<double> StrandFriction::memory() const {
  std::vector<double> all;
  for (const Known& known : known_) {
    const Vec& f = known.force;
    for (const double x : {static_cast<double>(known.first),
                           static_cast<double>(known.second), f.x, f.y, f.z}) {
      all.push_back(x);
    }
  }
  return all;
}

void StrandFriction::recall(In memory) {
  known_.clear();
  for (std::size_t i = 0; i < memory.size(); i += 5) {
    known_.push_back({static_cast<int>(memory[i]),
                      static_cast<int>(memory[i + 1]),
                      {},
                      load3(&memory[i + 2])});
  }
}

}  // namespace tress::models
