#pragma once

#include <memory>

#include "models/maximal/spring_elasticity.h"
#include "models/maximal/strand_elimination.h"

namespace tress::models {

/// Springs by the kernel that heads use (kernel/), for one strand: forces, and S by
/// elimination.
class SpringChain : public StrandElimination {
 public:
  /// f += dE/dz + friction.
  virtual void add_force(const Placement& p, InOut f) noexcept = 0;
};

/// Null unless the springs are those of the kernel: of edges, of the joints between them,
/// and of the wall. Others, of which altitudes and dihedral angles couple three edges,
/// and chords over two their lengths, and strands without a wall are assembled.
std::unique_ptr<SpringChain> spring_chain(const Springs& springs,
                                          SpringJacobian jacobian);

}  // namespace tress::models
