#include "simulation/export/recording.h"

#include <fcntl.h>

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "contract/input_error.h"
#include "simulation/files/csv.h"

namespace tress::simulation {
namespace {

/// Numbers in sequence, in the machine's representation.
class Bytes {
 public:
  explicit Bytes(std::string text = {}) : text_(std::move(text)) {}

  template <class T>
  void put(const std::vector<T>& x) {
    text_.append(reinterpret_cast<const char*>(x.data()), sizeof(T) * x.size());
  }
  template <class T>
  void put_sized(const std::vector<T>& x) {
    put(std::vector<std::uint64_t>{x.size()});
    put(x);
  }

  /// False: fewer are left.
  template <class T>
  bool take(std::vector<T>& x, std::size_t count) {
    if (count > (text_.size() - at_) / sizeof(T)) return false;
    x.resize(count);
    // Works for none: memcpy must not get the null pointer of an empty vector.
    std::copy_n(text_.data() + at_, sizeof(T) * count, reinterpret_cast<char*>(x.data()));
    at_ += sizeof(T) * count;
    return true;
  }
  template <class T>
  bool take_sized(std::vector<T>& x) {
    std::vector<std::uint64_t> size;
    return take(size, 1) && take(x, size[0]);
  }
  bool skip(std::string_view expected) {
    if (!std::string_view(text_).substr(at_).starts_with(expected)) return false;
    at_ += expected.size();
    return true;
  }
  const std::string& text() const { return text_; }

 private:
  std::string text_;
  std::size_t at_ = 0;
};

struct Saved {
  std::size_t frames;
  std::uint64_t sum;  // of the frames
  Snapshot snapshot;
};

std::string state_text(const std::string& key, const Saved& saved) {
  const Snapshot& s = saved.snapshot;
  Bytes bytes(key);
  bytes.put(std::vector<std::uint64_t>{saved.frames, saved.sum, s.strands.size(),
                                       s.couplings.size()});
  bytes.put(std::vector{s.t});
  for (const auto& strand : s.strands) {
    for (const auto* x : {&strand.q, &strand.v, &strand.memory}) bytes.put_sized(*x);
  }
  bytes.put_sized(s.guards);
  for (const auto& coupling : s.couplings) bytes.put_sized(coupling);
  std::vector<std::uint64_t> which;
  std::vector<double> when;
  for (const FailedStrand& one : s.lost) {
    which.push_back(one.strand);
    when.push_back(one.t);
  }
  bytes.put_sized(which);
  bytes.put_sized(when);
  for (const FailedStrand& one : s.lost) {
    bytes.put_sized(std::vector<char>(one.reason.begin(), one.reason.end()));
  }
  return sealed(bytes.text());
}

/// Throws std::runtime_error when it is damaged, InputError when it belongs to another
/// run.
Saved parse_state(std::string_view text, const RunKey& key, const std::string& file) {
  const std::string_view content = unsealed(text);
  const std::string_view first = content.substr(0, content.find('\n'));
  key.check(first, file);
  Bytes bytes(std::string(content.substr(first.size() + 1)));
  std::vector<std::uint64_t> head;
  std::vector<double> t;
  bool whole = bytes.take(head, 4) && bytes.take(t, 1);
  Saved saved;
  if (whole) {
    saved = {head[0],
             head[1],
             {.t = t[0], .strands = {}, .guards = {}, .couplings = {}, .lost = {}}};
    saved.snapshot.strands.resize(head[2]);
    saved.snapshot.couplings.resize(head[3]);
  }
  for (auto& strand : saved.snapshot.strands) {
    for (auto* x : {&strand.q, &strand.v, &strand.memory}) {
      whole = whole && bytes.take_sized(*x);
    }
  }
  whole = whole && bytes.take_sized(saved.snapshot.guards);
  for (auto& coupling : saved.snapshot.couplings) {
    whole = whole && bytes.take_sized(coupling);
  }
  std::vector<std::uint64_t> which;
  std::vector<double> when;
  whole = whole && bytes.take_sized(which) && bytes.take_sized(when) &&
          which.size() == when.size();
  for (std::size_t i = 0; whole && i < which.size(); ++i) {
    std::vector<char> reason;
    whole = bytes.take_sized(reason);
    saved.snapshot.lost.push_back({which[i], when[i], {reason.begin(), reason.end()}});
  }
  if (!whole) {
    throw std::runtime_error("it ends too early");
  }
  return saved;
}

/// Checks the outputs before creating any.
std::string checked(std::string stem) {
  check_output(stem + ".csv");
  return stem;
}

}  // namespace

Recording::Recording(std::string stem, const RunKey& key, const Readout& readout,
                     bool resume)
    : stem_(checked(std::move(stem))),
      key_(key.line() + '\n'),
      binary_(stem_ + ".frames", "this scene"),
      columns_(readout.series()),
      points_(readout.points()),
      channels_(readout.channels().size()) {
  remove_leftovers(stem_);
  const std::string state = stem_ + ".state";
  std::error_code error;
  if (resume && std::filesystem::exists(state, error)) {
    try {
      this->resume(key);
    } catch (...) {
      if (binary_.read().empty()) binary_.remove();  // created here, for the lock
      throw;
    }
  } else if (std::filesystem::remove(state, error); error) {
    throw InputError("cannot remove: " + error.message(), state, "choose another --out");
  }
  std::string table = header();
  std::size_t bytes = 0;
  for (const Frame3d& frame : frames_) {
    table += series_line(frame);
    bytes += record(frame).size();
  }
  binary_.truncate(bytes);
  replace_file(stem_ + ".csv", table);
  csv_.emplace(stem_ + ".csv", O_WRONLY | O_APPEND | O_CLOEXEC);
}

void Recording::resume(const RunKey& key) {
  const std::string state = stem_ + ".state", frames = stem_ + ".frames";
  const std::string remedy = "leave out --resume to begin again";
  Saved saved;
  try {
    saved = parse_state(read_file(state), key, state);
  } catch (const InputError&) {
    throw;
  } catch (const std::runtime_error& error) {
    throw InputError(std::string("the saved state is damaged: ") + error.what(), state,
                     remedy);
  }
  // Where a count is damaged, what follows it is no frame.
  const auto damaged = [&] {
    return InputError("frames are missing or damaged: their checksum does not fit",
                      frames, remedy);
  };
  Bytes bytes(binary_.read());
  while (frames_.size() < saved.frames) {
    Frame3d frame;
    if (!bytes.take(frame.series, columns_.size()) ||
        !bytes.take(frame.positions, 3 * points_) ||
        !bytes.take(frame.channels, channels_ * points_) ||
        !bytes.take_sized(frame.contacts) || !bytes.take_sized(frame.reactions)) {
      throw damaged();
    }
    sum_.add(record(frame));
    frames_.push_back(std::move(frame));
  }
  if (sum_.value() != saved.sum) throw damaged();
  saved_ = std::move(saved.snapshot);
}

std::string Recording::header() const {
  std::vector<std::string> names;
  for (const Reading& column : columns_) names.push_back(column.name);
  return csv_line(names);
}

std::string Recording::series_line(const Frame3d& frame) const {
  Row row;
  std::vector<std::string> cells;
  for (std::size_t i = 0; i < columns_.size(); ++i) {
    row.set(columns_[i].name, frame.series[i]);
    cells.emplace_back(row.text(columns_[i].name));
  }
  return csv_line(cells);
}

std::string Recording::record(const Frame3d& frame) {
  Bytes bytes;
  bytes.put(frame.series);
  bytes.put(frame.positions);
  bytes.put(frame.channels);
  bytes.put_sized(frame.contacts);
  bytes.put_sized(frame.reactions);
  return bytes.text();
}

void Recording::add(Frame3d frame) {
  const std::string bytes = record(frame);
  write_all(binary_.descriptor(), bytes, stem_ + ".frames");
  write_all(csv_->descriptor(), series_line(frame), stem_ + ".csv");
  sum_.add(bytes);
  frames_.push_back(std::move(frame));
}

void Recording::save(const Snapshot& snapshot) {
  replace_file(stem_ + ".state",
               state_text(key_, {frames_.size(), sum_.value(), snapshot}));
}

void Recording::close() {
  std::error_code ignored;  // leftover files are harmless
  for (const char* ending : {".state", ".frames"}) {
    std::filesystem::remove(stem_ + ending, ignored);
  }
}

}  // namespace tress::simulation
