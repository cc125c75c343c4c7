#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstring>
#include <string>
#include <string_view>

namespace tress::models {

/// The bytes of a mesh file, read one after the other, never beyond their end.
class MeshText {
 public:
  /// Begins at the first byte. `bytes` must outlive it.
  MeshText(std::string file, std::string_view bytes)
      : file_(std::move(file)), bytes_(bytes) {}

  /// Returns true if no byte is left.
  bool ended() const { return at_ == bytes_.size(); }
  /// Returns the number of bytes left.
  std::size_t left() const { return bytes_.size() - at_; }
  /// Takes the rest of the line, without its end.
  std::string_view line();
  /// Takes the next word of text; none is left: empty.
  std::string_view word();
  /// Takes a finite number of text. Throws InputError where there is none.
  double number();
  /// Takes a binary number of type T. Throws InputError at the end. `big`: bytes in
  /// big-endian order.
  template <class T>
  T binary(bool big) {
    start_ = at_;
    if (left() < sizeof(T)) refuse("the file ends inside a number");
    std::array<char, sizeof(T)> raw;
    bytes_.copy(raw.data(), sizeof(T), at_);
    at_ += sizeof(T);
    if (big == (std::endian::native == std::endian::little)) reverse(raw);
    T value;
    std::memcpy(&value, raw.data(), sizeof value);
    return value;
  }
  /// Throws InputError with the file and the line or byte of what was taken last.
  [[noreturn]] void refuse(const std::string& problem) const;
  /// Makes places bytes instead of lines: what follows is binary.
  void turn_binary() { binary_ = true; }

 private:
  template <std::size_t n>
  static void reverse(std::array<char, n>& raw) {
    for (std::size_t i = 0; i < n / 2; ++i) std::swap(raw[i], raw[n - 1 - i]);
  }

  std::string file_;
  std::string_view bytes_;
  std::size_t at_ = 0, start_ = 0;  // next byte, and first one of what was taken last
  bool binary_ = false;
};

/// Takes the first word of a line; none is left: empty.
std::string_view first_word(std::string_view& line);

}  // namespace tress::models
