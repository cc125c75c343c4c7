#include "experiments/scenes/recording.h"

#include <fcntl.h>

#include <cmath>
#include <cstring>
#include <filesystem>

#include "experiments/harness/csv.h"
#include "models/input_error.h"

namespace tress {
namespace {

/// Numbers one after the other, as the machine holds them.
class Bytes {
 public:
  explicit Bytes(std::string text = {}) : text_(std::move(text)) {}

  template <class T>
  void put(const std::vector<T>& x) {
    text_.append(reinterpret_cast<const char*>(x.data()), sizeof(T) * x.size());
  }
  void put_sized(const std::vector<double>& x) {
    put(std::vector{static_cast<double>(x.size())});
    put(x);
  }

  /// False: there are not so many left.
  template <class T>
  bool take(std::vector<T>& x, std::size_t count) {
    if (count > (text_.size() - at_) / sizeof(T)) return false;
    x.resize(count);
    std::memcpy(x.data(), text_.data() + at_, sizeof(T) * count);
    at_ += sizeof(T) * count;
    return true;
  }
  bool take_sized(std::vector<double>& x) {
    std::vector<double> size;
    return take(size, 1) && take(x, static_cast<std::size_t>(size[0]));
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
  Snapshot snapshot;
};

std::string state_text(const std::string& key, std::size_t frames, const Snapshot& s) {
  Bytes bytes(key);
  bytes.put(std::vector{static_cast<double>(frames), s.t,
                        static_cast<double>(s.strands.size())});
  for (const auto& strand : s.strands) {
    for (const auto* x : {&strand.q, &strand.v, &strand.memory}) bytes.put_sized(*x);
  }
  bytes.put_sized(s.guards);
  return bytes.text();
}

std::optional<Saved> parse_state(const std::string& text, const std::string& key) {
  Bytes bytes(text);
  std::vector<double> head;
  if (!bytes.skip(key) || !bytes.take(head, 3)) return {};
  Saved saved{static_cast<std::size_t>(head[0]),
              {.t = head[1], .strands = {}, .guards = {}}};
  saved.snapshot.strands.resize(static_cast<std::size_t>(head[2]));
  for (auto& strand : saved.snapshot.strands) {
    for (auto* x : {&strand.q, &strand.v, &strand.memory}) {
      if (!bytes.take_sized(*x)) return {};
    }
  }
  if (!bytes.take_sized(saved.snapshot.guards)) return {};
  return saved;
}

}  // namespace

Recording::Recording(std::string stem, std::string key, const Readout& readout,
                     bool resume)
    : stem_(std::move(stem)),
      key_(std::move(key) + '\n'),
      columns_(readout.series()),
      points_(readout.points()),
      channels_(readout.channels().size()) {
  check_output(stem_ + ".csv");
  if (resume) this->resume();
  std::string table = header(), records = key_;
  for (const Frame3d& frame : frames_) {
    table += series_line(frame);
    records += record(frame);
  }
  replace_file(stem_ + ".csv", table);
  replace_file(stem_ + ".frames", records);
  csv_.emplace(stem_ + ".csv", O_WRONLY | O_APPEND | O_CLOEXEC);
  binary_.emplace(stem_ + ".frames", O_WRONLY | O_APPEND | O_CLOEXEC);
}

void Recording::resume() {
  const std::string state = stem_ + ".state", frames = stem_ + ".frames";
  if (!std::filesystem::exists(state)) return;
  const auto saved = parse_state(read_file(state), key_);
  Bytes bytes(read_file(frames));
  if (!saved || !bytes.skip(key_)) {
    throw InputError("the run to resume is of another scene or another version", state,
                     "leave out --resume, or choose another --out");
  }
  while (frames_.size() < saved->frames) {
    Frame3d frame;
    if (!bytes.take(frame.series, columns_.size()) ||
        !bytes.take(frame.positions, 3 * points_) ||
        !bytes.take(frame.channels, channels_ * points_)) {
      throw InputError("frames are missing", frames, "leave out --resume");
    }
    frames_.push_back(std::move(frame));
  }
  saved_ = saved->snapshot;
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
  return bytes.text();
}

void Recording::add(Frame3d frame) {
  write_all(binary_->descriptor(), record(frame), stem_ + ".frames");
  write_all(csv_->descriptor(), series_line(frame), stem_ + ".csv");
  frames_.push_back(std::move(frame));
}

void Recording::save(const Snapshot& snapshot) {
  replace_file(stem_ + ".state", state_text(key_, frames_.size(), snapshot));
}

void Recording::close() {
  std::error_code ignored;  // what is left over harms nobody
  for (const char* ending : {".state", ".frames"}) {
    std::filesystem::remove(stem_ + ending, ignored);
  }
}

}  // namespace tress
