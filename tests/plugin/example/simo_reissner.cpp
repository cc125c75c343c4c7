#include <cmath>

#include "example.h"
#include "models/maximal/maximal_system.h"
#include "models/maximal/nodal_strand.h"
#include "models/maximal/to_nodes.h"
#include "simo_reissner_element.h"

namespace example {
namespace {

using namespace tress;
using namespace tress::models;

/// Internal forces over z = (x_0, ..., x_n, q_first, ..., q_n); `clamped`: the first node
/// is the root, whose quaternion is none of them.
class Elements final : public Elasticity, private NaturalStrains {
 public:
  Elements(std::vector<Element> elements, bool clamped)
      : elements_(std::move(elements)), clamped_(clamped) {}

  std::vector<std::vector<int>> groups() const override {
    std::vector<std::vector<int>> all(elements_.size());
    const auto append = [](std::vector<int>& group, std::size_t first, int count) {
      for (int k = 0; k < count; ++k) group.push_back(static_cast<int>(first) + k);
    };
    for (std::size_t i = 0; i < all.size(); ++i) {
      append(all[i], 3 * i, 6);
      if (!at_clamp(i)) append(all[i], at(i), 4);
      append(all[i], at(i + 1), 4);
    }
    return all;
  }

  void add_force(const Placement& p, InOut f) noexcept override {
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      const Local now = local(p, i);
      double force[Element::coordinates] = {};
      Strained(elements_[i], now.x, now.rate).add_force(force);
      for (std::size_t k = 0; k < 3; ++k) {
        f[3 * i + k] -= force[k];
        f[3 * i + 3 + k] += force[k];
      }
      for (std::size_t k = 0; k < 4; ++k) {
        if (!at_clamp(i)) f[at(i) + k] += force[3 + k];
        f[at(i + 1) + k] += force[7 + k];
      }
    }
  }

  void add_tangent(const Placement& p, double pos, double vel,
                   GroupSum& s) noexcept override {
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      const Local now = local(p, i);
      double h[11][11], m[14][14];
      Strained(elements_[i], now.x, now.rate).tangent(pos, vel, h);
      if (at_clamp(i)) {
        double free[7][7], of_free[10][10];
        const auto kept = [](int k) { return k < 3 ? k : k + 4; };
        for (int k = 0; k < 7; ++k) {
          for (int l = 0; l < 7; ++l) free[k][l] = h[kept(k)][kept(l)];
        }
        to_nodes<4>(free, of_free);
        s.add(i, &of_free[0][0]);
      } else {
        to_nodes<8>(h, m);
        s.add(i, &m[0][0]);
      }
    }
  }

  double energy(const Placement& p) noexcept override {
    double sum = 0;
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      sum += strain_energy(elements_[i], local(p, i).x);
    }
    return sum;
  }

  double power(const Placement& p) noexcept override {
    double sum = 0;
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      const Local now = local(p, i);
      const Strained strained(elements_[i], now.x, now.rate);
      sum += strained.friction_power();
      if (!at_clamp(i)) continue;
      for (int k = 0; k < Element::strains; ++k) {  // of the clamp that turns
        for (int l = 3; l < 7; ++l) {
          sum += strained.stress[k] * strained.gradient[k][l] * now.rate[l];
        }
      }
    }
    return sum;
  }

  Vec spin(const Placement& p, In inertia) noexcept override {
    Vec sum;
    for (std::size_t node = clamped_ ? 1 : 0; node <= elements_.size(); ++node) {
      const Quaternion q = load_quaternion(&p.z[at(node)]);
      const Quaternion rate = load_quaternion(&p.rate[at(node)]);
      sum = sum + inertia[at(node) - at(clamped_ ? 1 : 0)] / 2 *
                      (rate * Quaternion{q.w, -1.0 * q.v}).v;
    }
    return sum;
  }

  std::optional<Frame> end_frame(const Placement& p) noexcept override {
    const Quaternion q = load_quaternion(&p.z[at(elements_.size())]);
    return axes((1 / std::sqrt(dot(q, q))) * q);
  }

  NaturalStrains* natural_strains() override { return this; }

 private:
  struct Local {
    double x[Element::coordinates], rate[Element::coordinates];
  };

  std::vector<double> natural() const override {
    std::vector<double> all;
    for (const Element& e : elements_) {
      all.insert(all.end(), e.turn.rest, e.turn.rest + 3);
    }
    return all;
  }
  void set_natural(In values) override {
    for (std::size_t i = 0; i < elements_.size(); ++i) {
      std::copy_n(&values[3 * i], 3, elements_[i].turn.rest);
    }
  }
  std::vector<double> natural_stiffness() const override {
    std::vector<double> all;
    for (const Element& e : elements_) {
      all.insert(all.end(), e.stiffness + 3, e.stiffness + 6);
    }
    return all;
  }

  bool at_clamp(std::size_t element) const { return clamped_ && element == 0; }
  /// Index in z of a node's quaternion.
  std::size_t at(std::size_t node) const {
    return 3 * (elements_.size() + 1) + 4 * (node - (clamped_ ? 1 : 0));
  }
  Local local(const Placement& p, std::size_t i) const noexcept {
    Local local;
    const auto fill = [&](In z, double* x) {
      store3(load3(&z[3 * i + 3]) - load3(&z[3 * i]), x);
      if (!at_clamp(i)) std::copy_n(&z[at(i)], 4, x + 3);
      std::copy_n(&z[at(i + 1)], 4, x + 7);
    };
    fill(p.z, local.x);
    fill(p.rate, local.rate);
    if (at_clamp(i)) {
      const Quaternion wall =
          nearer(load_quaternion(local.x + 7), quaternion_of(p.root.frame));
      store_quaternion(wall, local.x + 3);
      store_quaternion(rate_of(wall, p.root.omega), local.rate + 3);
    }
    return local;
  }

  std::vector<Element> elements_;
  bool clamped_;
};

struct RodOptions {
  double shear_factor = 0.9;  // k [Cowper 1966, solid circle]
  double norm = 100;          // nu
  LinearKind solver = LinearKind::automatic;
};

Element element(const Strand& strand, const Segment& segment, const Vec& rest,
                const RodOptions& options) {
  const Material material = strand.material_of(segment);
  const double l = segment.length, area = segment.section.area();
  const RodJoint joint = rod_joint(strand, &segment, segment, rest);
  const double shear = l * options.shear_factor * material.shear_modulus * area;
  const double norm = options.norm / 2 * std::max(joint.stiffness.y, joint.stiffness.z);
  const Vec turn = joint.stiffness, slow = joint.friction;
  return {.middle = {l, {}, {}},
          .turn = QuaternionJoint(joint),
          .stiffness = {l * material.youngs_modulus * area, shear, shear, turn.x, turn.y,
                        turn.z, norm, norm},
          .friction = {0, 0, 0, slow.x, slow.y, slow.z, 0, 0}};
}

std::vector<Quaternion> quaternions(const Strand& strand, ShapeOf shape,
                                    const StrandPlace& root) {
  std::vector<Quaternion> all;
  for (const StrandPlace& place : joints(strand, shape, root)) {
    const Quaternion q = quaternion_of(place.frame);
    all.push_back(all.empty() ? q : nearer(all.back(), q));
  }
  return all;
}

/// Throws InputError unless the strand is a chain.
std::unique_ptr<System> simo_reissner(const Strand& strand, const RodOptions& options,
                                      Effects effects) {
  const std::size_t n = strand.segments.size();
  const bool clamped = !strand.free_root.has_value();
  NodalStrand nodal(strand, "simo_reissner", 4 * (clamped ? n : n + 1));
  MaximalStrand& parts = nodal.parts;
  const StrandPlace& root = nodal.root.place;
  const auto natural = quaternions(strand, ShapeOf::natural, root);
  const auto initial = quaternions(strand, ShapeOf::initial, root);
  std::vector<Element> elements;
  std::size_t at = 3 * (n + 1);
  for (std::size_t node = 0; node <= n; ++node) {
    if (node > 0) {  // no element is stretched or sheared at first
      const Segment& segment = strand.segments[node - 1];
      elements.push_back(element(
          strand, segment, turn_between(natural[node - 1], natural[node]), options));
      Quaternion middle{initial[node - 1].w + initial[node].w,
                        initial[node - 1].v + initial[node].v};
      const Vec x = load3(&parts.z[3 * node - 3]) +
                    segment.length / dot(middle, middle) * first_axis(middle);
      store3(x, &parts.z[3 * node]);
      store3(nodal.root.velocity_of(x), &parts.rate[3 * node]);
    }
    if (node == 0 && clamped) continue;
    store_quaternion(initial[node], &parts.z[at]);
    store_quaternion(rate_of(initial[node], nodal.root.spin), &parts.rate[at]);
    for (const std::size_t k : {node, node + 1}) {  // half of the segments beside it
      if (k == 0 || k > n) continue;
      const Segment& segment = strand.segments[k - 1];
      for (std::size_t l = 0; l < 4; ++l) {
        parts.inertia[at - 3 * (n + 1) + l] += 2 * strand.material_of(segment).density *
                                               segment.section.polar() * segment.length;
      }
    }
    at += 4;
  }
  parts.to_tip = Frame{};  // the last node's frame
  parts.elasticity = std::make_unique<Elements>(std::move(elements), clamped);
  parts.effects = std::move(effects);
  parts.solver = options.solver;
  return std::make_unique<MaximalSystem>(std::move(parts));
}

constexpr Parameter rod_parameters[] = {
    {.name = "shear_factor",
     .help = "stiffness against shear over GA",
     .number = RodOptions{}.shear_factor,
     .min = 1e-6},
    {.name = "norm",
     .help = "stiffness of the quaternions' norms over EI/l^2",
     .number = RodOptions{}.norm,
     .min = 1},
    maximal_solver_parameter};

std::unique_ptr<System> make_rod(const Strand& strand, const Parameters& p,
                                 Effects effects) {
  return simo_reissner(strand,
                       {.shear_factor = p.number("shear_factor"),
                        .norm = p.number("norm"),
                        .solver = maximal_solver(p)},
                       std::move(effects));
}

}  // namespace

ModelEntry simo_reissner_entry() {
  return {.id = "simo_reissner",
          .summary = "shearable rod of two-node elements; 3n positions and n quaternions",
          .source = "Simo & Vu-Quoc 1986",
          .parameters = rod_parameters,
          .make = on_described_strand<make_rod>,
          .on_strand = make_rod};
}

}  // namespace example
