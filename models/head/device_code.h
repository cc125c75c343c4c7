#pragma once

namespace tress::models {

/// helix_kernel.cu as PTX, which the driver of a device compiles when it loads it; empty
/// in a build that found no clang for it. Kernels: helix_<bits>_few and _most
/// (models/head/helix_launch.h), a strand a thread, kernel_threads threads a block.
extern const char* const helix_ptx;
/// Threads of a block.
inline constexpr unsigned kernel_threads = 64;

}  // namespace tress::models
