#pragma once

namespace tress {

/// `structured` is a model's own solve (System::linearize and solve), reported by name
/// only.
enum class LinearKind { automatic, klu, banded, dense };

}  // namespace tress
