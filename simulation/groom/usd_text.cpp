#include "simulation/groom/usd_text.h"

#include <fmt/format.h>

namespace tress::simulation {
namespace {

constexpr std::string_view usd_remedy = "mend the text there, or write the file again";
constexpr std::size_t longest_word = 1000;

bool of_word(int c) {
  return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
         c == '_' || c == ':' || c == '.' || c == '-' || c == '+' || c == '!' ||
         c >= 0x80;  // of UTF-8
}

}  // namespace

int UsdText::next() {
  while (true) {
    from_.skip_blanks();
    if (from_.peek() != '#') return from_.peek();
    while (from_.peek() >= 0 && from_.peek() != '\n') from_.get();
  }
}

void UsdText::expect(char c) {
  const int found = next();
  if (found == c) {
    from_.get();
    return;
  }
  const std::string shown = found >= ' ' && found < 127
                                ? fmt::format("'{}'", static_cast<char>(found))
                            : found < 0 ? std::string("the end of the file")
                                        : fmt::format("byte {}", found);
  from_.refuse_text(fmt::format("{} where '{}' belongs", shown, c),
                    std::string(usd_remedy));
}

std::string UsdText::word() {
  next();
  std::string text;
  while (of_word(from_.peek())) {
    if (text.size() == longest_word) {
      from_.refuse_text("a name without end", std::string(usd_remedy));
    }
    text += static_cast<char>(from_.get());
  }
  if (!text.empty() && from_.peek() == '[') {
    from_.get();
    expect(']');
    text += "[]";
  }
  return text;
}

std::string UsdText::quoted() {
  const int quote = next();
  if (quote != '"' && quote != '\'') {
    from_.refuse_text("no quoted text", std::string(usd_remedy));
  }
  int marks = 0;  // one, or three around a text of several lines; two are an empty text
  while (marks < 3 && from_.peek() == quote) {
    from_.get();
    ++marks;
  }
  std::string text;
  if (marks == 2) return text;
  for (int closing = 0; closing < marks;) {
    int c = from_.get();
    closing = c == quote ? closing + 1 : 0;
    if (c == '\\') c = from_.get();
    if (c < 0)
      from_.refuse_text("a text without its closing quote", std::string(usd_remedy));
    if (text.size() < longest_word) text += static_cast<char>(c);
  }
  text.resize(text.size() < longest_word ? text.size() - static_cast<std::size_t>(marks)
                                         : longest_word);
  return text;
}

void UsdText::skip_balanced() {
  int depth = 0;
  do {
    const int c = next();
    if (c < 0) from_.refuse_text("a bracket that is not closed", std::string(usd_remedy));
    if (c == '"' || c == '\'') {
      quoted();
      continue;
    }
    if (c == '@') {
      skip_asset();
      continue;
    }
    from_.get();
    if (c == '(' || c == '[' || c == '{') ++depth;
    if (c == ')' || c == ']' || c == '}') --depth;
  } while (depth > 0);
}

void UsdText::skip_asset() {
  const auto skip_marks = [this](int most) {
    int marks = 0;
    for (; marks < most && from_.peek() == '@'; ++marks) from_.get();
    return marks;
  };
  const int opened = skip_marks(3);
  if (opened == 2) return;  // an empty one
  for (int closed = 0; closed < opened; closed = skip_marks(opened)) {
    while (from_.peek() >= 0 && from_.peek() != '@') from_.get();
    if (from_.peek() < 0) {
      from_.refuse_text("an asset without its closing @", std::string(usd_remedy));
    }
  }
}

void UsdText::skip_path() {
  expect('<');
  while (from_.peek() >= 0 && from_.peek() != '>') from_.get();
  expect('>');
}

void UsdText::skip_value() {
  const int c = next();
  if (c == '"' || c == '\'') {
    quoted();
  } else if (c == '(' || c == '[' || c == '{') {
    skip_balanced();
  } else if (c == '@') {
    skip_asset();
    if (next() == '<') skip_path();  // within the asset
  } else if (c == '<') {
    skip_path();
  } else if (word().empty()) {
    from_.refuse_text("no value", std::string(usd_remedy));
  }
}

std::vector<double> UsdText::numbers() {
  std::vector<double> all;
  int depth = 0;
  do {
    const int c = next();
    if (c < 0) from_.refuse_text("a bracket that is not closed", std::string(usd_remedy));
    const bool opens = c == '(' || c == '[' || c == '{';
    const bool closes = c == ')' || c == ']' || c == '}';
    if (opens) ++depth;
    if (closes) --depth;
    if (opens || closes || c == ',' || c == ':') {
      from_.get();
    } else {
      constexpr std::size_t most = 1000;
      const double x = from_.decimal();
      if (all.size() < most) all.push_back(x);
    }
  } while (depth > 0);
  return all;
}

}  // namespace tress::simulation
