#include "models/maximal/spring_chain.h"

#include "math/instructions.h"
#include "models/maximal/kernel/spring_forces.h"

namespace tress::models {
namespace {

/// Of an edge, and of the joint before it.
struct Edge {
  double stretch, length;  // N/m, m
  SpringStiffness<double> joint;
  double rest, about_e2;  // the last of the wall only
};

template <bool exact>
class Chain final : public SpringChain {
 public:
  using Elimination = std::conditional_t<exact, SpringExactElimination<double>,
                                         SpringStiffElimination<double>>;
  using Forces = SpringForces<double, exact>;
  using Placed = typename Elimination::Placed;

  explicit Chain(std::vector<Edge> edges)
      : edges_(std::move(edges)),
        placed_(edges_.size()),
        now_(edges_.size()),
        factors_(edges_.size()),
        last_(3 * (edges_.size() + 1)) {}

  void add_force(const Placement& p, InOut f) noexcept override {
    const bool known = last_.is(p);
    if (!known) place<false>(p, {}, now_.data());
    const Placed* placed = known ? placed_.data() : now_.data();
    Vec before;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const Vec force = placed[i].frame * placed[i].own;
      store3(load3(&f[3 * i]) + (before - force), &f[3 * i]);
      before = force;
    }
    store3(load3(&f[3 * edges_.size()]) + before, &f[3 * edges_.size()]);
  }

  bool factor(const Placement& p, Weights w, const Others& others) noexcept override {
    place<true>(p, w, placed_.data());
    last_.take(p);
    return eliminate(p, w, others);
  }

  TRESS_FLATTEN void solve(In b, Out x) noexcept override {
    typename Elimination::Right right;
    for (std::size_t i = edges_.size(); i-- > 0;) {
      Elimination::reduce(placed_[i], i == 0, factors_[i], load3(&b[3 * i]), {}, right);
    }
    Vec node, change;
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      change = Elimination::change(placed_[i], factors_[i], i == 0, node, change);
      node = node + placed_[i].frame * change;
      store3(node, &x[3 * i]);
    }
  }

 private:
  template <bool with_tangent>
  TRESS_FLATTEN void place(const Placement& p, Weights w, Placed* placed) noexcept {
    for (std::size_t i = 0; i < edges_.size(); ++i) {
      const Edge& data = edges_[i];
      const auto along = [i](In x) { return load3(&x[3 * i + 3]) - load3(&x[3 * i]); };
      const Vec edge = along(p.z);
      Forces::stretch(data.stretch, data.length, w, edge, along(p.rate), placed[i]);
      if (i == 0) {
        Forces::template wall<with_tangent>(data.joint, data.rest, data.about_e2,
                                            p.root.frame, p.root.omega, w, edge,
                                            placed[0]);
      } else {
        Forces::template hinge<with_tangent>(data.joint, data.rest, w, placed[i - 1],
                                             placed[i]);
      }
    }
  }

  TRESS_FLATTEN bool eliminate(const Placement& p, Weights w,
                               const Others& others) noexcept {
    typename Elimination::Beyond beyond;
    StrandPivots pivots;
    for (std::size_t i = edges_.size(); i-- > 0;) {
      beyond.add_inertia(w.acc * others.mass[i + 1]);
      if (!others.blocks.empty() && !add_block(&others.blocks[9 * (i + 1)], beyond)) {
        return false;
      }
      if constexpr (exact) {
        Elimination::eliminate(placed_[i], i == 0, w.pos, w.pos * edges_[i].stretch,
                               tension(p, i), beyond, factors_[i], pivots);
      } else {
        Elimination::eliminate(placed_[i], i == 0, beyond, factors_[i], pivots);
      }
    }
    return pivots.kept();
  }

  /// In the tangent's terms of second order (StressForm).
  double tension(const Placement& p, std::size_t i) const noexcept {
    if (p.origin == nullptr) return placed_[i].own.x;
    return length_stress(edges_[i].stretch, edges_[i].length, p, i);
  }

  std::vector<Edge> edges_;
  std::vector<Placed> placed_, now_;  // of factor(), and of a force elsewhere
  std::vector<typename Elimination::Factor> factors_;
  LastPlacement last_;  // of placed_
};

}  // namespace

std::unique_ptr<SpringChain> spring_chain(const Springs& springs,
                                          SpringJacobian jacobian) {
  const auto& lengths = std::get<std::vector<Spring<Chord<1>>>>(springs);
  const auto& hinges = std::get<std::vector<Spring<Hinge>>>(springs);
  const auto& wall = std::get<std::vector<Spring<WallBend>>>(springs);
  const std::size_t all =
      std::apply([](const auto&... kind) { return (kind.size() + ...); }, springs);
  if (wall.size() != 2 || lengths.size() != hinges.size() + 1 ||
      all != 2 * lengths.size() + 1) {
    return nullptr;
  }
  std::vector<Edge> edges;
  for (std::size_t i = 0; i < lengths.size(); ++i) {
    const auto joint = [](const auto& spring) {
      return SpringStiffness<double>{spring.stiffness, spring.friction};
    };
    edges.push_back({lengths[i].stiffness, lengths[i].rest,
                     i == 0 ? joint(wall[0]) : joint(hinges[i - 1]),
                     i == 0 ? wall[0].rest : hinges[i - 1].rest,
                     i == 0 ? wall[1].rest : 0});
  }
  if (jacobian == SpringJacobian::exact)
    return std::make_unique<Chain<true>>(std::move(edges));
  return std::make_unique<Chain<false>>(std::move(edges));
}

}  // namespace tress::models
