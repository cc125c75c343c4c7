#include "models/effects/control_mesh.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <tuple>
#include <utility>

#include "contract/input_error.h"
#include "math/closest.h"
#include "math/mat3.h"

namespace tress::models {
namespace {

const std::string where_mesh = "effects.control_mesh";

// A tenth of a hair's thickness: the direction of a link between points in one place.
constexpr double soft = 1e-5;  // m

double soft_length(const Vec& d) { return std::sqrt(dot(d, d) + soft * soft); }

std::vector<std::vector<double>> checked_guides(
    std::vector<std::vector<double>> segments) {
  for (std::size_t k = 0; k < segments.size(); ++k) {
    if (segments[k].size() >= 2) continue;
    throw InputError("strand " + std::to_string(k) + " has no point between its ends",
                     where_mesh, "give strands of at least two segments");
  }
  return segments;
}

}  // namespace

std::span<const Parameter> control_mesh_parameters() {
  static const std::vector<Parameter> all = [] {
    std::vector<Parameter> list{
        {.name = "width_m",
         .help = "largest distance of the roots of neighbouring guides (m). Places of "
                 "neighbours farther apart at rest have no link, and a strip of this "
                 "width has no density",
         .number = 0.05,
         .min = 1e-6,
         .max = 1e3},
        {.name = "link_stiffness_n_m2",
         .help =
             "stiffness of the links, per length of strand and length of link (N/m^2)",
         .number = 1e-2,
         .min = 0,
         .max = 1e12},
        {.name = "link_damping_n_s_m2",
         .help = "damping of the links, against the rate of their length (N s/m^2)",
         .number = 1e-4,
         .min = 0,
         .max = 1e12},
        {.name = "break_m",
         .help = "elongation at which a link breaks (m)",
         .number = 0.02,
         .min = 1e-9,
         .max = 1e3}};
    for (const Parameter& p : contact_parameters()) list.push_back(p);
    return list;
  }();
  return all;
}

ControlMesh::ControlMesh(const Parameters& parameters,
                         std::vector<std::vector<double>> segments)
    : width_(parameters.number("width_m")),
      stiffness_(parameters.number("link_stiffness_n_m2")),
      damping_(parameters.number("link_damping_n_s_m2")),
      break_(parameters.number("break_m")),
      law_(parameters, where_mesh),
      strips_act_(parameters.number("stiffness_n_m2") > 0 ||
                  parameters.number("viscosity_n_s_m2") > 0),
      segments_(checked_guides(std::move(segments))),
      links_of_(segments_.size()),
      contacts_of_(segments_.size()) {}

void ControlMesh::tie(In x) {
  mesh_ = GuideMesh(segments_, x, width_);
  if (stiffness_ == 0 && damping_ == 0) mesh_.links.clear();
  if (!strips_act_) mesh_.triangles.clear();
  bonds_.clear();
  for (auto& links : links_of_) links.clear();
  for (const GuideMesh::Link& link : mesh_.links) {
    const double apart = std::sqrt(link.apart * link.apart + soft * soft);
    bonds_.push_back({{link.first, link.second}, {1, -1}, 2, apart, link.carried});
    list(bonds_.size() - 1, links_of_);
  }
  recall({});
}

/// Adds a bond to the lists of its strands; ends of one strand follow each other.
void ControlMesh::list(std::size_t bond,
                       std::vector<std::vector<int>>& of_strands) const {
  int last = -1;
  for (int e = 0; e < bonds_[bond].ends; ++e) {
    const auto point =
        static_cast<std::size_t>(bonds_[bond].point[static_cast<std::size_t>(e)]);
    const int strand = mesh_.strand[point];
    if (strand == std::exchange(last, strand)) continue;
    of_strands[static_cast<std::size_t>(strand)].push_back(static_cast<int>(bond));
  }
}

void ControlMesh::update(In x, In v) {
  x_.assign(x.begin(), x.end());
  v_.assign(v.begin(), v.end());
  for (std::size_t i = 0; i < mesh_.links.size(); ++i) {
    if (broken_[i] != 0 || !(longer(mesh_.links[i]) > break_)) continue;
    broken_[i] = 1;
    ++broken_count_;
  }
  find_contacts();
}

/// By how much a link is longer than at rest at the last update, m.
double ControlMesh::longer(const GuideMesh::Link& link) const {
  const Vec d = load3(&x_[3 * static_cast<std::size_t>(link.first)]) -
                load3(&x_[3 * static_cast<std::size_t>(link.second)]);
  return soft_length(d) - std::sqrt(link.apart * link.apart + soft * soft);
}

double ControlMesh::energy() const {
  double sum = 0;
  for (std::size_t i = 0; i < mesh_.links.size(); ++i) {
    if (broken_[i] != 0) continue;
    const double by = longer(mesh_.links[i]);
    sum += stiffness_ * mesh_.links[i].carried / 2 * by * by;
  }
  return sum;
}

std::vector<double> ControlMesh::memory() const {
  std::vector<double> all;
  for (std::size_t i = 0; i < broken_.size(); ++i) {
    if (broken_[i] != 0) all.push_back(static_cast<double>(i));
  }
  return all;
}

void ControlMesh::recall(In memory) {
  broken_.assign(mesh_.links.size(), 0);
  for (const double link : memory) broken_[static_cast<std::size_t>(link)] = 1;
  broken_count_ = memory.size();
}

double ControlMesh::density(const GuideMesh::Triangle& triangle) const {
  const double width = width_of(triangle, x_);
  const double s = std::clamp(2 * width / width_ - 1, 0.0, 1.0);
  const double thinned = width > triangle.width ? triangle.width / width : 1;
  return thinned * (1 - s * s * (3 - 2 * s));
}

/// Of the hair at a point, a unit vector.
Vec ControlMesh::direction(int point) const {
  const auto i = static_cast<std::size_t>(point);
  const std::size_t from = i > 0 && mesh_.strand[i - 1] == mesh_.strand[i] ? i - 1 : i;
  const std::size_t to =
      i + 1 < mesh_.strand.size() && mesh_.strand[i + 1] == mesh_.strand[i] ? i + 1 : i;
  const Vec d = load3(&x_[3 * to]) - load3(&x_[3 * from]);
  const double length = norm(d);
  return length > 0 ? (1 / length) * d : Vec{};
}

void ControlMesh::find_contacts() {
  bonds_.resize(mesh_.links.size());
  for (auto& contacts : contacts_of_) contacts.clear();
  if (mesh_.triangles.empty()) return;
  std::vector<Box> boxes;
  std::vector<double> densities;
  double sides = 0;
  for (const GuideMesh::Triangle& triangle : mesh_.triangles) {
    const auto corner = [&](std::size_t c) {
      return load3(&x_[3 * static_cast<std::size_t>(triangle.corner[c])]);
    };
    Box box{corner(0), corner(0)};
    box.include(corner(1));
    box.include(corner(2));
    box.grow(law_.reach());
    boxes.push_back(box);
    densities.push_back(density(triangle));
    const Vec side = box.most - box.least;
    sides += std::cbrt(side.x * side.y * side.z);
  }
  const double cell = sides / static_cast<double>(boxes.size());
  if (!(std::isfinite(cell) && cell > 0)) return;
  grid_.fill(x_, cell);
  // Of each point the nearest triangle of every strip; strips follow each other.
  std::vector<Near> near;
  for (std::size_t i = 0; i < boxes.size();) {
    near.clear();
    const int strip = mesh_.triangles[i].strip;
    for (; i < boxes.size() && mesh_.triangles[i].strip == strip; ++i) {
      look(i, densities[i], boxes[i], near);
    }
    std::ranges::sort(near, [](const Near& a, const Near& b) {
      return std::tuple(a.point, a.square, a.triangle) <
             std::tuple(b.point, b.square, b.triangle);
    });
    int last = -1;
    for (const Near& one : near) {
      if (one.point == std::exchange(last, one.point)) continue;
      add_contact(one, densities[static_cast<std::size_t>(one.triangle)]);
    }
  }
}

void ControlMesh::look(std::size_t i, double density, const Box& box,
                       std::vector<Near>& near) const {
  if (!(density > 0)) return;
  const GuideMesh::Triangle& triangle = mesh_.triangles[i];
  const auto [a, b] = mesh_.strips[static_cast<std::size_t>(triangle.strip)];
  std::array<Vec, 3> corner;
  for (std::size_t c = 0; c < 3; ++c) {
    corner[c] = load3(&x_[3 * static_cast<std::size_t>(triangle.corner[c])]);
  }
  const Vec across = cross(corner[1] - corner[0], corner[2] - corner[0]);
  const double far = norm(across) * law_.reach();
  grid_.each_in(box, [&, first = a, second = b](int point) {
    const auto at = static_cast<std::size_t>(point);
    if (mesh_.strand[at] == first || mesh_.strand[at] == second) return;
    const Vec x = load3(&x_[3 * at]);
    if (std::abs(dot(across, x - corner[0])) > far) return;  // of the plane
    const std::array<double, 3> w = nearest(corner, x);
    const Vec d = x - w[0] * corner[0] - w[1] * corner[1] - w[2] * corner[2];
    if (!(dot(d, d) < law_.reach() * law_.reach())) return;
    near.push_back({point, static_cast<int>(i), dot(d, d), w});
  });
}

void ControlMesh::add_contact(const Near& near, double density) {
  const GuideMesh::Triangle& triangle =
      mesh_.triangles[static_cast<std::size_t>(near.triangle)];
  Vec along;
  for (std::size_t c = 0; c < 3; ++c) {
    along = along + near.weight[c] * direction(triangle.corner[c]);
  }
  const double length = norm(along);
  const double aligned =
      length > 0 ? std::abs(dot(direction(near.point), along)) / length : 0;
  const double factor = density * std::max(0.0, 1 - aligned) *
                        mesh_.carried[static_cast<std::size_t>(near.point)];
  if (factor == 0) return;
  bonds_.push_back(
      {{near.point, triangle.corner[0], triangle.corner[1], triangle.corner[2]},
       {1, -near.weight[0], -near.weight[1], -near.weight[2]},
       4,
       0,
       factor});
  list(bonds_.size() - 1, contacts_of_);
}

Vec ControlMesh::force(std::size_t i, const Vec& d, const Vec& u) const {
  const Bond& bond = bonds_[i];
  if (!is_link(i)) return bond.factor * law_.force(d, u);
  const double r = soft_length(d);
  const double pull = stiffness_ * (r - bond.apart) + damping_ * dot(d, u) / r;
  return (-bond.factor * pull / r) * d;
}

ControlMesh::Slopes ControlMesh::slopes(std::size_t i, const Vec& d, const Vec& u) const {
  const Bond& bond = bonds_[i];
  Slopes slopes{};
  if (is_link(i)) {
    const double r = soft_length(d), square = r * r;
    const double rate = damping_ * dot(d, u) / square;
    const double radial = stiffness_ * bond.apart / r - 2 * rate;
    add9(-bond.factor *
             ((stiffness_ * (1 - bond.apart / r) + rate) * identity() +
              (radial / square) * outer(d, d) + (damping_ / square) * outer(d, u)),
         slopes.by_gap.data());
    add9((-bond.factor * damping_ / square) * outer(d, d), slopes.by_rate.data());
    return slopes;
  }
  const ContactLaw::Slopes law = law_.slopes(d, u);
  for (std::size_t c = 0; c < 9; ++c) slopes.by_gap[c] = bond.factor * law.by_gap[c];
  for (const std::size_t c : {0, 4, 8}) slopes.by_rate[c] = bond.factor * law.by_velocity;
  return slopes;
}

class ControlMesh::OnStrand final : public Effect {
 public:
  OnStrand(const ControlMesh& all, std::size_t strand) : all_(all), strand_(strand) {}

  std::string_view name() const override { return "control_mesh"; }
  Needs needs() const override {
    return {.position = true, .velocity = true, .derivatives = true};
  }

  void add_load(double, const Points& p, InOut f) const noexcept override {
    each_bond(p, [&](std::size_t bond, const Own& own) {
      const Vec force = all_.force(bond, own.d, own.u);
      each_held(bond, [&](std::size_t point, double weight, double share) {
        double* to = &f[3 * point];
        store3(load3(to) + (weight * share) * force, to);
      });
    });
  }

  void add_derivatives(double, const Points& p, double pos, double vel,
                       InOut blocks) const noexcept override {
    each_bond(p, [&](std::size_t bond, const Own& own) {
      const Slopes slopes = all_.slopes(bond, own.d, own.u);
      each_held(bond, [&](std::size_t point, double weight, double share) {
        double* block = &blocks[9 * point];
        const double all = weight * share * own.share;
        for (std::size_t c = 0; c < 9; ++c) {
          block[c] += all * (pos * slopes.by_gap[c] + vel * slopes.by_rate[c]);
        }
      });
    });
  }

  double potential(double, const Points&) const noexcept override { return 0; }

  double power(double, const Points& p) const noexcept override {
    double sum = 0;
    each_bond(p, [&](std::size_t bond, const Own& own) {
      const Vec force = all_.force(bond, own.d, own.u);
      each_held(bond, [&](std::size_t point, double weight, double share) {
        sum += weight * share * dot(force, load3(&p.v[3 * point]));
      });
    });
    return sum;
  }

 private:
  /// A material point between two of the model's.
  struct Held {
    std::size_t point[2];
    double weight[2];
  };
  struct Own {
    Vec d, u;
    double share = 0;  // of all its ends on this strand
  };

  /// Calls use(bond, own) for every bond that holds on this strand.
  template <class F>
  void each_bond(const Points& p, F use) const noexcept {
    const auto& links = all_.links_of_[strand_];
    const auto& contacts = all_.contacts_of_[strand_];
    if (links.empty() && contacts.empty()) return;
    hold(p);
    for (const int link : links) {
      const auto bond = static_cast<std::size_t>(link);
      if (all_.broken_[bond] == 0) use(bond, see(bond, p));
    }
    for (const int contact : contacts) {
      const auto bond = static_cast<std::size_t>(contact);
      use(bond, see(bond, p));
    }
  }

  bool mine(int point) const {
    return all_.mesh_.strand[static_cast<std::size_t>(point)] ==
           static_cast<int>(strand_);
  }
  const Held& held(int point) const {
    return held_[static_cast<std::size_t>(point - all_.mesh_.first[strand_])];
  }

  /// d and u of a bond, others where they were.
  Own see(std::size_t bond, const Points& p) const {
    const Bond& b = all_.bonds_[bond];
    Own own;
    for (std::size_t e = 0; e < static_cast<std::size_t>(b.ends); ++e) {
      Vec x, v;
      if (mine(b.point[e])) {
        const Held& at = held(b.point[e]);
        for (std::size_t k = 0; k < 2; ++k) {
          x = x + at.weight[k] * load3(&p.x[3 * at.point[k]]);
          v = v + at.weight[k] * load3(&p.v[3 * at.point[k]]);
        }
        own.share += b.share[e];
      } else {
        const std::size_t at = 3 * static_cast<std::size_t>(b.point[e]);
        x = load3(&all_.x_[at]);
        v = load3(&all_.v_[at]);
      }
      own.d = own.d + b.share[e] * x;
      own.u = own.u + b.share[e] * v;
    }
    return own;
  }

  /// Calls use(point of the model, weight, share) for every end on this strand.
  template <class F>
  void each_held(std::size_t bond, F use) const {
    const Bond& b = all_.bonds_[bond];
    for (std::size_t e = 0; e < static_cast<std::size_t>(b.ends); ++e) {
      if (!mine(b.point[e])) continue;
      const Held& at = held(b.point[e]);
      for (std::size_t k = 0; k < 2; ++k) {
        if (at.weight[k] != 0) use(at.point[k], at.weight[k], b.share[e]);
      }
    }
  }

  /// Sets held_ for points that carry these lengths; models keep theirs.
  void hold(const Points& p) const {
    if (std::ranges::equal(p.length, held_for_)) return;
    held_for_.assign(p.length.begin(), p.length.end());
    const std::vector<double>& segments = all_.segments_[strand_];
    std::vector<std::size_t> carriers;
    for (std::size_t i = 0; i < p.length.size(); ++i) {
      if (p.length[i] > 0) carriers.push_back(i);
    }
    held_.clear();
    if (carriers.size() == segments.size() + 1) {  // nodes
      for (const std::size_t i : carriers) held_.push_back({{i, i}, {1, 0}});
      return;
    }
    // Arcs: of material points, and of the middles of what the model's points carry.
    std::size_t k = 0;
    double arc = 0, before = 0, middle = p.length[carriers[0]] / 2, last = middle;
    for (std::size_t i = 0; i <= segments.size(); ++i) {
      if (i > 0) arc += segments[i - 1];
      while (middle < arc && k + 1 < carriers.size()) {
        before += p.length[carriers[k]];
        last = middle;
        ++k;
        middle = before + p.length[carriers[k]] / 2;
      }
      if (k == 0 || middle <= arc) {
        held_.push_back({{carriers[k], carriers[k]}, {1, 0}});
        continue;
      }
      const double share = (arc - last) / (middle - last);
      held_.push_back({{carriers[k - 1], carriers[k]}, {1 - share, share}});
    }
  }

  const ControlMesh& all_;
  std::size_t strand_;
  mutable std::vector<Held> held_;  // of each material point
  mutable std::vector<double> held_for_;
};

std::unique_ptr<const Effect> ControlMesh::effect(std::size_t strand) const {
  return std::make_unique<OnStrand>(*this, strand);
}

}  // namespace tress::models
