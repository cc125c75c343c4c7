#include "models/constrained/constraint_set.h"

#include <algorithm>
#include <string>

#include "contract/input_error.h"
#include "linear/sparse_pattern.h"

namespace tress::models {

/// One module's inputs and results, on the stack.
struct ConstraintSet::Local {
  double z[max_constraint_inputs];
  double rate[max_constraint_inputs];          // z'
  double acceleration[max_constraint_inputs];  // p'' of anchors, 0 elsewhere
  double gradient[max_constraint_rows * max_constraint_inputs];
  double hessian[max_constraint_inputs * max_constraint_inputs];

  In inputs(const Item& item) const { return {z, static_cast<std::size_t>(item.inputs)}; }
  Out gradient_span(const Item& item) {
    return {gradient, static_cast<std::size_t>(item.rows * item.inputs)};
  }
  /// H of row k alone.
  void row_hessian(const Item& item, int k) {
    double weight[max_constraint_rows] = {};
    weight[k] = 1;
    weighted_hessian(item, {weight, static_cast<std::size_t>(item.rows)});
  }
  void weighted_hessian(const Item& item, In weight) {
    item.module->hessian(inputs(item), weight,
                         {hessian, static_cast<std::size_t>(item.inputs * item.inputs)});
  }
};

namespace {

double product(const double* a, const double* b, int count) {
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += a[i] * b[i];
  return sum;
}

}  // namespace

ConstraintSet::ConstraintSet(Constraints modules, std::vector<Anchor> anchors,
                             int particles, int parameters, double extent)
    : modules_(std::move(modules)),
      anchors_(std::move(anchors)),
      particles_(particles),
      parameters_(parameters),
      coordinates_(3 * particles + parameters),
      extent_(extent) {
  for (const Anchor& anchor : anchors_) {
    for (const double x : {anchor.x.x, anchor.x.y, anchor.x.z}) place_.push_back(x);
  }
  velocity_.assign(place_.size(), 0);
  acceleration_.assign(place_.size(), 0);

  int row = 0;
  int couplings = 0;
  for (const auto& module : modules_) {
    Item item;
    item.module = module.get();
    item.rows = module->rows();
    item.inputs = module->inputs();
    item.first_row = row;
    item.first_input = static_cast<int>(input_.size());
    item.first_coupling = couplings;
    for (const Node node : module->nodes()) {
      const int first = first_number(node);
      for (int i = 0; i < node.size(); ++i) input_.push_back(first + i);
    }
    auto own = std::vector<int>(input_.begin() + item.first_input, input_.end());
    std::sort(own.begin(), own.end());
    const bool twice = std::adjacent_find(own.begin(), own.end()) != own.end();
    if (twice || static_cast<int>(own.size()) != item.inputs) {
      throw InputError("a node is named twice or is of the wrong kind",
                       "constraint " + std::to_string(items_.size()),
                       "attach each end to a node of its own");
    }
    for (int i = 0; i < item.inputs; ++i) {
      const int input = input_[static_cast<std::size_t>(item.first_input + i)];
      const auto place = std::lower_bound(own.begin(), own.end(), input) - own.begin();
      rank_.push_back(input < coordinates_ ? static_cast<int>(place) : -1);
    }
    row += item.rows;
    if (!module->linear()) couplings += item.inputs * item.inputs;
    items_.push_back(item);
  }
  coupling_.assign(static_cast<std::size_t>(couplings), -1);
  build_pattern();
}

int ConstraintSet::first_number(Node node) const {
  const int counts[] = {particles_, parameters_, static_cast<int>(anchors_.size())};
  const int starts[] = {0, 3 * particles_, coordinates_};
  const auto kind = static_cast<std::size_t>(node.kind);
  if (node.index < 0 || node.index >= counts[kind]) {
    throw InputError("node " + std::to_string(node.index) + " does not exist",
                     "constraint " + std::to_string(items_.size()),
                     "add particles, parameters and anchors before their constraints");
  }
  return starts[kind] + node.size() * node.index;
}

void ConstraintSet::build_pattern() {
  gradient_.rows = coordinates_;
  gradient_.start = {0};
  for (const Item& item : items_) {
    const auto begin = input_.begin() + item.first_input;
    std::vector<int> own(begin, begin + item.inputs);
    std::erase_if(own, [this](int input) { return input >= coordinates_; });
    std::sort(own.begin(), own.end());
    for (int k = 0; k < item.rows; ++k) {
      gradient_.row.insert(gradient_.row.end(), own.begin(), own.end());
      gradient_.start.push_back(static_cast<int>(gradient_.row.size()));
    }
  }
  gradient_.cols = static_cast<int>(gradient_.start.size()) - 1;
}

void ConstraintSet::couple(std::vector<std::vector<int>>& columns) const {
  for (const Item& item : items_) {
    if (item.module->linear()) continue;
    const int* input = &input_[static_cast<std::size_t>(item.first_input)];
    for (int i = 0; i < item.inputs; ++i) {
      for (int j = 0; j < item.inputs; ++j) {
        if (input[i] >= coordinates_ || input[j] >= coordinates_) continue;
        columns[static_cast<std::size_t>(input[j])].push_back(input[i]);
      }
    }
  }
}

void ConstraintSet::bind(const Pattern& s) {
  for (const Item& item : items_) {
    if (item.module->linear()) continue;
    const int* input = &input_[static_cast<std::size_t>(item.first_input)];
    for (int i = 0; i < item.inputs; ++i) {
      for (int j = 0; j < item.inputs; ++j) {
        if (input[i] >= coordinates_ || input[j] >= coordinates_) continue;
        coupling_[static_cast<std::size_t>(item.first_coupling + i * item.inputs + j)] =
            place_of(s, input[i], input[j]);
      }
    }
  }
}

void ConstraintSet::move_anchors(double t) noexcept {
  for (std::size_t k = 0; k < anchors_.size(); ++k) {
    if (!anchors_[k].motion) continue;
    const CurvePoint p = anchors_[k].motion->at(t, since_);
    store3(p.c, &place_[3 * k]);
    store3(p.d1, &velocity_[3 * k]);
    store3(p.d2, &acceleration_[3 * k]);
  }
}

double ConstraintSet::number(In q, const std::vector<double>& anchors,
                             int input) const noexcept {
  return input < coordinates_ ? q[static_cast<std::size_t>(input)]
                              : anchors[static_cast<std::size_t>(input - coordinates_)];
}

ConstraintSet::Local ConstraintSet::gather(const Item& item, In q) const noexcept {
  Local local;
  const int* input = &input_[static_cast<std::size_t>(item.first_input)];
  for (int i = 0; i < item.inputs; ++i) local.z[i] = number(q, place_, input[i]);
  return local;
}

void ConstraintSet::gather_rates(const Item& item, In v, Local& local) const noexcept {
  const int* input = &input_[static_cast<std::size_t>(item.first_input)];
  for (int i = 0; i < item.inputs; ++i) {
    local.rate[i] = number(v, velocity_, input[i]);
    const int anchored = input[i] - coordinates_;
    local.acceleration[i] =
        anchored < 0 ? 0 : acceleration_[static_cast<std::size_t>(anchored)];
  }
}

/// Writes one row of a module into its column of a matrix on pattern().
void ConstraintSet::scatter_column(const Item& item, int row, const double* values,
                                   Out out) const noexcept {
  const int start = gradient_.start[static_cast<std::size_t>(item.first_row + row)];
  const int* rank = &rank_[static_cast<std::size_t>(item.first_input)];
  for (int i = 0; i < item.inputs; ++i) {
    if (rank[i] >= 0) out[static_cast<std::size_t>(start + rank[i])] = values[i];
  }
}

void ConstraintSet::scale(Out g_typ) const {
  for (const Item& item : items_) {
    std::fill_n(g_typ.begin() + item.first_row, item.rows, item.module->scale(extent_));
  }
}

Status ConstraintSet::value(double t, In q, Out g) noexcept {
  move_anchors(t);
  for (const Item& item : items_) {
    const Local local = gather(item, q);
    item.module->value(local.inputs(item),
                       g.subspan(static_cast<std::size_t>(item.first_row),
                                 static_cast<std::size_t>(item.rows)));
  }
  return Status::ok;
}

Status ConstraintSet::gradient(double t, In q, Out gt) noexcept {
  move_anchors(t);
  for (const Item& item : items_) {
    Local local = gather(item, q);
    item.module->gradient(local.inputs(item), local.gradient_span(item));
    for (int k = 0; k < item.rows; ++k) {
      scatter_column(item, k, local.gradient + k * item.inputs, gt);
    }
  }
  return Status::ok;
}

Status ConstraintSet::rate(double t, In q, In v, Out g_dot) noexcept {
  move_anchors(t);
  for (const Item& item : items_) {
    Local local = gather(item, q);
    gather_rates(item, v, local);
    item.module->gradient(local.inputs(item), local.gradient_span(item));
    for (int k = 0; k < item.rows; ++k) {
      g_dot[static_cast<std::size_t>(item.first_row + k)] =
          product(local.gradient + k * item.inputs, local.rate, item.inputs);
    }
  }
  return Status::ok;
}

Status ConstraintSet::bias(double t, In q, In v, Out b) noexcept {
  move_anchors(t);
  for (const Item& item : items_) {
    Local local = gather(item, q);
    gather_rates(item, v, local);
    item.module->gradient(local.inputs(item), local.gradient_span(item));
    for (int k = 0; k < item.rows; ++k) {
      double sum =
          product(local.gradient + k * item.inputs, local.acceleration, item.inputs);
      if (!item.module->linear()) {
        local.row_hessian(item, k);
        for (int i = 0; i < item.inputs; ++i) {
          sum += local.rate[i] *
                 product(local.hessian + i * item.inputs, local.rate, item.inputs);
        }
      }
      b[static_cast<std::size_t>(item.first_row + k)] = sum;
    }
  }
  return Status::ok;
}

Status ConstraintSet::rate_gradient(double t, In q, In v, Out values) noexcept {
  move_anchors(t);
  std::fill(values.begin(), values.end(), 0.0);
  for (const Item& item : items_) {
    if (item.module->linear()) continue;
    Local local = gather(item, q);
    gather_rates(item, v, local);
    for (int k = 0; k < item.rows; ++k) {
      local.row_hessian(item, k);
      double row[max_constraint_inputs];
      for (int i = 0; i < item.inputs; ++i) {
        row[i] = product(local.hessian + i * item.inputs, local.rate, item.inputs);
      }
      scatter_column(item, k, row, values);
    }
  }
  return Status::ok;
}

Status ConstraintSet::add_curvature(double t, In q, In lambda, double factor,
                                    InOut s) noexcept {
  move_anchors(t);
  for (const Item& item : items_) {
    if (item.module->linear()) continue;
    Local local = gather(item, q);
    local.weighted_hessian(item, lambda.subspan(static_cast<std::size_t>(item.first_row),
                                                static_cast<std::size_t>(item.rows)));
    const int* place = &coupling_[static_cast<std::size_t>(item.first_coupling)];
    for (int i = 0; i < item.inputs * item.inputs; ++i) {
      if (place[i] >= 0)
        s[static_cast<std::size_t>(place[i])] += factor * local.hessian[i];
    }
  }
  return Status::ok;
}

}  // namespace tress::models
