// Joined strands against whole strands, a tree and two rigid bars.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <vector>

#include "models/reduced/super_helix.h"
#include "models/strand/rod_joint.h"
#include "tests/models/joints/joined_strands.h"
#include "tests/models/supports/admitted_motions.h"

namespace tress::test_joined_motion {

using namespace testing_support;
using models::Joint;
using models::JointKind;

/// The chain of segments from `first` on, as a strand whose root begins at `root`.
Strand chain_from(const Strand& tree, std::size_t first, std::size_t count,
                  const StrandPlace& root) {
  Strand chain = tree;
  chain.segments.assign(tree.segments.begin() + std::ptrdiff_t(first),
                        tree.segments.begin() + std::ptrdiff_t(first + count));
  for (std::size_t i = 0; i < count; ++i) {
    chain.segments[i].parent = int(i) - 1;
    if (i == 0) chain.segments[i].mount = Frame{};
  }
  chain.root.position = root.x;
  chain.root.frame = root.frame;
  return chain;
}

/// Largest difference of entries from `first` on, over the largest entry.
double apart(In a, In b) {
  double most = 0, size = 0;
  for (std::size_t i = 0; i < b.size(); ++i) {
    most = std::max(most, std::abs(a[i] - b[i]));
    size = std::max(size, std::abs(b[i]));
  }
  return most / size;
}

/// A strand of ten elements and two welded ones of five have the same equations. A strand
/// that is released straight, with a natural curvature, has accelerations of the order of
/// 1e5 g, of which rounding of the two solutions leaves 1e-9. `der` measures the angle of
/// its welded edges in another way: they agree in straight strands.
TEST(Welds, OfTwoHalvesAreTheWholeStrand) {
  for (const char* model : {"super_helix", "super_clothoid", "der"}) {
    SCOPED_TRACE(model);
    const bool edges = std::string(model) == "der";
    const ModelSettings settings{{"elements", "10"},
                                 {"natural_curvature_per_m", edges ? "0" : "10"},
                                 {"initial", "straight"}};
    const Strand whole = strand_at(model, settings);
    const Strand first = chain_from(whole, 0, 5, {whole.root.position, whole.root.frame});
    const Strand second = freed(chain_from(whole, 5, 5, tip_of(first)), tip_of(first));
    Joint weld = joint_of(JointKind::weld, {0, 5}, {1, 0});
    weld.half_a = weld.half_b = rod_joint(whole, nullptr, whole.segments.front(), {});
    std::vector<std::unique_ptr<SupportedSystem>> strands;
    strands.push_back(joinable(model, settings, first));
    strands.push_back(joinable(model, settings, second));
    const auto both = joined(std::move(strands), {weld});
    const auto alone = joinable(model, settings, whole);
    const std::vector<double> a = accelerations_at_start(*both),
                              b = accelerations_at_start(alone->strand());
    const double upper = apart(In(a).first(18), In(b).first(18)),
                 lower = apart(In(a).subspan(18), In(b).subspan(15));
    std::printf("%s: %.1e, %.1e apart\n", model, upper, lower);
    EXPECT_LE(std::max(upper, lower), 1e-9);
  }
}

/// The built-in tree `algae`, a stalk with three stems, and four welded strands have the
/// same equations. Accelerations differ by rounding.
TEST(Welds, OfBranchesAreTheBuiltInTree) {
  const ModelSettings settings{{"tree", "algae"}};
  const Parameters parameters(find_model("super_helix_tree").parameters, "tree");
  Parameters chosen = parameters;
  for (const auto& [key, value] : settings) chosen.set(key, value);
  const Strand tree = models::described_tree(chosen);
  ASSERT_EQ(tree.segments.size(), 10U);
  const auto options = parameters_of("super_helix", {});
  const auto effects = models::strand_effects(chosen);
  const auto system = [&](const Strand& strand) {
    return std::make_unique<SupportedSystem>(
        find_model("super_helix").on_strand(strand, options, effects),
        std::vector<Support>{});
  };
  const Strand stalk = chain_from(tree, 0, 1, {tree.root.position, tree.root.frame});
  const StrandPlace fork = tip_of(stalk);
  std::vector<std::unique_ptr<SupportedSystem>> strands;
  strands.push_back(system(stalk));
  std::vector<Joint> welds;
  for (std::size_t k = 0; k < 3; ++k) {
    const std::size_t first = 1 + 3 * k;
    ASSERT_EQ(tree.segments[first].parent, 0);
    StrandPlace root = fork;
    root.frame = fork.frame * tree.segments[first].mount;
    strands.push_back(system(freed(chain_from(tree, first, 3, root), root)));
    welds.push_back(joint_of(JointKind::weld, {0, 1}, {k + 1, 0}));
  }
  const auto welded = joined(std::move(strands), welds);
  const auto whole = make_model("super_helix_tree", settings);
  const std::vector<double> a = accelerations_at_start(*welded),
                            b = accelerations_at_start(*whole);
  // Points of the tree: the root, then the tips of the segments.
  double most = apart(In(a).first(6), In(b).first(6));
  for (std::size_t k = 0; k < 3; ++k) {
    most = std::max(most,
                    apart(In(a).subspan(6 + 12 * k + 3, 9), In(b).subspan(6 + 9 * k, 9)));
  }
  std::printf("tree: %.1e apart\n", most);
  EXPECT_LE(most, 1e-9);
}

/// Small motions of two equal rigid bars that hang on ball joints: w^2 L/g = 3 -+ 6/sqrt
/// 7, each in two planes. The bars bend by weight: EI/(m g L^2) = 2e5 changes w^2 by its
/// inverse at most. The section's rotational inertia, r^2/(4 L^2) over 1/3, changes it by
/// 1e-6. Bar: 1e-5.
TEST(BallJoints, MakeTwoBarsADoublePendulum) {
  const ModelSettings settings{
      {"elements", "1"},         {"length_m", "1"},
      {"radius_m", "1e-3"},      {"youngs_modulus_pa", "1e16"},
      {"density_kg_m3", "1300"}, {"internal_friction_kg_m3_s", "0"},
      {"drag_kg_m_s", "0"},      {"motion", "free"}};
  const Frame down{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}};
  const Strand upper = strand_at("super_helix", settings, StrandPlace{{}, down}),
               lower = strand_at("super_helix", settings, StrandPlace{{0, 0, -1}, down});
  std::vector<std::unique_ptr<SupportedSystem>> strands;
  strands.push_back(joinable("super_helix", settings, upper, {support(0, {})}));
  strands.push_back(joinable("super_helix", settings, lower));
  const auto system =
      joined(std::move(strands), {joint_of(JointKind::ball, {0, 1}, {1, 0})});
  Options options;
  options.formulation = Formulation::index3;
  integrators::Dynamics dynamics(*system, options);
  std::vector<double> q = zeros(*system), v = q, a = q,
                      lambda(std::size_t(system->layout().constraints));
  system->initial_state(q, v);
  ASSERT_EQ(dynamics.accelerate(0, q, v, a, lambda), Status::ok);
  // The upper joint carries the weight of both, the lower one that of one.
  const double weight = lower.mass() * 9.81;
  std::vector<double> force(3), moment(3), support_force(3), support_moment(3);
  ASSERT_EQ(system->joint_forces(0, q, v, force, moment), Status::ok);
  ASSERT_EQ(system->support_forces(0, q, v, support_force, support_moment), Status::ok);
  EXPECT_NEAR(force[2] / weight, 1, 1e-9);
  EXPECT_NEAR(support_force[2] / weight, 2, 1e-9);
  const Eigen::MatrixXd z = free_motions(*system, q);
  const Eigen::MatrixXd m = z.transpose() * matrix_of(*system, q, lambda, {1, 0, 0}) * z;
  const Eigen::MatrixXd s = z.transpose() * matrix_of(*system, q, lambda, {1, 0, 1}) * z;
  const Eigen::MatrixXd k = s - m;
  const Eigen::GeneralizedSelfAdjointEigenSolver<Eigen::MatrixXd> of(
      0.5 * (k + k.transpose()), 0.5 * (m + m.transpose()), Eigen::EigenvaluesOnly);
  std::vector<double> found;
  for (const double w2 : of.eigenvalues()) {
    if (w2 / 9.81 > 0.1) found.push_back(w2 / 9.81);  // not the spin of the bars
  }
  ASSERT_GE(found.size(), 4U);
  const double expected[] = {3 - 6 / std::sqrt(7), 3 - 6 / std::sqrt(7),
                             3 + 6 / std::sqrt(7), 3 + 6 / std::sqrt(7)};
  for (std::size_t i = 0; i < 4; ++i) {
    std::printf("w^2 L/g = %.9f, %.1e off\n", found[i], found[i] / expected[i] - 1);
    EXPECT_NEAR(found[i] / expected[i], 1, 1e-5);
  }
}

}  // namespace tress::test_joined_motion
