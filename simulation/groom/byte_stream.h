#pragma once

#include <bit>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "contract/layers.h"
#include "simulation/files/files.h"

namespace tress::simulation {

/// Reads a file once, through a buffer of fixed size, and knows where it is. Numbers are
/// little endian, as on all machines that tress runs on.
class ByteStream {
 public:
  /// Throws InputError unless it is a regular file that can be read.
  explicit ByteStream(std::string file);

  /// Returns the name of the file.
  const std::string& file() const { return file_; }
  /// Returns the size of the file, bytes.
  std::uint64_t size() const { return size_; }
  /// Returns the place of the next byte.
  std::uint64_t at() const { return base_ + next_; }
  /// Returns the number of bytes to the end.
  std::uint64_t left() const { return size_ - at(); }
  int line() const { return line_; }  // from 1, as far as read by get()
  /// Continues at this byte.
  void seek(std::uint64_t to);

  /// The next byte, -1 at the end.
  int get() {
    const int c = peek();
    if (c >= 0) ++next_;
    if (c == '\n') ++line_;
    return c;
  }
  /// Returns the next byte without taking it, -1 at the end.
  int peek() {
    if (next_ == end_ && !fill()) return -1;
    return static_cast<unsigned char>(buffer_[next_]);
  }
  /// Throws InputError where the file ends before.
  void take(void* to, std::size_t bytes);
  /// Reads a number as it lies in memory.
  template <class T>
  T number() {
    T x;
    take(&x, sizeof x);
    return x;
  }
  /// Throws InputError with `what` unless `count` items of `each` bytes are left.
  void require(std::uint64_t count, std::uint64_t each, const std::string& what) const;

  /// Skips blanks, tabs and ends of lines.
  void skip_blanks();
  /// A number in decimal digits, nan or inf; InputError if there is none. Any number of
  /// digits; 0 below the least double, infinite beyond the largest.
  double decimal();
  /// Reads a whole number in decimal digits. Throws InputError if there is none.
  std::uint64_t whole();
  /// The rest of the line, without its end; InputError beyond 4096 bytes.
  std::string text_line();

  /// "file:line" or "file: byte n".
  std::string text_place() const;
  /// Returns "file: byte n".
  std::string byte_place() const;
  /// Throws InputError naming the line.
  [[noreturn]] void refuse_text(const std::string& problem, const std::string& remedy);
  /// Throws InputError naming the byte.
  [[noreturn]] void refuse(const std::string& problem, const std::string& remedy) const;

 private:
  bool fill();
  /// Returns the next characters that may form a number; valid until the next call.
  std::string_view digits();

  std::string file_;
  File input_;
  std::uint64_t size_ = 0, base_ = 0;
  std::vector<char> buffer_;
  std::string number_;  // one that the buffer does not have whole
  std::size_t next_ = 0, end_ = 0;
  int line_ = 1;
};

}  // namespace tress::simulation
