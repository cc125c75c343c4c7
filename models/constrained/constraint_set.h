#pragma once

#include <memory>
#include <vector>

#include "contract/forms/constraint_form.h"
#include "contract/pattern.h"
#include "models/constrained/constraint.h"
#include "models/constrained/curve.h"
#include "models/motion/by_time.h"

namespace tress::models {

/// A point with prescribed position: fixed at x, or following `motion` (x is then
/// unused).
struct Anchor {
  Vec x;                                // place of a fixed anchor, m
  std::shared_ptr<const Curve> motion;  // motion over time; null: fixed
};

/// Assembles modules into g(t, q) = 0 with block-sparse G. Particle i has coordinates
/// q[3i..3i+2], parameter j has q[3 particles + j]; anchors follow as prescribed inputs
/// p(t), the source of the time derivatives of g. Rows are in the order of the modules.
/// The KKT matrix of a chain whose particles and links are added from one end to the
/// other is therefore banded once q and lambda are interleaved. Every call is O(modules).
class ConstraintSet final : public ConstraintForm {
 public:
  /// Throws InputError if a module names an unknown node, or the same node twice.
  ConstraintSet(Constraints modules, std::vector<Anchor> anchors, int particles,
                int parameters, double extent);

  /// Returns the number of constraints.
  int rows() const { return gradient_.cols; }

  /// Adds every pair coupled by curvature to `columns` (one row list per column of S).
  void couple(std::vector<std::vector<int>>& columns) const;
  /// Looks up the positions of curvature entries in S; call once, before add_curvature.
  void bind(const Pattern& s);
  /// Moves anchors from now on as after the teleport at t (Teleports::follow).
  void follow(double t) { since_ = t; }

  const Pattern& pattern() const override { return gradient_; }
  void scale(Out g_typ) const override;
  Status value(double t, In q, Out g) noexcept override;
  Status gradient(double t, In q, Out gt) noexcept override;
  Status rate(double t, In q, In v, Out g_dot) noexcept override;
  Status bias(double t, In q, In v, Out b) noexcept override;
  Status rate_gradient(double t, In q, In v, Out values) noexcept override;
  Status add_curvature(double t, In q, In lambda, double factor,
                       InOut s) noexcept override;

 private:
  struct Item {
    const Constraint* module = nullptr;
    int rows = 0;
    int inputs = 0;
    int first_row = 0;
    int first_input = 0;
    int first_coupling = 0;
  };
  struct Local;

  int first_number(Node node) const;
  void build_pattern();
  void move_anchors(double t) noexcept;
  double number(In q, const std::vector<double>& anchors, int input) const noexcept;
  Local gather(const Item& item, In q) const noexcept;
  void gather_rates(const Item& item, In v, Local& local) const noexcept;
  void scatter_column(const Item& item, int row, const double* values,
                      Out out) const noexcept;

  Constraints modules_;
  std::vector<Anchor> anchors_;
  int particles_;
  int parameters_;
  int coordinates_;
  double extent_;
  double since_ = by_time;  // last teleport, s
  Pattern gradient_;        // pattern of G^T
  std::vector<Item> items_;
  std::vector<int>
      input_;  // per local input: coordinate, or coordinates + 3 anchor + axis
  std::vector<int> rank_;  // per local input: index in its column of G^T, -1: prescribed
  std::vector<int> coupling_;  // per local pair: index in S, -1: prescribed
  std::vector<double> place_, velocity_, acceleration_;  // (3 anchors)
};

}  // namespace tress::models
