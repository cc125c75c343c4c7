#include "models/elements/element_rod.h"

namespace tress::models {

ElementRod::ElementRod(const Strand& strand, const std::string& model)
    : strand_(strand), nodal_(strand, model, 0) {
  const StrandPlace& root = nodal_.root.place;
  rest_ = {root.x - strand.segments.front().length * root.frame.e0, root.x};
  for (std::size_t i = 0; i < strand.segments.size(); ++i) {
    rest_.push_back(rest_.back() + strand.segments[i].length * nodal_.natural[i].e0);
  }
}

std::vector<ElementRod::Edge> ElementRod::edges() const {
  std::vector<Edge> all;
  for (const Segment& segment : strand_.segments) {
    all.push_back({static_cast<int>(all.size()), segment});
  }
  return all;
}

std::vector<ElementRod::Joint> ElementRod::joints() const {
  std::vector<Joint> all;
  const Segment* before = nullptr;
  int first = -1;
  for (const Segment& segment : strand_.segments) {
    if (before != nullptr || nodal_.parts.clamped) {
      all.push_back({first, rod_joint(strand_, before, segment, {})});
    }
    before = &segment;
    ++first;
  }
  return all;
}

void ElementRod::place(int first, std::unique_ptr<RodElement> element) {
  std::vector<double> x;
  for (int k = 0; k < element->nodes(); ++k) {
    const Vec& node = rest_.at(static_cast<std::size_t>(first + 1 + k));
    x.insert(x.end(), {node.x, node.y, node.z});
  }
  element->rest_at(x.data());
  elements_.push_back({first, std::move(element)});
}

std::unique_ptr<System> ElementRod::system(Effects effects, LinearKind solver) && {
  nodal_.parts.elasticity = std::make_unique<ElementElasticity>(
      std::move(elements_), strand_.segments.front().length);
  nodal_.parts.effects = std::move(effects);
  nodal_.parts.solver = solver;
  return std::make_unique<MaximalSystem>(std::move(nodal_.parts));
}

}  // namespace tress::models
