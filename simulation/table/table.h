#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "contract/layers.h"
#include "contract/parameters.h"

namespace tress::simulation {

/// The keys that apply to one value of a table's choice, separated by '|'.
struct Use {
  std::string_view word, keys;  // value of the choice, and the keys that apply to it
};

/// One table of a scene: the defaults and the values given by the scene, each with its
/// location.
class Table {
 public:
  /// `place`: file:line:column.
  Table(std::span<const Parameter> declared, std::string name, std::string place);

  /// Returns the keys that the table may have.
  std::span<const Parameter> declared() const { return declared_; }
  /// Returns the values of all keys.
  const Parameters& values() const { return values_; }
  /// Returns the name of the table.
  const std::string& name() const { return name_; }
  /// Returns the location of the table.
  const std::string& place() const { return place_; }
  /// Location of the value of `key`; of the table if the scene does not give it.
  const std::string& place(std::string_view key) const;
  /// Returns true if the scene gives the key.
  bool given(std::string_view key) const { return given_.contains(key); }
  /// Text of a given key, as in the scene.
  const std::string& text(std::string_view key) const;

  /// Throws InputError as Parameters::set does.
  void set(std::string_view key, std::string_view text, const std::string& where);

  /// Throws InputError on a given key that `uses` names, but not for the present value of
  /// `choice`: it would have no effect.
  void refuse_unused(std::string_view choice, std::span<const Use> uses) const;

 private:
  std::span<const Parameter> declared_;
  Parameters values_;
  std::string name_, place_;
  struct Given {
    std::string text, place;
  };
  std::map<std::string, Given, std::less<>> given_;
};

/// Whether `key` applies to `word`: `uses` names it for `word`, or nowhere.
bool used(std::span<const Use> uses, std::string_view word, std::string_view key);

/// Returns the words of a list as text: "a,b".
std::vector<std::string> names_of(std::string_view list);

}  // namespace tress::simulation
