#include "simulation/groom/byte_stream.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cstring>
#include <filesystem>

#include "contract/decimal.h"
#include "contract/input_error.h"

namespace tress::simulation {
namespace {

constexpr std::size_t buffer_bytes = 1 << 18;
constexpr std::string_view damaged = "the file is cut short or damaged: write it again";

const std::string& regular(const std::string& file) {
  std::error_code error;
  if (std::filesystem::is_regular_file(file, error)) return file;
  throw InputError("there is no such file", file, "name a file with strands");
}

bool blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

}  // namespace

ByteStream::ByteStream(std::string file)
    : file_(std::move(file)),
      input_(regular(file_), O_RDONLY),
      size_(std::filesystem::file_size(file_)),
      buffer_(buffer_bytes) {}

bool ByteStream::fill() {
  base_ += end_;
  next_ = end_ = 0;
  const std::uint64_t wanted = std::min<std::uint64_t>(buffer_.size(), size_ - base_);
  while (wanted > 0) {
    const ssize_t got =
        ::pread(input_.descriptor(), buffer_.data(), wanted, static_cast<off_t>(base_));
    if (got < 0 && errno == EINTR) continue;
    if (got <= 0) refuse("the file cannot be read", "see to the disk, then try again");
    end_ = static_cast<std::size_t>(got);
    break;
  }
  return end_ > 0;
}

void ByteStream::seek(std::uint64_t to) {
  if (to > size_) {
    throw InputError(fmt::format("data at byte {} of {}", to, size_), file_,
                     std::string(damaged));
  }
  if (to >= base_ && to <= base_ + end_) {
    next_ = static_cast<std::size_t>(to - base_);
    return;
  }
  base_ = to;
  next_ = end_ = 0;
}

void ByteStream::take(void* to, std::size_t bytes) {
  auto* out = static_cast<char*>(to);
  while (bytes > 0) {
    if (next_ == end_ && !fill()) refuse("the file ends here", std::string(damaged));
    const std::size_t now = std::min(bytes, end_ - next_);
    std::memcpy(out, &buffer_[next_], now);
    next_ += now;
    out += now;
    bytes -= now;
  }
}

void ByteStream::require(std::uint64_t count, std::uint64_t each,
                         const std::string& what) const {
  if (count <= left() / each) return;
  refuse(fmt::format("{} {} where {} bytes are left", count, what, left()),
         std::string(damaged));
}

void ByteStream::skip_blanks() {
  while (true) {
    for (; next_ < end_; ++next_) {
      if (!blank(buffer_[next_])) return;
      if (buffer_[next_] == '\n') ++line_;
    }
    if (!fill()) return;
  }
}

std::string_view ByteStream::digits() {
  skip_blanks();
  const auto part = [](char c) {
    return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') ||
           c == '.' || c == '-' || c == '+';
  };
  number_.clear();
  while (true) {
    const std::size_t from = next_;
    while (next_ < end_ && part(buffer_[next_])) ++next_;
    const std::string_view read(buffer_.data() + from, next_ - from);
    if (next_ < end_ && number_.empty()) return read;
    number_ += read;
    if (next_ < end_ || !fill()) return number_;
  }
}

double ByteStream::decimal() {
  const std::string_view text = digits();
  const auto x = tress::decimal(text.starts_with('+') ? text.substr(1) : text);
  if (x) return *x;
  refuse_text(text.empty() ? std::string("there is no number")
                           : fmt::format("'{}' is no number", text),
              "write it again, or mend it there");
}

std::uint64_t ByteStream::whole() {
  const std::string_view text = digits();
  std::uint64_t x = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
  if (!text.empty() && end == text.data() + text.size() && error == std::errc{}) return x;
  refuse_text(text.empty() ? std::string("there is no whole number")
                           : fmt::format("'{}' is no whole number", text),
              "write it again, or mend it there");
}

std::string ByteStream::text_line() {
  std::string text;
  constexpr std::size_t longest = 4096;
  for (int c = get(); c >= 0 && c != '\n'; c = get()) {
    if (text.size() == longest) refuse_text("a line of more than 4096 bytes", "");
    text += static_cast<char>(c);
  }
  if (!text.empty() && text.back() == '\r') text.pop_back();
  return text;
}

std::string ByteStream::text_place() const { return fmt::format("{}:{}", file_, line_); }
std::string ByteStream::byte_place() const {
  return fmt::format("{}: byte {}", file_, at());
}
void ByteStream::refuse_text(const std::string& problem, const std::string& remedy) {
  throw InputError(problem, text_place(), remedy.empty() ? std::string(damaged) : remedy);
}
void ByteStream::refuse(const std::string& problem, const std::string& remedy) const {
  throw InputError(problem, byte_place(), remedy.empty() ? std::string(damaged) : remedy);
}

}  // namespace tress::simulation
