#pragma once

#include <stdexcept>
#include <string>

#include "contract/printable.h"

namespace tress {

/// Bad input, seen at construction or while reading: one line saying what is wrong, where
/// (file:line:column, option or key) and what to do. Programs print it and exit with 2.
/// The line is printable(); a long quotation of the input loses its middle.
class InputError : public std::runtime_error {
 public:
  /// Makes the line "`problem` (`where`): `remedy`".
  InputError(const std::string& problem, const std::string& where,
             const std::string& remedy)
      : std::runtime_error(shortened(problem, 400) + " (" +
                           shortened(where, longest_path) +
                           "): " + shortened(remedy, 2000)) {}

 private:
  static constexpr std::size_t longest_path = 4200;
};

/// Throws InputError if `refused`.
inline void refuse_if(bool refused, const std::string& problem, const std::string& where,
                      const std::string& remedy) {
  if (refused) throw InputError(problem, where, remedy);
}

}  // namespace tress
