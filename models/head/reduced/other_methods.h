#pragma once

#include <memory>

#include "models/head/head.h"

namespace tress::models {

// Heads by the methods beyond semi_implicit_euler, of valid options. Their sources are
// compiled without fused products, whose choice depends on the number of lanes and on
// what the compiler inlines; what they share with other sources must be inlined, or the
// linker would choose one for both.
std::unique_ptr<Head> other_helix_head(const HeadOptions& options, const HeadPack& pack);
std::unique_ptr<Head> other_chain_head(const HeadOptions& options, const HeadPack& pack);

}  // namespace tress::models
