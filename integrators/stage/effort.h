#pragma once

namespace tress::integrators {

/// Effort to solve a stage: Newton's iteration and jumps only (plain), or also all
/// methods that cost a hundred times more (whole).
enum class Effort { plain, whole };

}  // namespace tress::integrators
