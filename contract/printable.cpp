#include "contract/printable.h"

namespace tress {
namespace {

bool continues(char c) { return (static_cast<unsigned char>(c) & 0xc0U) == 0x80; }

/// Bytes of the printable character that `text` begins with; 0: it begins with none.
std::size_t character(std::string_view text) {
  const auto byte = [text](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char first = byte(0);
  if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
  const std::size_t length = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
  if (first < 0xc2 || first > 0xf4 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i) {
    if (!continues(text[i])) return 0;
  }
  const unsigned char second = byte(1);
  if (first == 0xc2 && second < 0xa0) return 0;   // control characters
  if (first == 0xe0 && second < 0xa0) return 0;   // longer than need be
  if (first == 0xed && second >= 0xa0) return 0;  // half a pair of UTF-16
  if (first == 0xf0 && second < 0x90) return 0;
  if (first == 0xf4 && second >= 0x90) return 0;  // beyond U+10FFFF
  return length;
}

}  // namespace

std::string printable(std::string_view text) {
  constexpr char digits[] = "0123456789abcdef";
  std::string line;
  line.reserve(text.size());
  while (!text.empty()) {
    const char c = text.front();
    std::size_t taken = character(text);
    if (taken > 0) {
      line += text.substr(0, taken);
    } else {
      taken = 1;
      const auto byte = static_cast<unsigned char>(c);
      if (c == '\t' || c == '\n' || c == '\r') {
        line += ' ';
      } else {
        line.append("\\x") += digits[byte >> 4U];
        line += digits[byte & 15U];
      }
    }
    text.remove_prefix(taken);
  }
  return line;
}

std::string shortened(std::string_view text, std::size_t longest) {
  constexpr std::string_view gap = " ... ";
  std::string line = printable(text);
  if (line.size() <= longest) return line;
  std::size_t head = (longest - gap.size()) / 2, tail = line.size() - head;
  while (head > 0 && continues(line[head])) --head;
  while (tail < line.size() && continues(line[tail])) ++tail;
  return line.substr(0, head).append(gap) += line.substr(tail);
}

}  // namespace tress
