#include "models/effects/strand_friction.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <numeric>
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
     .help = "largest number of sweeps over all contacts in a step",
     .number = 300,
     .min = 1,
     .max = 1e6,
     .whole = true},
};

// Of a contact's own compliance: without it sweeps stall where contacts are more than
// unknowns, with ten times as much they converge at half the rate where they are not.
constexpr double proximal = 1e-2;

// A step ends where forces drive no further pairs into each other; a heap settles what
// is left in the next step.
constexpr int most_rounds = 8;

// Part of an overlap at the start of a step that may be left at its end: what is undone
// at once is a speed in the next step.
constexpr double kept = 0.8;

// Part of the thickness by which a pair that has a contact may be nearer than that at
// another place before it gets a second one.
constexpr double second_place = 0.1;

// Of the thickness: so much farther from an obstacle a point that it pushed in the last
// step has its contact still, since forces of others may close it again.
constexpr double stays = 0.5;

constexpr std::size_t contact_group = 256;  // of contacts that one thread sets at a time

// Of the thickness: contacts nearer than this along both strands are one.
constexpr double joint = 0.25;

StrandFriction::Law law_of(const Parameters& p) {
  return {.friction = p.number("friction"),
          .thickness = p.number("thickness_m"),
          .own = p.word("own") == "yes",
          .tolerance = p.number("tolerance_m_s"),
          .sweeps = p.whole("sweeps")};
}

/// Ascending, each once.
void unique(std::vector<std::size_t>& strands) {
  std::ranges::sort(strands);
  strands.erase(std::unique(strands.begin(), strands.end()), strands.end());
}

/// By which contacts are ordered.
constexpr auto pair_of = [](const auto& known) {
  return std::pair(known.first, known.second);
};

}  // namespace

/// With the force (N, world) that it had in the last step.
void StrandFriction::Known::start_from(const Vec& last, const Vec& normal) {
  force = axes_about(normal) * last;
  world = last;
}

std::span<const Parameter> strand_friction_parameters() { return parameters_of_friction; }

StrandFriction::StrandFriction(const Parameters& parameters,
                               std::span<const PieceSearch::Strand> strands,
                               std::vector<std::shared_ptr<const Obstacle>> obstacles)
    : law_(law_of(parameters)),
      search_(strands, law_.thickness, law_.own),
      obstacles_(std::move(obstacles)) {
  double longest = 0;
  for (const PieceSearch::Strand& strand : strands) {
    longest = std::max(longest, strand.longest);
    strands_.push_back(
        {.touched = {},
         .place = std::vector<int>(static_cast<std::size_t>(strand.points), -1),
         .compliance = {},
         .forces = {}});
  }
  for (const auto& obstacle : obstacles_) {
    const double parts = std::ceil(longest / obstacle->spacing());
    parts_.push_back(static_cast<int>(std::clamp(parts, 1.0, double{most_parts})));
  }
}

void StrandFriction::begin(double t, double h, In from, In to, In u) {
  t_ = t;
  h_ = h;
  search_.begin(from, to);
  u_.assign(u.begin(), u.end());
  std::swap(before_, known_);
  before_.list(search_.pieces());
  known_.all.clear();
  known_.list(search_.pieces());
  problem_.clear();
  for (Touched& strand : strands_) {
    for (const int point : strand.touched) {
      strand.place[static_cast<std::size_t>(point)] = -1;
    }
    strand.touched.clear();
    strand.forces.clear();
    strand.body = -1;
  }
  touching_.clear();
  moved_.clear();
  rounds_ = 0;
  outcome_ = {};
}

/// Whether two contacts of the same strands are one, seen by two pieces at a joint.
bool StrandFriction::one_place(const Known& a, const Known& b) const {
  const double near = joint * search_.thickness(a.first, a.second);
  return std::abs(search_.arc(a.first, a.at.s) - search_.arc(b.first, b.at.s)) < near &&
         std::abs(search_.arc(a.second, a.at.t) - search_.arc(b.second, b.at.t)) < near;
}

void StrandFriction::Ordered::list(std::size_t pieces) {
  first.assign(pieces + 1, 0);
  for (const Known& known : all) ++first[static_cast<std::size_t>(known.first) + 1];
  std::partial_sum(first.begin(), first.end(), first.begin());
}

std::span<const StrandFriction::Known> StrandFriction::Ordered::of(int piece) const {
  const auto i = static_cast<std::size_t>(piece);
  return std::span(all).subspan(first[i], first[i + 1] - first[i]);
}

/// The first one of that pair; null: none.
const StrandFriction::Known* StrandFriction::Ordered::of(int piece, int second) const {
  const std::span<const Known> some = of(piece);
  const auto at = std::ranges::find(some, second, &Known::second);
  return at == some.end() ? nullptr : &*at;
}

/// The one of these, of pieces next to its first one, that is the contact found; null:
/// none.
const StrandFriction::Known* StrandFriction::seen(const Known& found,
                                                  std::span<const Known> some) const {
  const auto same = [&](const Known& known) {
    return known.second >= 0 && std::abs(known.second - found.second) <= 1 &&
           strand_of(known.first) == strand_of(found.first) &&
           strand_of(known.second) == strand_of(found.second) && one_place(known, found);
  };
  const auto at = std::ranges::find_if(some, same);
  return at == some.end() ? nullptr : &*at;
}

/// Whether its first piece, or one next to that, has the contact found.
bool StrandFriction::is_known(const Known& found) const {
  const int last = std::min(found.first + 1, static_cast<int>(search_.pieces()) - 1);
  for (int i = std::max(0, found.first - 1); i <= last; ++i) {
    if (seen(found, known_.of(i)) != nullptr) return true;
  }
  return false;
}

/// Adds to found_ what is no contact yet.
void StrandFriction::admit(const PieceSearch::Found& at) {
  Known found{at, {}, {}, {}};
  if (is_known(found)) return;
  // Of two pieces at a joint the nearer one has the normal; the other is met at its end.
  while (recent_ < found_.size() && found_[recent_].first < found.first - 1) ++recent_;
  const auto recent = std::span<const Known>(found_).subspan(recent_);
  if (const Known* const same_place = seen(found, recent); same_place != nullptr) {
    if (search_.gap_now(*same_place) <= search_.gap_now(found)) return;
    found_.erase(found_.begin() + (same_place - found_.data()));
  }
  const bool again = known_.of(found.first, found.second) != nullptr;
  if (again && search_.gap_now(found) >
                   -second_place * search_.thickness(found.first, found.second)) {
    return;
  }
  const Known* const last = before_.of(found.first, found.second);
  if (!again && last != nullptr) found.start_from(last->world, found.at.normal);
  found_.push_back(found);
}

/// Places on a strand that are in an obstacle and have no contact with it yet.
void StrandFriction::look(const Obstacle::Step& step, std::size_t obstacle,
                          std::size_t strand, std::vector<Known>& found) const {
  const int parts = parts_[obstacle];
  const auto pieces = static_cast<int>(search_.points(strand)) - 1;
  const int first = search_.piece_of(strand, 0);
  for (int piece = first; piece < first + pieces; ++piece) {
    const std::size_t x = 3 * search_.point_of(piece);
    const auto place = [&](In all, double s) {
      return (1 - s) * load3(&all[x]) + s * load3(&all[x + 3]);
    };
    // A piece begins where the one before ends.
    for (int part = piece == first ? 0 : 1; part <= parts; ++part) {
      Known at{{piece, code(obstacle, part), {}}, {}, {}, {}};
      if (known_.of(piece, at.second) != nullptr) continue;
      const Known* const last = before_.of(at.first, at.second);
      const bool pushed = last != nullptr && dot(last->world, last->world) > 0;
      at.at.s = static_cast<double>(part) / parts;
      const auto plane =
          step.touch(place(search_.from(), at.at.s), place(search_.now(), at.at.s),
                     pushed ? stays * search_.thickness(piece, piece) : 0);
      if (!plane) continue;
      at.plane = *plane;
      if (pushed) at.start_from(last->world, at.plane.normal);
      found.push_back(at);
    }
  }
}

void StrandFriction::find_on_obstacles(const Loop& loop) {
  on_obstacles_.resize(strands_.size());
  for (std::vector<Known>& found : on_obstacles_) found.clear();
  for (std::size_t o = 0; o < obstacles_.size(); ++o) {
    const Obstacle::Step step(*obstacles_[o], t_, h_);
    loop(strands_.size(), [&](std::size_t k) {
      if (search_.moved(k)) look(step, o, k, on_obstacles_[k]);
    });
  }
}

/// Where the step ends.
void StrandFriction::measure_depth() {
  for (const Known& known : known_.all) {
    if (known.second >= 0) deepest_ = std::max(deepest_, search_.depth(known));
  }
}

bool StrandFriction::find(const Loop& loop) {
  if (rounds_++ == most_rounds) {
    measure_depth();
    return false;
  }
  found_.clear();
  recent_ = 0;
  find_on_obstacles(loop);
  // A pair that pushed in the last step counts a little farther apart.
  const auto pushed = [this](int first, int second) {
    const Known* const last = before_.of(first, second);
    return last != nullptr && dot(last->world, last->world) > 0;
  };
  for (const PieceSearch::Found& at : search_.find(loop, pushed)) admit(at);
  for (const std::vector<Known>& found : on_obstacles_) {
    found_.insert(found_.end(), found.begin(), found.end());
  }
  for (const std::size_t k : stale_) strands_[k].stale = false;
  stale_.clear();
  if (found_.empty()) {
    measure_depth();
    return false;
  }
  if (!obstacles_.empty()) std::ranges::sort(found_, {}, pair_of);
  const auto old = static_cast<std::ptrdiff_t>(known_.all.size());
  known_.all.insert(known_.all.end(), found_.begin(), found_.end());
  std::ranges::inplace_merge(known_.all, known_.all.begin() + old, {}, pair_of);
  known_.list(search_.pieces());
  touch_points();
  return true;
}

/// The points on which a contact acts, among all points, and their weights.
StrandFriction::OnPoints StrandFriction::on_points(const Known& known) const {
  if (known.second >= 0) {
    return {search_.ends(known.first, known.second), known.at.weights(), 4};
  }
  const std::size_t first = search_.point_of(known.first);
  const double s = known.at.s;
  if (s == 0) return {{first}, {1}, 1};
  if (s == 1) return {{first + 1}, {1}, 1};
  return {{first, first + 1}, {1 - s, s}, 2};
}

/// Takes the points of contacts found last.
void StrandFriction::touch_points() {
  for (const Known& known : found_) {
    const OnPoints on = on_points(known);
    for (std::size_t end = 0; end < on.count; ++end) {
      const std::size_t k = strand_of(end < 2 ? known.first : known.second);
      Touched& strand = strands_[k];
      const std::size_t point = on.point[end] - search_.first_point(k);
      if (strand.place[point] >= 0) continue;
      strand.place[point] = 0;
      strand.touched.push_back(static_cast<int>(point));
      if (!std::exchange(strand.stale, true)) stale_.push_back(k);
    }
  }
  touching_.insert(touching_.end(), stale_.begin(), stale_.end());
  std::ranges::sort(stale_);
  unique(touching_);
  for (const std::size_t k : stale_) {
    Touched& strand = strands_[k];
    std::ranges::sort(strand.touched);
    for (std::size_t i = 0; i < strand.touched.size(); ++i) {
      strand.place[static_cast<std::size_t>(strand.touched[i])] = static_cast<int>(i);
    }
  }
}

ContactProblem::Contact StrandFriction::contact(const Known& known) const {
  const bool on_obstacle = known.second < 0;
  const Vec& normal = on_obstacle ? known.plane.normal : known.at.normal;
  ContactProblem::Contact contact{};
  contact.axes = axes_about(normal);
  contact.friction =
      on_obstacle ? obstacles_[code_obstacle(known.second)]->friction() : law_.friction;
  const OnPoints on = on_points(known);
  Vec u, x, from;
  for (std::size_t end = 0; end < on.count; ++end) {
    const std::size_t k = strand_of(end < 2 ? known.first : known.second);
    const std::size_t point = on.point[end];
    u = u + on.weight[end] * load3(&u_[3 * point]);
    x = x + on.weight[end] * load3(&search_.to()[3 * point]);
    from = from + on.weight[end] * load3(&search_.from()[3 * point]);
    contact.ends[end] = {strands_[k].body,
                         strands_[k].place[point - search_.first_point(k)],
                         on.weight[end]};
  }
  for (std::size_t end = on.count; end < 4; ++end) {
    contact.ends[end] = {contact.ends[0].body, contact.ends[0].point, 0};
  }
  double gap = 0, before = 0;
  if (on_obstacle) {
    gap = known.plane.gap(x);
    before = known.plane.gap_before;
    u = (1 / h_) * (x - from) - known.plane.velocity;
  } else {
    gap = dot(normal, x) - search_.thickness(known.first, known.second);
    before = search_.gap_before(known);
  }
  contact.free = contact.axes * u;
  contact.free.x = (gap - std::min(0.0, kept * before)) / h_;
  contact.force = known.force;
  return contact;
}

void StrandFriction::respond(std::size_t strand, In compliance) {
  strands_[strand].compliance.set(compliance);
}

/// Those of the problem that are new, or of strands that are touched at other points now.
void StrandFriction::set_contacts(const Loop& loop) {
  for (const std::size_t k : stale_) {
    int& body = strands_[k].body;
    if (body >= 0) {
      problem_.renew_body(body);
    } else {
      body = problem_.add_body(strands_[k].compliance);
    }
  }
  const std::size_t old = problem_.contacts().size();
  problem_.add(found_.size());
  auto next = static_cast<int>(old);
  for (Known& known : known_.all) {
    if (known.contact < 0) known.contact = next++;
  }
  loop((known_.all.size() + contact_group - 1) / contact_group, [&](std::size_t g) {
    for (std::size_t i = g * contact_group;
         i < std::min(known_.all.size(), (g + 1) * contact_group); ++i) {
      const Known& known = known_.all[i];
      const auto number = static_cast<std::size_t>(known.contact);
      const bool same = number < old && !strands_[strand_of(known.first)].stale &&
                        (known.second < 0 || !strands_[strand_of(known.second)].stale);
      if (!same) problem_.set(number, contact(known));
    }
  });
}

void StrandFriction::solve(const Loop& loop) {
  set_contacts(loop);
  const ContactProblem::Outcome outcome =
      problem_.solve(proximal, law_.tolerance, law_.sweeps, loop);
  outcome_ = {outcome_.sweeps + outcome.sweeps, outcome.violation};
  if (outcome.violation > law_.tolerance) {
    outcome_.violation = problem_.stop_driving(law_.tolerance, loop);
  }
  for (Known& known : known_.all) {
    const auto& contact = problem_.contacts()[static_cast<std::size_t>(known.contact)];
    known.force = contact.force;
    known.world = contact.force * contact.axes;
  }
  loop(touching_.size(), [&](std::size_t i) { take_forces(strands_[touching_[i]]); });
  moved_.clear();
  std::ranges::copy_if(touching_, std::back_inserter(moved_),
                       [this](std::size_t k) { return strands_[k].moved; });
}

/// The forces on its points, and whether they are other ones than before.
void StrandFriction::take_forces(Touched& strand) {
  const std::span<const Vec> found =
      problem_.forces(static_cast<std::size_t>(strand.body));
  strand.moved = false;
  if (strand.forces.size() != 3 * found.size()) {  // those so far are on other points
    strand.moved = std::ranges::any_of(strand.forces, [](double f) { return f != 0; });
    strand.forces.assign(3 * found.size(), 0.0);
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    double* const known = &strand.forces[3 * i];
    const Vec& f = found[i];
    strand.moved |= known[0] != f.x || known[1] != f.y || known[2] != f.z;
    store3(f, known);
  }
}

void StrandFriction::place(std::size_t strand, In x) { search_.place(strand, x); }

void StrandFriction::add_loads(std::size_t strand, InOut f) const {
  const Touched& own = strands_[strand];
  for (std::size_t i = 0; i < own.touched.size(); ++i) {
    double* to = &f[3 * static_cast<std::size_t>(own.touched[i])];
    store3(load3(to) + load3(&own.forces[3 * i]), to);
  }
}

std::vector<double> StrandFriction::friction_used() const {
  std::vector<double> used(search_.to().size() / 3);
  for (const Known& known : known_.all) {
    // Before the first step there are forces without contacts (recall()).
    if (known.contact < 0) break;
    const auto& contact = problem_.contacts()[static_cast<std::size_t>(known.contact)];
    const double most = contact.friction * contact.force.x;
    if (!(most > 0)) continue;
    const double part =
        std::min(1.0, std::hypot(contact.force.y, contact.force.z) / most);
    const OnPoints on = on_points(known);
    for (std::size_t end = 0; end < on.count; ++end) {
      used[on.point[end]] = std::max(used[on.point[end]], part);
    }
  }
  return used;
}

/// Returns the drive. Where no forces satisfying the laws were found, it is at most the
/// tolerance (stop_driving()). Otherwise the forces x and velocities y of
/// contact_violation() are within e = violation/(2 - sqrt 2) of some x', y' that obey the
/// laws [Tseng 1996]. Then x_t.y_t <= e (|x_t'| + |y_t'| + e) - |x_t'| |y_t'| where it
/// slides. For forces beyond 3 e this is positive only at |y_t'| < 1.5 e. Smaller forces
/// act at less than 3 e on a slide. Rounding errors of a violation are those of sums of a
/// few velocities.
double StrandFriction::drive() const {
  constexpr double rounding = 8 * std::numeric_limits<double>::epsilon();
  double fastest = 0;
  for (const ContactProblem::Contact& contact : problem_.contacts()) {
    const double most = contact.friction * contact.force.x;
    const Vec u = problem_.velocity(contact), &f = contact.force;
    const double e = std::max(law_.tolerance, rounding * norm(u)) / (2 - std::sqrt(2));
    if (!(most > 0 && most * trace(contact.local) / 3 > 3 * e)) continue;
    fastest = std::max(fastest, (f.y * u.y + f.z * u.z) / most);
  }
  return fastest;
}

std::vector<StrandFriction::Touch> StrandFriction::touches() const {
  std::vector<Touch> all;
  for (const Known& known : known_.all) {
    if (known.second < 0) continue;
    all.push_back({strand_of(known.first), strand_of(known.second),
                   search_.arc(known.first, known.at.s),
                   search_.arc(known.second, known.at.t), known.world});
  }
  return all;
}

std::vector<double> StrandFriction::memory() const {
  std::vector<double> all{deepest_};
  for (const Known& known : known_.all) {
    const Vec& f = known.world;
    for (const double x : {static_cast<double>(known.first),
                           static_cast<double>(known.second), f.x, f.y, f.z}) {
      all.push_back(x);
    }
  }
  return all;
}

void StrandFriction::recall(In memory) {
  known_.all.clear();
  deepest_ = memory.empty() ? 0 : memory[0];
  for (std::size_t i = 1; i < memory.size(); i += 5) {
    known_.all.push_back(
        {{static_cast<int>(memory[i]), static_cast<int>(memory[i + 1]), {}},
         {},
         load3(&memory[i + 2]),
         {}});
  }
  touching_.clear();
  for (const Known& known : known_.all) {
    touching_.push_back(strand_of(known.first));
    if (known.second >= 0) touching_.push_back(strand_of(known.second));
  }
  unique(touching_);
}

}  // namespace tress::models
