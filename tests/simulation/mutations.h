#pragma once

#include <cstdint>
#include <random>
#include <string>
#include <string_view>
#include <vector>

namespace tress::testing_support {

/// Spoils the text of a scene in one of many ways, the same for the same numbers.
class Mutations {
 public:
  explicit Mutations(std::uint64_t seed) : bits_(seed) {}

  /// Below n, n > 0.
  std::size_t pick(std::size_t n) { return static_cast<std::size_t>(bits_() % n); }

  std::string spoilt(std::string text) {
    switch (pick(8)) {
      case 0:
        return without_some(std::move(text));
      case 1:
        return with_characters(std::move(text));
      case 2:
        return swapped(std::move(text));
      case 3:
        return with_another_word(std::move(text));
      case 4:
        return with_a_line_again(std::move(text));
      case 5:
        return without_a_line(std::move(text));
      case 6:
        return misspelt(std::move(text));
      default:
        return with_another_value(std::move(text));
    }
  }

 private:
  struct Span {
    std::size_t from, length;
  };

  static bool in_word(char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           c == '_' || c == '.' || c == '-';
  }

  /// A word of the text outside of comments, as far as there are any.
  Span word(const std::string& text) {
    std::vector<Span> words;
    bool comment = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '#') comment = true;
      if (text[i] == '\n') comment = false;
      const bool starts = in_word(text[i]) && (i == 0 || !in_word(text[i - 1]));
      if (comment || !starts) continue;
      std::size_t length = 0;
      while (i + length < text.size() && in_word(text[i + length])) ++length;
      words.push_back({i, length});
    }
    return words.empty() ? Span{0, 0} : words[pick(words.size())];
  }

  Span line(const std::string& text) {
    if (text.empty()) return {0, 0};
    const std::size_t at = pick(text.size());
    const std::size_t before = text.rfind('\n', at == 0 ? 0 : at - 1);
    const std::size_t from = before == std::string::npos ? 0 : before + 1;
    const std::size_t end = text.find('\n', from);
    const std::size_t to = end == std::string::npos ? text.size() : end + 1;
    return {from, to - from};
  }

  std::string without_some(std::string text) {
    if (text.empty()) return text;
    return text.erase(pick(text.size()), 1 + pick(4));
  }

  std::string with_characters(std::string text) {
    // A zero among them: its length comes from the array.
    static constexpr char some[] = "\"'[]{}=,.#-+\n\\\0\x01\xff\xc3 0e_";
    const std::size_t at = pick(text.size() + 1);
    for (std::size_t i = 0, n = 1 + pick(3); i < n; ++i) {
      text.insert(text.begin() + static_cast<std::ptrdiff_t>(at),
                  some[pick(sizeof some - 1)]);
    }
    return text;
  }

  std::string swapped(std::string text) {
    if (text.size() < 2) return text;
    const std::size_t i = pick(text.size() - 1);
    std::swap(text[i], text[i + 1]);
    return text;
  }

  std::string with_another_word(std::string text) {
    const Span from = word(text), to = word(text);
    return text.replace(to.from, to.length, text.substr(from.from, from.length));
  }

  std::string with_a_line_again(std::string text) {
    const Span one = line(text);
    return text.insert(line(text).from, text.substr(one.from, one.length));
  }

  std::string without_a_line(std::string text) {
    const Span one = line(text);
    return text.erase(one.from, one.length);
  }

  std::string misspelt(std::string text) {
    const Span one = word(text);
    if (one.length == 0) return text;
    text[one.from + pick(one.length)] = static_cast<char>('a' + pick(26));
    return text;
  }

  std::string with_another_value(std::string text) {
    constexpr std::string_view values[] = {"nan",          "inf",
                                           "-inf",         "1e999",
                                           "-1",           "0",
                                           "1e300",        "-1e-300",
                                           "99999999",     "9223372036854775808",
                                           "true",         "\"\"",
                                           "\"nonsense\"", "[]",
                                           "[1, 2]",       "[[1, 2, 3], [4]]",
                                           "[nan, 0, 0]",  "[0, 0, 0]",
                                           "{}",           "{ x = 1 }",
                                           "1979-05-27",   "0x7fffffff",
                                           "1_000_000",    "\"\\n\"",
                                           "[[[]]]"};
    const Span one = line(text);
    const std::size_t equals = text.find('=', one.from);
    if (equals >= one.from + one.length) return text;
    const std::size_t end = one.from + one.length - (text.back() == '\n' ? 1 : 0);
    return text.replace(equals + 1, end - equals - 1, values[pick(std::size(values))]);
  }

  std::mt19937_64 bits_;
};

}  // namespace tress::testing_support
