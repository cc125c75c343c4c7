#pragma once

#include <vector>

#include "contract/forms/compliance_form.h"
#include "linear/skyline.h"

namespace tress::integrators {

/// Coordinates of a ComplianceForm that are solved together, the others held.
struct Window {
  /// A block of the form that touches the window.
  struct Part {
    std::size_t block;    // index of the block
    std::vector<int> at;  // of each of its coordinates in the window, -1: it is held
  };

  std::vector<std::size_t> coordinates;  // indices into q
  std::vector<Part> parts;               // blocks that touch the window
  Skyline matrix, exact;                 // of the profile that the parts give
};

/// Returns the nodes of a system of n coordinates, each as a list of coordinates. A node
/// is a set of coordinates that enter the same blocks, such as the position of a mass
/// point or a quaternion. Nodes are in the order of the blocks, along the body from the
/// root. Coordinates in `without` are in none.
std::vector<std::vector<int>> nodes_of(const ComplianceForm& form, int n,
                                       const std::vector<int>& without);

/// Windows of `size` consecutive nodes each, the first of `first` and the last of what
/// is left.
std::vector<Window> windows_of(const ComplianceForm& form, int n,
                               const std::vector<std::vector<int>>& nodes,
                               std::size_t first, std::size_t size);

}  // namespace tress::integrators
