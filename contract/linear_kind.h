#pragma once

namespace tress {

/// A model's own solve (System::linearize and solve) is reported as `structured`; it
/// cannot be selected.
enum class LinearKind { automatic, klu, banded, dense };

}  // namespace tress
