#include "contract/parameters.h"

#include <algorithm>
#include <charconv>
#include <cmath>

#include "contract/decimal.h"
#include "contract/input_error.h"
#include "contract/renamed.h"

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

/// `name`: of the number in messages.
double parse_number(const Parameter& declared, const std::string& name,
                    std::string_view text, const std::string& where) {
  while (text.starts_with(' ')) text.remove_prefix(1);
  while (text.ends_with(' ')) text.remove_suffix(1);
  const double x = decimal(text).value_or(std::nan(""));
  if (!std::isfinite(x)) {
    throw InputError(name + " = '" + std::string(text) + "' is not a finite number",
                     where, "give a number: " + std::string(declared.help));
  }
  if (x < declared.min || x > declared.max) {
    throw InputError(name + " = " + std::string(text) + " is out of range", where,
                     "give a number between " + number_text(declared.min) + " and " +
                         number_text(declared.max) + ": " + std::string(declared.help));
  }
  // From 2^53 on, other whole numbers may have been rounded to this one.
  constexpr double first_rounded = 9007199254740992;
  if (declared.whole && !(std::abs(x) < first_rounded)) {
    throw InputError(name + " = " + std::string(text) + " is too large", where,
                     "give a whole number of at most " + number_text(first_rounded - 1) +
                         ": " + std::string(declared.help));
  }
  if (declared.whole && x != std::floor(x)) {
    throw InputError(name + " = " + std::string(text) + " is not a whole number", where,
                     "give a whole number: " + std::string(declared.help));
  }
  return x;
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (std::size_t end = 0; end != std::string_view::npos;) {
    end = text.find(separator);
    parts.push_back(text.substr(0, end));
    if (end != std::string_view::npos) text.remove_prefix(end + 1);
  }
  return parts;
}

std::vector<double> parse_numbers(const Parameter& declared, std::string_view text,
                                  const std::string& where) {
  std::vector<double> all;
  if (declared.rows && text.empty()) return all;
  const auto rows = declared.rows ? split(text, ';') : std::vector{text};
  std::size_t count = 0;
  for (const std::string_view row : rows) {
    const std::string name =
        (declared.rows ? "row " + std::to_string(++count) + " of " : "") +
        std::string(declared.name);
    const auto parts = declared.components > 1 ? split(row, ',') : std::vector{row};
    if (parts.size() != static_cast<std::size_t>(declared.components)) {
      throw InputError(name + " has " + std::to_string(parts.size()) +
                           " numbers instead of " + std::to_string(declared.components),
                       where, "give " + std::string(declared.help));
    }
    for (const std::string_view part : parts) {
      all.push_back(parse_number(declared, name, part, where));
    }
  }
  return all;
}

}  // namespace

std::string number_text(double x) {
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, x);
  return std::string(buffer, end.ptr);
}

std::vector<std::string_view> words_of(std::string_view choices) {
  return choices.empty() ? std::vector<std::string_view>{} : split(choices, '|');
}

std::string_view nearest(std::string_view word,
                         std::span<const std::string_view> candidates) {
  std::string_view best;
  std::size_t least = std::max<std::size_t>(2, word.size() / 3) + 1;
  for (const std::string_view candidate : candidates) {
    if (word.size() >= candidate.size() + least) continue;  // at least that distance
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < least) {
      least = distance;
      best = candidate;
    }
  }
  return best;
}

std::string suggestion(std::string_view word,
                       std::span<const std::string_view> candidates,
                       const std::string& otherwise) {
  for (const std::string_view now : candidates) {
    if (renamed(word, now)) return "it is called '" + std::string(now) + "' now";
  }
  std::string present;
  for (const auto& [before, now] : renamed_names) {
    if (before != word) continue;
    present += (present.empty() ? "" : "' or '") + std::string(now);
  }
  if (!present.empty()) {
    return "it is called '" + present + "' now, which is not known here" +
           (otherwise.empty() ? "" : "; " + otherwise);
  }
  const std::string_view near = nearest(word, candidates);
  return near.empty() ? otherwise : "did you mean '" + std::string(near) + "'?";
}

std::string Parameter::default_text() const {
  if (!choices.empty()) return std::string(choices.substr(0, choices.find('|')));
  if (text || rows || components > 1) return std::string(fallback);
  return number_text(number);
}

Parameters::Parameters(std::span<const Parameter> declared, std::string where)
    : declared_(declared), values_(declared.size()), where_(std::move(where)) {
  for (std::size_t i = 0; i < declared.size(); ++i) {
    const Parameter& p = declared[i];
    if (p.text || !p.choices.empty()) {
      values_[i].word = p.default_text();
    } else if (p.rows || p.components > 1) {
      values_[i].numbers = parse_numbers(p, p.fallback, where_);
    } else {
      values_[i].numbers = {p.number};
    }
  }
}

bool Parameters::knows(std::string_view key) const {
  return std::any_of(declared_.begin(), declared_.end(),
                     [key](const Parameter& p) { return p.name == key; });
}

std::size_t Parameters::index(std::string_view key, const std::string& where) const {
  for (std::size_t i = 0; i < declared_.size(); ++i) {
    if (declared_[i].name == key) return i;
  }
  std::vector<std::string_view> names;
  for (const Parameter& p : declared_) names.push_back(p.name);
  throw InputError("unknown key '" + std::string(key) + "'", where,
                   suggestion(key, names, "use one of: " + join(names)));
}

void Parameters::set(std::string_view key, std::string_view value) {
  set(key, value, where_);
}

void Parameters::set(std::string_view key, std::string_view value,
                     const std::string& where) {
  const std::size_t i = index(key, where);
  const Parameter& declared = declared_[i];
  if (!declared.text && declared.choices.empty()) {
    values_[i].numbers = parse_numbers(declared, value, where);
    return;
  }
  const auto words = words_of(declared.choices);
  if (!declared.text && std::find(words.begin(), words.end(), value) == words.end()) {
    const std::string near = suggestion(value, words, "");
    throw InputError(std::string(key) + " = '" + std::string(value) + "' is unknown",
                     where,
                     near +
                         (near.empty()          ? ""
                          : near.ends_with('?') ? " "
                                                : "; ") +
                         "use one of: " + join(words));
  }
  values_[i].word = value;
}

double Parameters::number(std::string_view key) const { return value(key).numbers[0]; }

int Parameters::whole(std::string_view key) const {
  return static_cast<int>(number(key));
}

std::string_view Parameters::word(std::string_view key) const { return value(key).word; }

Vec Parameters::vec(std::string_view key) const {
  return load3(value(key).numbers.data());
}

std::span<const double> Parameters::numbers(std::string_view key) const {
  return value(key).numbers;
}

std::string Parameters::text(std::string_view key) const {
  const std::size_t i = index(key, where_);
  const Parameter& declared = declared_[i];
  if (declared.text || !declared.choices.empty()) return values_[i].word;
  std::string all;
  int before = 0;  // components of the row so far
  for (const double x : values_[i].numbers) {
    if (!all.empty()) all += before == 0 ? ';' : ',';
    all += number_text(x);
    before = (before + 1) % declared.components;
  }
  return all;
}

}  // namespace tress
