#include "simulation/export/head_state.h"

#include <cstring>
#include <stdexcept>

#include "contract/input_error.h"

namespace tress::simulation {
namespace {

constexpr const char* begin_again = "leave out --resume to begin again";

}  // namespace

SavedHead::SavedHead(const std::string& file, const RunKey& key, std::size_t strands,
                     std::size_t kept, const HeadProgress& progress)
    : replacement_(file) {
  replacement_.write(seal());
  put_bytes(key.line() + '\n');
  const FileState& frames = progress.frames;
  put_numbers(std::vector<std::uint64_t>{strands, kept, progress.step,
                                         progress.sums.size(), progress.lost.size(),
                                         frames.ranges.size(), frames.bytes.size()});
  put_numbers(progress.sums);
  std::vector<std::uint64_t> which;
  std::vector<double> when;
  std::vector<std::uint64_t> sizes;
  std::string reasons;
  for (const FailedStrand& lost : progress.lost) {
    which.push_back(lost.strand);
    when.push_back(lost.t);
    sizes.push_back(lost.reason.size());
    reasons += lost.reason;
  }
  put_numbers(which);
  put_numbers(when);
  put_numbers(sizes);
  put_bytes(reasons);
  put_numbers(std::vector{frames.length});
  put_numbers(frames.ranges);
  put_bytes(frames.bytes);
}

void SavedHead::put(const std::vector<double>& kept) { put_numbers(kept); }

void SavedHead::finish() {
  replacement_.write_over(seal());
  replacement_.keep();
}

template <class T>
void SavedHead::put_numbers(const std::vector<T>& x) {
  put_bytes(
      std::string_view(reinterpret_cast<const char*>(x.data()), sizeof(T) * x.size()));
}

void SavedHead::put_bytes(std::string_view bytes) {
  sum_.add(bytes);
  replacement_.write(bytes);
}

HeadToResume::HeadToResume(const std::string& file, const RunKey& key,
                           std::size_t strands, std::size_t kept)
    : kept_(kept) {
  try {
    text_ = read_file(file);
    parse(key, file, strands);
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw InputError(std::string("the saved state is damaged: ") + error.what(), file,
                     begin_again);
  }
}

void HeadToResume::parse(const RunKey& key, const std::string& file,
                         std::size_t strands) {
  rest_ = unsealed(text_);
  const std::string_view first = rest_.substr(0, rest_.find('\n'));
  key.check(first, file);
  rest_.remove_prefix(first.size() + 1);
  const auto sizes = numbers<std::uint64_t>(7);
  if (sizes[0] != strands || sizes[1] != kept_) {
    throw InputError("the saved state is of other strands", file, begin_again);
  }
  progress_.step = sizes[2];
  progress_.sums = numbers<std::uint64_t>(sizes[3]);
  const auto which = numbers<std::uint64_t>(sizes[4]);
  const auto when = numbers<double>(sizes[4]);
  const auto lengths = numbers<std::uint64_t>(sizes[4]);
  for (std::size_t i = 0; i < which.size(); ++i) {
    const auto reason = numbers<char>(lengths[i]);
    progress_.lost.push_back({which[i], when[i], {reason.begin(), reason.end()}});
  }
  progress_.frames.length = numbers<std::uint64_t>(1).front();
  progress_.frames.ranges = numbers<FileRange>(sizes[5]);
  const auto bytes = numbers<char>(sizes[6]);
  progress_.frames.bytes.assign(bytes.begin(), bytes.end());
  if (rest_.size() / sizeof(double) < kept_ * strands) {
    throw std::runtime_error("it ends too early");
  }
}

std::vector<double> HeadToResume::take(std::size_t strands) {
  return numbers<double>(kept_ * strands);
}

template <class T>
std::vector<T> HeadToResume::numbers(std::size_t count) {
  if (count > rest_.size() / sizeof(T)) throw std::runtime_error("it ends too early");
  std::vector<T> x(count);
  if (count > 0) std::memcpy(x.data(), rest_.data(), sizeof(T) * count);
  rest_.remove_prefix(sizeof(T) * count);
  return x;
}

}  // namespace tress::simulation
