#pragma once

#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "math/vec3.h"

namespace tress {

/// Declares one parameter of a catalogue entry: a number in [min, max], whole when
/// `whole`, unless
///
///     choices is set     one value of that list, separated by '|'
///     components > 1     that many such numbers, "x,y,z"
///     rows               any number of such tuples, "x,y,z;x,y,z"; may be empty
///     text               any text: a file, a name
struct Parameter {
  std::string_view name;  // key in scenes and options
  std::string_view help;  // with unit
  double number = 0;      // default
  /// Least number.
  double min = -std::numeric_limits<double>::infinity();
  /// Largest number.
  double max = std::numeric_limits<double>::infinity();
  bool whole = false;              // whether the number is whole
  std::string_view choices = {};   // first one is the default
  int components = 1;              // numbers of a tuple
  bool rows = false;               // whether the value is a list of tuples
  bool text = false;               // whether the value is any text
  std::string_view fallback = {};  // the default of components, rows and text

  /// The default as text that set() accepts.
  std::string default_text() const;
};

/// Values for one entry's declared parameters: the defaults, then what the user set.
class Parameters {
 public:
  /// `where` names the owner in messages, e.g. "model bead_on_wire".
  Parameters(std::span<const Parameter> declared, std::string where);

  /// Throws InputError on an unknown key, a malformed or non-finite number, a number out
  /// of range or a value not among the choices; the message lists the accepted values.
  void set(std::string_view key, std::string_view value);
  /// Sets a value as set(key, value) does; messages name `where` (file:line:column)
  /// instead of the owner.
  void set(std::string_view key, std::string_view value, const std::string& where);
  /// Returns true if a parameter of this key is declared.
  bool knows(std::string_view key) const;

  /// Returns the value of a parameter of one number.
  double number(std::string_view key) const;
  /// Returns the value of a parameter that is whole.
  int whole(std::string_view key) const;
  std::string_view word(std::string_view key) const;  // of choices, or text
  /// Returns the value of a parameter with three components.
  Vec vec(std::string_view key) const;
  /// Components of all rows, one row after the other.
  std::span<const double> numbers(std::string_view key) const;
  /// The value as text for set(), which restores it bit for bit.
  std::string text(std::string_view key) const;

 private:
  struct Value {
    std::vector<double> numbers;
    std::string word;
  };
  std::size_t index(std::string_view key, const std::string& where) const;
  const Value& value(std::string_view key) const { return values_[index(key, where_)]; }

  std::span<const Parameter> declared_;
  std::vector<Value> values_;
  std::string where_;
};

/// The shortest text that reads back as exactly x.
std::string number_text(double x);

/// The option values in a Parameter's `choices`.
std::vector<std::string_view> words_of(std::string_view choices);

/// The candidate nearest to `word` by edit distance, or empty when none is near.
std::string_view nearest(std::string_view word,
                         std::span<const std::string_view> candidates);

/// Remedy for an unknown name: its present name, or the nearest candidate, or
/// `otherwise`. A present name that is no candidate stands before `otherwise`.
std::string suggestion(std::string_view word,
                       std::span<const std::string_view> candidates,
                       const std::string& otherwise);

}  // namespace tress
