#include "models/mesh/mesh_text.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "contract/decimal.h"
#include "contract/input_error.h"

namespace tress::models {
namespace {

constexpr std::string_view blanks = " \t\r\n\v\f";

}  // namespace

std::string_view first_word(std::string_view& line) {
  line.remove_prefix(std::min(line.find_first_not_of(blanks), line.size()));
  const std::string_view word = line.substr(0, line.find_first_of(blanks));
  line.remove_prefix(word.size());
  return word;
}

std::string_view MeshText::line() {
  start_ = at_;
  const std::string_view rest = bytes_.substr(at_);
  const std::size_t end = rest.find('\n');
  std::string_view line = rest.substr(0, end);
  at_ += std::min(line.size() + 1, rest.size());
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

std::string_view MeshText::word() {
  std::string_view rest = bytes_.substr(at_);
  const std::string_view word = first_word(rest);
  at_ = bytes_.size() - rest.size();
  start_ = at_ - word.size();
  return word;
}

double MeshText::number() {
  const std::string text(word());
  const std::optional<double> x = decimal(text);
  if (text.empty()) refuse("the file ends where a number is missing");
  if (!x || !std::isfinite(*x)) {
    refuse("'" + text.substr(0, 40) + "' where a finite number is expected");
  }
  return *x;
}

void MeshText::refuse(const std::string& problem) const {
  const std::string_view read = bytes_.substr(0, start_);
  const std::string place =
      binary_ ? file_ + ", byte " + std::to_string(start_)
              : file_ + ":" + std::to_string(1 + std::ranges::count(read, '\n'));
  throw InputError(problem, place, "write the mesh again as OBJ, PLY or STL");
}

}  // namespace tress::models
