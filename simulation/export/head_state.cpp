#include "simulation/export/head_state.h"

#include <cstring>
#include <stdexcept>

#include "contract/input_error.h"
#include "simulation/files/checksum.h"
#include "simulation/files/files.h"

namespace tress::simulation {
namespace {

constexpr const char* begin_again = "leave out --resume to begin again";

/// A sealed text that is written piece by piece.
class SealedFile {
 public:
  explicit SealedFile(const std::string& file) : replacement_(file) {
    replacement_.write(seal());
  }
  void put(std::string_view bytes) {
    sum_.add(bytes);
    replacement_.write(bytes);
  }
  template <class T>
  void put(const std::vector<T>& x) {
    put(std::string_view(reinterpret_cast<const char*>(x.data()), sizeof(T) * x.size()));
  }
  void keep() {
    replacement_.write_over(seal());
    replacement_.keep();
  }

 private:
  std::string seal() const { return sum_.text() + ' '; }

  Replacement replacement_;
  Checksum sum_;
};

class StateReader {
 public:
  explicit StateReader(std::string_view text) : text_(text) {}

  template <class T>
  std::vector<T> take(std::size_t count) {
    if (count > text_.size() / sizeof(T)) throw std::runtime_error("it ends too early");
    std::vector<T> x(count);
    if (count > 0) std::memcpy(x.data(), text_.data(), sizeof(T) * count);
    text_.remove_prefix(sizeof(T) * count);
    return x;
  }

 private:
  std::string_view text_;
};

HeadProgress parse(std::string_view text, const RunKey& key, const std::string& file,
                   models::Head& head) {
  const std::string_view content = unsealed(text);
  const std::string_view first = content.substr(0, content.find('\n'));
  key.check(first, file);
  StateReader bytes(content.substr(first.size() + 1));
  const auto sizes = bytes.take<std::uint64_t>(5);
  if (sizes[0] != head.strands() || sizes[1] != head.kept()) {
    throw InputError("the saved state is of other strands", file, begin_again);
  }
  HeadProgress progress;
  progress.step = sizes[2];
  progress.sums = bytes.take<std::uint64_t>(sizes[3]);
  const auto which = bytes.take<std::uint64_t>(sizes[4]);
  const auto when = bytes.take<double>(sizes[4]);
  const auto fast = bytes.take<char>(sizes[4]);
  for (std::size_t i = 0; i < which.size(); ++i) {
    progress.lost.push_back({which[i], when[i], fast[i] != 0});
  }
  progress.speed = bytes.take<double>(1).front();
  for (std::size_t b = 0; b < head.blocks(); ++b) {
    head.recall(b, bytes.take<double>(head.kept() * head.strands_of(b)));
  }
  return progress;
}

}  // namespace

void save_head(const std::string& file, const RunKey& key, const models::Head& head,
               const HeadProgress& progress) {
  SealedFile out(file);
  out.put(key.line() + '\n');
  out.put(std::vector<std::uint64_t>{head.strands(), head.kept(), progress.step,
                                     progress.sums.size(), progress.lost.size()});
  out.put(progress.sums);
  std::vector<std::uint64_t> which;
  std::vector<double> when;
  std::vector<char> fast;
  for (const LostStrand& lost : progress.lost) {
    which.push_back(lost.strand);
    when.push_back(lost.t);
    fast.push_back(lost.fast ? 1 : 0);
  }
  out.put(which);
  out.put(when);
  out.put(fast);
  out.put(std::vector{progress.speed});
  std::vector<double> kept;
  for (std::size_t b = 0; b < head.blocks(); ++b) {
    kept.resize(head.kept() * head.strands_of(b));
    head.keep(b, kept);
    out.put(kept);
  }
  out.keep();
}

HeadProgress load_head(const std::string& file, const RunKey& key, models::Head& head) {
  try {
    return parse(read_file(file), key, file, head);
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw InputError(std::string("the saved state is damaged: ") + error.what(), file,
                     begin_again);
  }
}

}  // namespace tress::simulation
