#pragma once

#include <algorithm>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "contract/input_error.h"

namespace tress {

/// A catalogue of entries (with an `id`) to which plug-ins add theirs until it is closed,
/// before it is read for the first time: nobody sees it change. Not for several threads.
template <class Entry>
class OpenCatalogue {
 public:
  /// Starts with the built-in entries; `kind` is what messages call an entry.
  OpenCatalogue(std::string_view kind, std::vector<Entry> built_in)
      : kind_(kind), entries_(std::move(built_in)), built_in_(entries_.size()) {}

  /// Throws InputError naming `where` on an id that is no word in small letters, or that
  /// another entry has, and when the catalogue is closed.
  void add(const Entry& entry, const std::string& where) {
    const std::string name = std::string(kind_) + " '" + std::string(entry.id) + "'";
    refuse_if(closed_, "plug-ins come too late: the catalogue has been read", where,
              "load them before anything else");
    refuse_if(!is_word(entry.id), name + " has no name for tables and files", where,
              "give small letters, digits and '_', a letter first");
    refuse_if(std::ranges::count(entries_, entry.id, &Entry::id) > 0,
              "there is a " + name + " already", where, "give it another id");
    entries_.push_back(entry);
  }

  /// Ends additions and returns all entries.
  std::span<const Entry> close() {
    closed_ = true;
    return entries_;
  }
  /// Returns the entries so far, built-in ones first.
  std::span<const Entry> entries() const { return entries_; }
  /// Returns the entries that plug-ins have added.
  std::span<const Entry> added() const { return entries().subspan(built_in_); }

 private:
  static bool is_word(std::string_view id) {
    const auto small = [](char c) { return c >= 'a' && c <= 'z'; };
    const auto other = [](char c) { return c == '_' || (c >= '0' && c <= '9'); };
    return !id.empty() && small(id.front()) &&
           std::ranges::all_of(id, [&](char c) { return small(c) || other(c); });
  }

  std::string_view kind_;
  std::vector<Entry> entries_;
  std::size_t built_in_;
  bool closed_ = false;
};

}  // namespace tress
