#include "integrators/position_based/windows.h"

#include <algorithm>
#include <map>

namespace tress::integrators {

std::vector<std::vector<int>> nodes_of(const ComplianceForm& form, int n,
                                       const std::vector<int>& without) {
  std::vector<std::vector<std::size_t>> touching(static_cast<std::size_t>(n));
  for (std::size_t k = 0; k < form.blocks().size(); ++k) {
    for (const int i : form.blocks()[k].coordinates) {
      touching[static_cast<std::size_t>(i)].push_back(k);
    }
  }
  std::map<std::vector<std::size_t>, std::vector<int>> alike;
  for (int i = 0; i < n; ++i) {
    if (std::ranges::count(without, i) > 0) continue;
    alike[touching[static_cast<std::size_t>(i)]].push_back(i);
  }
  std::vector<std::pair<std::size_t, std::vector<int>>> nodes;  // by twice the middle
  for (auto& [blocks, coordinates] : alike) {
    const std::size_t middle = blocks.empty() ? 0 : blocks.front() + blocks.back();
    nodes.emplace_back(middle, std::move(coordinates));
  }
  std::ranges::sort(nodes);
  std::vector<std::vector<int>> all;
  for (auto& node : nodes) all.push_back(std::move(node.second));
  return all;
}

namespace {

Window window_of(const ComplianceForm& form, int n,
                 std::vector<std::size_t> coordinates) {
  std::vector<int> place(static_cast<std::size_t>(n), -1);
  for (std::size_t i = 0; i < coordinates.size(); ++i) {
    place[coordinates[i]] = static_cast<int>(i);
  }
  std::vector<Window::Part> parts;
  std::vector<std::size_t> first(coordinates.size());
  for (std::size_t i = 0; i < first.size(); ++i) first[i] = i;
  for (std::size_t k = 0; k < form.blocks().size(); ++k) {
    Window::Part part{k, {}};
    std::size_t lowest = coordinates.size();
    for (const int i : form.blocks()[k].coordinates) {
      part.at.push_back(place[static_cast<std::size_t>(i)]);
      if (part.at.back() < 0) continue;
      lowest = std::min(lowest, static_cast<std::size_t>(part.at.back()));
    }
    if (lowest == coordinates.size()) continue;
    for (const int at : part.at) {
      if (at < 0) continue;
      auto& entry = first[static_cast<std::size_t>(at)];
      entry = std::min(entry, lowest);
    }
    parts.push_back(std::move(part));
  }
  return {std::move(coordinates), std::move(parts), Skyline(first), Skyline(first)};
}

}  // namespace

std::vector<Window> windows_of(const ComplianceForm& form, int n,
                               const std::vector<std::vector<int>>& nodes,
                               std::size_t first, std::size_t size) {
  std::vector<Window> all;
  std::size_t end = first;
  for (std::size_t k = 0; k < nodes.size(); end += size) {
    std::vector<std::size_t> coordinates;
    for (; k < std::min(end, nodes.size()); ++k) {
      coordinates.insert(coordinates.end(), nodes[k].begin(), nodes[k].end());
    }
    all.push_back(window_of(form, n, std::move(coordinates)));
  }
  return all;
}

}  // namespace tress::integrators
