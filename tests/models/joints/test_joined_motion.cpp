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

/// Largest difference of accelerations at the start between the built-in tree `algae`, a
/// stalk with three stems, and four welded strands, over the largest acceleration.
double off_the_tree(double thickness) {
  const ModelSettings settings{{"tree", "algae"}};
  Parameters chosen(find_model("super_helix_tree").parameters, "tree");
  for (const auto& [key, value] : settings) chosen.set(key, value);
  Strand tree = models::described_tree(chosen);
  EXPECT_EQ(tree.segments.size(), 10U);
  for (models::Segment& segment : tree.segments) {
    segment.section = {thickness * segment.section.a1, thickness * segment.section.a2};
  }
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
    EXPECT_EQ(tree.segments[first].parent, 0);
    StrandPlace root = fork;
    root.frame = fork.frame * tree.segments[first].mount;
    strands.push_back(system(freed(chain_from(tree, first, 3, root), root)));
    welds.push_back(joint_of(JointKind::weld, {0, 1}, {k + 1, 0}));
  }
  const auto welded = joined(std::move(strands), welds);
  const auto whole = models::super_helix(tree, models::reduced_options(options), effects);
  const std::vector<double> a = accelerations_at_start(*welded),
                            b = accelerations_at_start(*whole);
  // Points of the tree: the root, then the tips of the segments.
  double most = apart(In(a).first(6), In(b).first(6));
  for (std::size_t k = 0; k < 3; ++k) {
    most = std::max(most,
                    apart(In(a).subspan(6 + 12 * k + 3, 9), In(b).subspan(6 + 9 * k, 9)));
  }
  return most;
}

/// The built-in tree and welded strands have the same equations but one term: the
/// rotational inertia of the first half element of a stem turns about the tangent of the
/// stalk in the tree, about that of the stem in the strand. It is a share r^2/L^2 of the
/// inertia, 6e-4 here, so that sections of a hundredth of the radius leave 1e-4 of that.
TEST(Welds, OfBranchesAreTheBuiltInTree) {
  const double thick = off_the_tree(1), thin = off_the_tree(0.01);
  std::printf("tree: %.1e, thin %.1e apart\n", thick, thin);
  EXPECT_LE(thick, 2e-3);
  EXPECT_LE(thin, 2e-7);
}

/// Small motions of two equal rigid bars that hang on ball joints: w^2 L/g = 3 -+ 6/sqrt
/// 7, each in two planes. The bars bend under their weight: m g L^2/EI = 6e-6 bounds the
/// change of w^2. The section's rotational inertia, r^2/4 next to L^2/3, changes it by
/// 3e-6. Bar: 1e-5.
TEST(BallJoints, MakeTwoBarsADoublePendulum) {
  const ModelSettings settings{
      {"elements", "1"},         {"length_m", "0.5"},
      {"radius_m", "1e-3"},      {"youngs_modulus_pa", "1e15"},
      {"density_kg_m3", "1300"}, {"internal_friction_kg_m3_s", "0"},
      {"drag_kg_m_s", "0"},      {"motion", "free"}};
  const Frame down{{0, 0, -1}, {0, 1, 0}, {1, 0, 0}};
  const Strand upper = strand_at("super_helix", settings, StrandPlace{{}, down}),
               lower =
                   strand_at("super_helix", settings, StrandPlace{{0, 0, -0.5}, down});
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
  // Motions x of the frequency w solve (M + t^2 K) x - G^T y = (1 + t^2 w^2) M x, G x =
  // 0.
  constexpr double t2 = 0.05;  // s^2
  const Eigen::MatrixXd m = matrix_of(*system, q, lambda, {1, 0, 0});
  Eigen::MatrixXd answers(m.rows(), m.cols());
  const std::vector<double> zero(q.size());
  ASSERT_EQ(dynamics.linearize(0, q, v, zero, lambda, {1, 0, t2}), Status::ok);
  for (Eigen::Index i = 0; i < m.cols(); ++i) {
    std::vector<double> x(q.size()), y(lambda.size());
    Eigen::Map<Eigen::VectorXd>(x.data(), m.rows()) = m.col(i);
    ASSERT_EQ(dynamics.solve(x, y), Status::ok);
    answers.col(i) = Eigen::Map<Eigen::VectorXd>(x.data(), m.rows());
  }
  const Eigen::VectorXd shares =
      Eigen::EigenSolver<Eigen::MatrixXd>(answers, false).eigenvalues().real();
  std::vector<double> found;
  for (const double share : shares) {
    // Neither the spin of the bars nor their bending.
    if (share > 0.01 && share < 0.99) found.push_back(0.5 * (1 / share - 1) / t2 / 9.81);
  }
  std::ranges::sort(found);
  ASSERT_EQ(found.size(), 4U);
  const double expected[] = {3 - 6 / std::sqrt(7), 3 - 6 / std::sqrt(7),
                             3 + 6 / std::sqrt(7), 3 + 6 / std::sqrt(7)};
  for (std::size_t i = 0; i < 4; ++i) {
    std::printf("w^2 L/g = %.9f, %.1e off\n", found[i], found[i] / expected[i] - 1);
    EXPECT_NEAR(found[i] / expected[i], 1, 1e-5);
  }
}

}  // namespace tress::test_joined_motion
