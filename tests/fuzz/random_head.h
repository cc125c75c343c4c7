#pragma once

#include <cstdint>
#include <string>

namespace tress::testing_support {

/// A random scene of a few strands that a head of hair can be: numbers of all sizes, a
/// model, a method and effects that heads have.
std::string random_head(std::uint64_t seed);

}  // namespace tress::testing_support
