#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "contract/layers.h"

namespace tress::simulation {

/// 64-bit FNV-1a [Fowler, Noll, Vo]: distinguishes texts and files and detects damaged
/// files. Every step is a bijection of the hash, so that one changed byte is always
/// detected; other damage is missed with probability 2^-64. No protection against
/// deliberate changes.
class Checksum {
 public:
  /// Adds bytes; returns the same object.
  Checksum& add(std::string_view bytes);
  /// Returns the hash of all bytes so far.
  std::uint64_t value() const { return hash_; }
  std::string text() const;  // 16 hexadecimal digits

 private:
  std::uint64_t hash_ = 14695981039346656037u;
};

/// Returns the checksum of bytes as text.
std::string checksum(std::string_view bytes);

/// The bytes, preceded by their checksum and a blank.
std::string sealed(std::string_view bytes);
/// The bytes of a sealed text; throws std::runtime_error when they have changed.
std::string_view unsealed(std::string_view text);

}  // namespace tress::simulation
