#include "simulation/files/checksum.h"

#include <fmt/format.h>

#include <stdexcept>

namespace tress::simulation {

Checksum& Checksum::add(std::string_view bytes) {
  for (const char c : bytes) {
    hash_ = (hash_ ^ static_cast<unsigned char>(c)) * 1099511628211u;
  }
  return *this;
}

std::string Checksum::text() const { return fmt::format("{:016x}", hash_); }

std::string checksum(std::string_view bytes) { return Checksum().add(bytes).text(); }

std::string sealed(std::string_view bytes) {
  return fmt::format("{} {}", checksum(bytes), bytes);
}

std::string_view unsealed(std::string_view text) {
  const std::size_t blank = text.find(' ');
  if (blank != std::string_view::npos) {
    const std::string_view bytes = text.substr(blank + 1);
    if (text.substr(0, blank) == checksum(bytes)) return bytes;
  }
  throw std::runtime_error("its checksum does not fit");
}

}  // namespace tress::simulation
