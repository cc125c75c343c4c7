#include "simulation/table/table.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "contract/input_error.h"

namespace tress::simulation {
namespace {

bool names(const Use& use, std::string_view key) {
  return std::ranges::count(words_of(use.keys), key) > 0;
}

}  // namespace

Table::Table(std::span<const Parameter> declared, std::string name, std::string place)
    : declared_(declared),
      values_(declared, name),
      name_(std::move(name)),
      place_(std::move(place)) {}

const std::string& Table::place(std::string_view key) const {
  const auto found = given_.find(key);
  return found == given_.end() ? place_ : found->second.place;
}

const std::string& Table::text(std::string_view key) const {
  return given_.find(key)->second.text;
}

void Table::set(std::string_view key, std::string_view text, const std::string& where) {
  values_.set(key, text, where);
  given_.insert_or_assign(std::string(key), Given{std::string(text), where});
}

bool used(std::span<const Use> uses, std::string_view word, std::string_view key) {
  bool named = false;
  for (const Use& use : uses) {
    if (!names(use, key)) continue;
    if (use.word == word) return true;
    named = true;
  }
  return !named;
}

void Table::refuse_unused(std::string_view choice, std::span<const Use> uses) const {
  const std::string_view word = values_.word(choice);
  for (const auto& [key, value] : given_) {
    if (used(uses, word, key)) continue;
    std::vector<std::string_view> of;
    for (const Use& use : uses) {
      if (names(use, key)) of.push_back(use.word);
    }
    throw InputError(
        fmt::format("{} does nothing with {} = \"{}\"", key, choice, word), value.place,
        fmt::format("leave it out, or choose {} = {}", choice, fmt::join(of, " or ")));
  }
}

std::vector<std::string> names_of(std::string_view list) {
  std::vector<std::string> all;
  while (!list.empty()) {
    const std::size_t comma = list.find(',');
    all.emplace_back(list.substr(0, comma));
    list = comma == list.npos ? "" : list.substr(comma + 1);
  }
  return all;
}

}  // namespace tress::simulation
