#pragma once

#include <stdexcept>
#include <string>

namespace tress {

/// Bad input, seen at construction or while reading: one line saying what is wrong, where
/// (file:line:column, option or key) and what to do. Programs print it and exit with 2.
class InputError : public std::runtime_error {
 public:
  InputError(const std::string& problem, const std::string& where,
             const std::string& remedy)
      : std::runtime_error(problem + " (" + where + "): " + remedy) {}
};

inline void refuse_if(bool refused, const std::string& problem, const std::string& where,
                      const std::string& remedy) {
  if (refused) throw InputError(problem, where, remedy);
}

}  // namespace tress
