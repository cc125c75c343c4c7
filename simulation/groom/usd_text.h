#pragma once

#include <string>
#include <vector>

#include "simulation/groom/byte_stream.h"

namespace tress::simulation {

/// Words and values of a USD text file [OpenUSD, usda]. All throw InputError with the
/// line where the text ends or is not what they read.
class UsdText {
 public:
  explicit UsdText(ByteStream& from) : from_(from) {}

  /// Skips blanks and comments; the next character, -1 at the end.
  int next();
  void expect(char c);
  /// A name with its colons, dots and []; empty if none begins here.
  std::string word();
  std::string quoted();
  /// Any value: a number, a word, a text, a path, a list, a dictionary.
  void skip_value();
  /// All numbers of a value, whatever brackets are around them.
  std::vector<double> numbers();
  /// A list, use() reading each item.
  template <class Use>
  void list(const Use& use) {
    expect('[');
    while (next() != ']') {
      use();
      if (next() == ',') from_.get();
    }
    expect(']');
  }

  ByteStream& from() { return from_; }

 private:
  void skip_balanced();

  ByteStream& from_;
};

}  // namespace tress::simulation
