#pragma once

#include <string>
#include <vector>

#include "simulation/groom/byte_stream.h"

namespace tress::simulation {

/// Words and values of a USD text file [OpenUSD, usda]. All throw InputError with the
/// line where the text ends or is not what they read.
class UsdText {
 public:
  /// Reads from `from`, which must outlive it.
  explicit UsdText(ByteStream& from) : from_(from) {}

  /// Skips blanks and comments; the next character, -1 at the end.
  int next();
  /// Skips blanks and takes this character.
  void expect(char c);
  /// A name with its colons, dots and []; empty if none begins here.
  std::string word();
  /// Returns the text between quotes.
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

  /// Returns the file that is read.
  ByteStream& from() { return from_; }

  /// Metadata in parentheses: use(key) reads the value after the = or returns false.
  template <class Use>
  void metadata(const Use& use) {
    expect('(');
    for (int c = next(); c != ')'; c = next()) {
      if (c == '"' || c == '\'') {
        quoted();  // a comment
      } else if (c == '(') {
        skip_value();  // of the value before
      } else if (c == ';' || c == ',') {
        from_.get();
      } else {
        const std::string key = word();
        if (key.empty()) expect(')');
        if (next() != '=') continue;
        expect('=');
        if (!use(key)) skip_value();
      }
    }
    expect(')');
  }

 private:
  void skip_balanced();
  void skip_asset();
  void skip_path();

  ByteStream& from_;
};

}  // namespace tress::simulation
