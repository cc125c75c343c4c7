#include "simulation/files/toml_text.h"

#include <fmt/format.h>

#include <algorithm>
#include <vector>

#include "contract/input_error.h"
#include "contract/parameters.h"

namespace tress::simulation {
namespace {

/// toml++ has aborted on NUL bytes in some builds, so they are rejected first.
void refuse_nul_bytes(std::string_view text, const std::string& file) {
  const std::size_t at = text.find('\0');
  if (at == std::string_view::npos) return;
  int row = 1, column = 1;
  for (const char c : text.substr(0, at)) {
    column = c == '\n' ? 1 : column + 1;
    row += c == '\n' ? 1 : 0;
  }
  throw InputError("NUL byte in a scene file", fmt::format("{}:{}:{}", file, row, column),
                   "scene files are plain text");
}

constexpr int most_levels = 100;

/// Distinguishes keys, values, strings and comments of TOML, and counts levels.
class Levels {
 public:
  Levels(std::string_view text, const std::string& file) : text_(text), file_(file) {}

  void check() {
    while (at_ < text_.size()) {
      switch (text_[at_]) {
        case '"':
        case '\'':
          skip_string();
          continue;
        case '#':
          at_ = std::min(text_.find('\n', at_), text_.size());
          continue;
        default:
          read(text_[at_++]);
      }
    }
  }

 private:
  struct Bracket {
    char opened;
    int dots;  // of the key whose value it opens
  };

  void read(char c) {
    if (c == '\n' && open_.empty()) begin_key();
    if (c == '=' && in_key_) {
      in_key_ = false;
    } else if (c == '.' && in_key_) {
      ++dots_;
      ++levels_;
    } else if (c == '[' || c == '{') {
      // Brackets before a key belong to a header, which counts its dots itself.
      if (!in_key_) open(c);
    } else if ((c == ']' || c == '}') && !open_.empty()) {
      close();
    } else if (c == ',' && !open_.empty() && open_.back().opened == '{') {
      begin_key();
    }
    if (levels_ > most_levels) refuse();
  }

  void begin_key() {
    levels_ -= dots_;
    dots_ = 0;
    in_key_ = true;
  }

  void open(char c) {
    open_.push_back({c, dots_});
    dots_ = 0;
    ++levels_;
    in_key_ = c == '{';
  }

  void close() {
    levels_ -= 1 + dots_;
    dots_ = open_.back().dots;
    open_.pop_back();
    in_key_ = false;
  }

  void skip_string() {
    const char quote = text_[at_];
    const std::string three(3, quote);
    const bool long_one = text_.substr(at_).starts_with(three);
    const std::string_view end =
        long_one ? std::string_view(three) : text_.substr(at_, 1);
    at_ += end.size();
    while (at_ < text_.size() && !text_.substr(at_).starts_with(end)) {
      if (!long_one && text_[at_] == '\n') return;  // never closed
      const bool escaped = quote == '"' && text_[at_] == '\\';
      at_ += escaped ? 2 : 1;
    }
    at_ = std::min(at_ + end.size(), text_.size());
    // A long string may end with up to two quotes of its own.
    for (int i = 0; long_one && i < 2 && text_.substr(at_).starts_with(quote); ++i) ++at_;
  }

  [[noreturn]] void refuse() const {
    const std::string_view before = text_.substr(0, at_ - 1);
    const auto line = std::count(before.begin(), before.end(), '\n') + 1;
    const std::size_t column = before.size() - (before.rfind('\n') + 1) + 1;
    throw InputError(fmt::format("more than {} levels of keys and brackets", most_levels),
                     fmt::format("{}:{}:{}", file_, line, column),
                     "nest less deeply: nothing here needs more than five");
  }

  std::string_view text_;
  const std::string& file_;
  std::size_t at_ = 0;
  bool in_key_ = true;  // else in a value
  int dots_ = 0;        // of the current key
  int levels_ = 0;      // of all that is open, and of the current key
  std::vector<Bracket> open_;
};

/// Throws InputError with file:line:column where a value of `text` lies more than 100
/// levels deep. toml++ and the readers of its tables recurse once per level. Dotted keys,
/// which toml++ does not limit, would overflow the stack. Levels are dots of keys and of
/// headers, and brackets around values. In malformed TOML the check covers the text up to
/// the first error, where toml++ stops.
void refuse_deep(std::string_view text, const std::string& file) {
  Levels(text, file).check();
}

}  // namespace

std::string place_of(const toml::source_region& source, const std::string& file) {
  return fmt::format("{}:{}:{}", file, source.begin.line, source.begin.column);
}

std::string place_of_key(const toml::table& root, std::string_view key,
                         const std::string& file) {
  while (!key.empty()) {
    const auto found = root.at_path(key);
    if (found) return place_of(found.node()->source(), file);
    const std::size_t dot = key.rfind('.');
    key = key.substr(0, dot == key.npos ? 0 : dot);
  }
  return file;
}

toml::table parse_toml(const std::string& text, const std::string& file) {
  refuse_nul_bytes(text, file);
  refuse_deep(text, file);
  try {
    return toml::parse(text, std::string_view(file));
  } catch (const toml::parse_error& error) {
    throw InputError(std::string(error.description()), place_of(error.source(), file),
                     "correct the TOML there");
  }
}

std::string scalar_text(const toml::node& node) {
  if (const auto* text = node.as_string()) return text->get();
  if (const auto* yes = node.as_boolean()) return yes->get() ? "true" : "false";
  if (const auto* whole = node.as_integer()) return std::to_string(whole->get());
  if (const auto* real = node.as_floating_point()) return number_text(real->get());
  return {};
}

}  // namespace tress::simulation
