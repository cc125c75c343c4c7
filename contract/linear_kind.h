#pragma once

namespace tress {

/// Linear solvers: `automatic` chooses by size and pattern among sparse (`klu`), `banded`
/// and `dense` LU. A model's own solve (System::linearize and solve) is reported as
/// `structured`; it cannot be selected.
enum class LinearKind { automatic, klu, banded, dense };

}  // namespace tress
