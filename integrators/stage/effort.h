#pragma once

namespace tress::integrators {

/// How far a solution of a stage is sought: by Newton's iteration and on jumps alone
/// (plain), or also by all that costs a hundred times as much (whole).
enum class Effort { plain, whole };

}  // namespace tress::integrators
