#pragma once

#include <map>
#include <span>
#include <string>
#include <string_view>

#include "contract/layers.h"
#include "contract/parameters.h"

namespace tress::simulation {

/// Which keys go with one word of a table's choice, separated by '|'.
struct Use {
  std::string_view word, keys;
};

/// One table of a scene, as far as it is read: the defaults and what the scene gives,
/// each with its place.
class Table {
 public:
  /// `place`: file:line:column.
  Table(std::span<const Parameter> declared, std::string name, std::string place);

  std::span<const Parameter> declared() const { return declared_; }
  const Parameters& values() const { return values_; }
  const std::string& name() const { return name_; }
  const std::string& place() const { return place_; }
  /// Of the value of `key`; of the table where the scene does not give it.
  const std::string& place(std::string_view key) const;
  bool given(std::string_view key) const { return given_.contains(key); }
  /// Of a given key, as the scene has it.
  const std::string& text(std::string_view key) const;

  /// Throws InputError on what Parameters::set refuses.
  void set(std::string_view key, std::string_view text, const std::string& where);

  /// Throws InputError on a given key that `uses` names, but not for the word that
  /// `choice` has: it would do nothing.
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

/// Whether `uses` leaves `key` to `word`: it names it there, or nowhere.
bool used(std::span<const Use> uses, std::string_view word, std::string_view key);

}  // namespace tress::simulation
