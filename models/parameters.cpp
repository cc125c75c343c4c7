#include "models/parameters.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "models/input_error.h"

namespace tress {
namespace {

std::string join(std::span<const std::string_view> words) {
  std::string text;
  for (const std::string_view word : words) {
    if (!text.empty()) text += ", ";
    text += word;
  }
  return text;
}

std::string shortest(double x) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, x);
  return std::string(buffer, end.ptr);
}

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  for (std::size_t j = 0; j <= b.size(); ++j) row[j] = j;
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = row[0];
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replace = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = row[j];
      row[j] = std::min({replace, row[j] + 1, row[j - 1] + 1});
    }
  }
  return row[b.size()];
}

double parse_number(const Parameter& declared, std::string_view text,
                    const std::string& where) {
  double x = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
  const std::string name(declared.name);
  if (error != std::errc{} || end != text.data() + text.size() || !std::isfinite(x)) {
    throw InputError(name + " = '" + std::string(text) + "' is not a finite number",
                     where, "give a number: " + std::string(declared.help));
  }
  if (x < declared.min || x > declared.max) {
    throw InputError(name + " = " + std::string(text) + " is out of range", where,
                     "give a number between " + shortest(declared.min) + " and " +
                         shortest(declared.max));
  }
  if (declared.whole && x != std::floor(x)) {
    throw InputError(name + " = " + std::string(text) + " is not a whole number", where,
                     "give a whole number: " + std::string(declared.help));
  }
  return x;
}

}  // namespace

std::vector<std::string_view> words_of(std::string_view choices) {
  std::vector<std::string_view> words;
  while (!choices.empty()) {
    const std::size_t bar = choices.find('|');
    words.push_back(choices.substr(0, bar));
    choices =
        bar == std::string_view::npos ? std::string_view{} : choices.substr(bar + 1);
  }
  return words;
}

std::string_view nearest(std::string_view word,
                         std::span<const std::string_view> candidates) {
  std::string_view best;
  std::size_t least = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string_view candidate : candidates) {
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

Parameters::Parameters(std::span<const Parameter> declared, std::string where)
    : declared_(declared), where_(std::move(where)) {
  for (const Parameter& p : declared_) {
    const std::string_view first = p.choices.substr(0, p.choices.find('|'));
    values_.push_back({p.number, std::string(first)});
  }
}

bool Parameters::knows(std::string_view key) const {
  return std::any_of(declared_.begin(), declared_.end(),
                     [key](const Parameter& p) { return p.name == key; });
}

std::size_t Parameters::index(std::string_view key) const {
  for (std::size_t i = 0; i < declared_.size(); ++i) {
    if (declared_[i].name == key) return i;
  }
  std::vector<std::string_view> names;
  for (const Parameter& p : declared_) names.push_back(p.name);
  const std::string_view near = nearest(key, names);
  throw InputError("unknown key '" + std::string(key) + "'", where_,
                   near.empty() ? "use one of: " + join(names)
                                : "did you mean '" + std::string(near) + "'?");
}

void Parameters::set(std::string_view key, std::string_view value) {
  const std::size_t i = index(key);
  const Parameter& declared = declared_[i];
  if (declared.choices.empty()) {
    values_[i].number = parse_number(declared, value, where_);
    return;
  }
  const auto words = words_of(declared.choices);
  if (std::find(words.begin(), words.end(), value) == words.end()) {
    throw InputError(std::string(key) + " = '" + std::string(value) + "' is unknown",
                     where_, "use one of: " + join(words));
  }
  values_[i].word = value;
}

double Parameters::number(std::string_view key) const {
  return values_[index(key)].number;
}

int Parameters::whole(std::string_view key) const {
  return static_cast<int>(values_[index(key)].number);
}

std::string_view Parameters::word(std::string_view key) const {
  return values_[index(key)].word;
}

}  // namespace tress
