#include "models/maximal/spring_elasticity.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <type_traits>

#include "models/maximal/spring_chain.h"

namespace tress::models {
namespace {

template <class Strain>
constexpr bool at_wall = requires(Strain s, Frame f) {
  s.place(f);
};
/// Tests for strains that are lengths. Only lengths take stresses from another state.
/// Second derivatives of angles grow without bound where a strand is straight, and so
/// does their product with a stress of another state.
template <class Strain>
constexpr bool is_length = false;
template <int n>
constexpr bool is_length<Chord<n>> = true;
/// Angles whose binormal turns over where the joint is straight.
template <class Strain>
constexpr bool is_bend =
    std::is_same_v<Strain, Hinge> || std::is_same_v<Strain, BendAngle>;
/// Angles that change by a half or a whole turn in one point.
template <class Strain>
constexpr bool is_dihedral =
    std::is_same_v<Strain, Dihedral> || std::is_same_v<Strain, WallDihedral>;
template <class Strain>
constexpr bool has_metric = requires(const Strain s, const Vec* e,
                                     EdgeMatrix<Strain::edges>& m) {
  s.metric(e, m);
};

/// A spring in its current state.
template <class Strain>
struct Stretched {
  static constexpr int edges = Strain::edges;

  Stretched(const Spring<Strain>& spring, const Placement& p)
      : strain(spring.strain), stiffness(spring.stiffness), rest(spring.rest) {
    for (int k = 0; k < edges; ++k) {
      const std::size_t node = 3 * (spring.first + static_cast<std::size_t>(k));
      e[k] = load3(&p.z[node + 3]) - load3(&p.z[node]);
      rate[k] = load3(&p.rate[node + 3]) - load3(&p.rate[node]);
    }
    if constexpr (at_wall<Strain>) {
      strain.place(p.root.frame);
      for (int k = 0; k < edges; ++k) rate[k] = rate[k] - cross(p.root.omega, e[k]);
    }
    value = strain.gradient(e, slope);
    for (int k = 0; k < edges; ++k) speed += dot(slope[k], rate[k]);
    stress = stiffness * (value - rest) + spring.friction * speed;
  }

  /// In the tangent's terms of second order: elastic stress from there, friction from
  /// here.
  double stress_from(const Spring<Strain>& spring, const StressOrigin& origin) const {
    const Stretched from(spring, {origin.root, origin.z, origin.z});
    double change = 0;
    for (int k = 0; k < edges; ++k) change += dot(from.slope[k], e[k] - from.e[k]);
    return origin.stress(stiffness, from.value - rest, change) + spring.friction * speed;
  }

  Strain strain;
  double stiffness, rest;
  Vec e[edges], slope[edges];
  Vec rate[edges];  // of the edges; at the wall as seen from the clamp
  double value = 0, speed = 0, stress = 0;
};

/// Calls `act` with every spring of every kind and its number.
template <class All, class Act>
void for_each(All& springs, Act act) {
  std::size_t number = 0;
  const auto of_kind = [&](auto& kind) {
    for (auto& spring : kind) act(spring, number++);
  };
  std::apply([&](auto&... kinds) { (of_kind(kinds), ...); }, springs);
}

template <class Strain>
void add_exact(const Spring<Strain>& spring, const Stretched<Strain>& now,
               const Placement& p, double pos, EdgeMatrix<Strain::edges>& s) {
  constexpr int edges = Strain::edges, size = 3 * edges;
  EdgeMatrix<edges> h;
  now.strain.hessian(now.e, h);
  Vec slope_of_speed[edges];
  for (int i = 0; i < edges; ++i) {
    double sum[3] = {};
    for (int k = 0; k < 3; ++k) {
      for (int j = 0; j < edges; ++j) {
        const double* row = &h.m[3 * i + k][3 * j];
        sum[k] +=
            row[0] * now.rate[j].x + row[1] * now.rate[j].y + row[2] * now.rate[j].z;
      }
    }
    slope_of_speed[i] = {sum[0], sum[1], sum[2]};
    if constexpr (at_wall<Strain>) {
      slope_of_speed[i] = slope_of_speed[i] + cross(p.root.omega, now.slope[i]);
    }
  }
  for (int i = 0; i < edges; ++i) {
    for (int j = 0; j < edges; ++j) {
      s.add_outer(i, j, pos * spring.friction, now.slope[i], slope_of_speed[j]);
    }
  }
  double stress = now.stress;
  if constexpr (is_length<Strain>) {
    if (p.origin != nullptr) stress = now.stress_from(spring, *p.origin);
  }
  for (int i = 0; i < size; ++i) {
    for (int j = 0; j < size; ++j) s.m[i][j] += pos * stress * h.m[i][j];
  }
}

template <class Strain>
void add_filtered(const Stretched<Strain>& now, double pos,
                  EdgeMatrix<Strain::edges>& s) {
  if constexpr (has_metric<Strain>) {
    const double across = pos * now.stiffness * std::max(0.0, 1 - now.rest / now.value);
    EdgeMatrix<Strain::edges> metric;
    now.strain.metric(now.e, metric);
    for (int i = 0; i < metric.size; ++i) {
      for (int j = 0; j < metric.size; ++j) s.m[i][j] += across * metric.m[i][j];
    }
    s.add_product(-across, now.slope, now.slope);
  }
}

/// Converts a matrix over edges to one over the nodes at their ends.
template <int edges>
void to_nodes(const EdgeMatrix<edges>& of_edges, EdgeMatrix<edges + 1>& of_nodes) {
  for (int i = 0; i < of_edges.size; ++i) {
    for (int j = 0; j < of_edges.size; ++j) {
      const double x = of_edges.m[i][j];
      of_nodes.m[i][j] += x;
      of_nodes.m[i + 3][j] -= x;
      of_nodes.m[i][j + 3] -= x;
      of_nodes.m[i + 3][j + 3] += x;
    }
  }
}

/// Calls `act` with the spring of this number.
template <class All, class Act>
void at_number(All& springs, std::size_t number, Act act) {
  const auto of_kind = [&](auto& kind) {
    const bool here = number < kind.size();
    if (here) {
      act(kind[number]);
    } else {
      number -= kind.size();
    }
    return here;
  };
  std::apply([&](auto&... kinds) { (of_kind(kinds) || ...); }, springs);
}

}  // namespace

SpringElasticity::SpringElasticity(Springs springs, SpringJacobian jacobian)
    : springs_(std::move(springs)),
      jacobian_(jacobian),
      chain_(spring_chain(springs_, jacobian)) {
  std::vector<std::size_t> middle;  // in half edges
  for_each(springs_, [&]<class Strain>(const Spring<Strain>& spring, std::size_t number) {
    along_.push_back(number);
    middle.push_back(2 * spring.first + Strain::edges);
  });
  std::ranges::stable_sort(along_, {}, [&](std::size_t k) { return middle[k]; });
}

SpringElasticity::~SpringElasticity() = default;

StrandElimination* SpringElasticity::elimination() { return chain_.get(); }

std::vector<std::vector<int>> SpringElasticity::groups() const {
  std::vector<std::vector<int>> all;
  for_each(springs_, [&]<class Strain>(const Spring<Strain>& spring, std::size_t) {
    std::vector<int> group(3 * (Strain::edges + 1));
    std::iota(group.begin(), group.end(), static_cast<int>(3 * spring.first));
    all.push_back(std::move(group));
  });
  return all;
}

void SpringElasticity::add_force(const Placement& p, InOut f) noexcept {
  if (chain_ != nullptr) return chain_->add_force(p, f);
  for_each(springs_, [&]<class Strain>(const Spring<Strain>& spring, std::size_t) {
    const Stretched<Strain> now(spring, p);
    for (int k = 0; k < Strain::edges; ++k) {
      double* from = &f[3 * (spring.first + static_cast<std::size_t>(k))];
      const Vec force = now.stress * now.slope[k];
      store3(load3(from) - force, from);
      store3(load3(from + 3) + force, from + 3);
    }
  });
}

void SpringElasticity::add_tangent(const Placement& p, double pos, double vel,
                                   GroupSum& s) noexcept {
  for_each(springs_, [&]<class Strain>(const Spring<Strain>& spring, std::size_t number) {
    const Stretched<Strain> now(spring, p);
    EdgeMatrix<Strain::edges> of_edges;
    of_edges.add_product(pos * spring.stiffness + vel * spring.friction, now.slope,
                         now.slope);
    if (jacobian_ == SpringJacobian::exact) {
      add_exact(spring, now, p, pos, of_edges);
    } else {
      add_filtered(now, pos, of_edges);
    }
    EdgeMatrix<Strain::edges + 1> of_nodes;
    to_nodes(of_edges, of_nodes);
    s.add(number, &of_nodes.m[0][0]);
  });
}

double SpringElasticity::energy(const Placement& p) noexcept {
  double sum = 0;
  for_each(springs_, [&]<class Strain>(const Spring<Strain>& spring, std::size_t) {
    const double apart = Stretched<Strain>(spring, p).value - spring.rest;
    sum += spring.stiffness / 2 * apart * apart;
  });
  return sum;
}

/// A turning clamp adds to the rate of s: s' minus the contribution of the nodes.
double SpringElasticity::power(const Placement& p) noexcept {
  double sum = 0;
  for_each(springs_, [&]<class Strain>(const Spring<Strain>& spring, std::size_t) {
    const Stretched<Strain> now(spring, p);
    sum -= spring.friction * now.speed * now.speed;
    if constexpr (at_wall<Strain>) {
      for (int k = 0; k < Strain::edges; ++k) {
        sum -= now.stress * dot(now.slope[k], cross(p.root.omega, now.e[k]));
      }
    }
  });
  return sum;
}

bool SpringElasticity::rebase(const RootPose& root, InOut z, InOut rate) {
  // Half of what the angle changes by where an edge turns over.
  constexpr double turned = std::numbers::pi / 2;
  const bool known = !angles_.empty();
  std::size_t seen = 0;
  for_each(springs_, [&]<class Strain>(const Spring<Strain>& spring, std::size_t) {
    if constexpr (is_bend<Strain> || is_dihedral<Strain>) {
      if (is_bend<Strain> && spring.rest == 0) return;  // smooth
      Angle now{};
      if constexpr (is_bend<Strain>) {
        const Vec x[] = {load3(&z[3 * spring.first]), load3(&z[3 * spring.first + 3]),
                         load3(&z[3 * spring.first + 6])};
        now.binormal = cross(x[1] - x[0], x[2] - x[1]);
      } else {
        now.value = Stretched<Strain>(spring, {root, z, rate}).value;
      }
      if (!known) {
        angles_.push_back(now);
        return;
      }
      Angle& last = angles_[seen++];
      const bool jumped = is_bend<Strain> ? dot(now.binormal, last.binormal) < 0
                                          : std::abs(now.value - last.value) > turned;
      last = now;
      if (jumped && jumps_.count++ == 0) jumps_.joint = spring.first + 1;
    }
  });
  return false;
}

std::vector<ComplianceForm::Block> SpringElasticity::strain_blocks() const {
  const std::vector<std::vector<int>> coordinates = groups();
  std::vector<ComplianceForm::Block> blocks;
  for (const std::size_t number : along_) {
    at_number(springs_, number, [&](const auto& spring) {
      blocks.push_back(
          {coordinates[number], 1, {1 / spring.stiffness}, {spring.friction}});
    });
  }
  return blocks;
}

void SpringElasticity::strain(std::size_t k, const RootPose& root, const double* z,
                              ComplianceForm::Value& value) noexcept {
  at_number(springs_, along_[k], [&]<class Strain>(const Spring<Strain>& spring) {
    constexpr int edges = Strain::edges;
    Vec e[edges], slope[edges];
    for (int i = 0; i < edges; ++i) e[i] = load3(z + 3 * i + 3) - load3(z + 3 * i);
    Strain now = spring.strain;
    if constexpr (at_wall<Strain>) now.place(root.frame);
    value.c[0] = now.gradient(e, slope) - spring.rest;
    value.drift[0] = 0;
    double* gradient = value.gradient[0];
    std::fill_n(gradient, 3 * (edges + 1), 0.0);
    for (int i = 0; i < edges; ++i) {
      if constexpr (at_wall<Strain>) {
        value.drift[0] -= dot(slope[i], cross(root.omega, e[i]));
      }
      store3(load3(gradient + 3 * i) - slope[i], gradient + 3 * i);
      store3(slope[i], gradient + 3 * i + 3);
    }
  });
}

void SpringElasticity::add_second(std::size_t k, const RootPose& root, const double* z,
                                  In stress, ComplianceForm::Second& h) noexcept {
  at_number(springs_, along_[k], [&]<class Strain>(const Spring<Strain>& spring) {
    constexpr int edges = Strain::edges;
    Vec e[edges];
    for (int i = 0; i < edges; ++i) e[i] = load3(z + 3 * i + 3) - load3(z + 3 * i);
    Strain now = spring.strain;
    if constexpr (at_wall<Strain>) now.place(root.frame);
    EdgeMatrix<edges> of_edges;
    EdgeMatrix<edges + 1> of_nodes;
    now.hessian(e, of_edges);
    to_nodes(of_edges, of_nodes);
    for (int i = 0; i < of_nodes.size; ++i) {
      for (int j = 0; j < of_nodes.size; ++j) h[i][j] += stress[0] * of_nodes.m[i][j];
    }
  });
}

}  // namespace tress::models
