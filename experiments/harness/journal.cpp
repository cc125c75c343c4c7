#include "experiments/harness/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "experiments/harness/files.h"
#include "models/input_error.h"

namespace tress {
namespace {

using nlohmann::json;

/// A kill loses nothing that was written; only a power cut needs the sync, so once a
/// second is enough and short rows stay cheap.
constexpr std::chrono::seconds between_syncs{1};

std::string dump(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
}

std::string key_line(const JournalKey& key) {
  return dump(json{{"experiment", key.experiment},
                   {"schema", schema_version},
                   {"settings", key.settings},
                   {"header", key.header}});
}

}  // namespace

std::string to_json_line(const Row& row) {
  json cells = json::array();
  for (const auto& [column, text] : row.cells()) cells.push_back({column, text});
  return dump(json{{"run_id", row.text("run_id")}, {"cells", cells}});
}

Row from_json_line(std::string_view line) {
  const json value = json::parse(line);
  Row row;
  for (const json& cell : value.at("cells")) {
    row.set(cell.at(0).get<std::string>(), cell.at(1).get<std::string>());
  }
  return row;
}

Journal::Journal(std::string file, const JournalKey& key, Mode mode)
    : file_(std::move(file)),
      descriptor_(::open(file_.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644)),
      synced_(std::chrono::steady_clock::now()) {
  if (descriptor_ < 0) {
    throw InputError(std::string("cannot write: ") + std::strerror(errno), file_,
                     "choose an --out in a writable directory");
  }
  try {
    lock();
    load(key, mode);
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

Journal::~Journal() { ::close(descriptor_); }

/// Record locks belong to the process: unlike flock's, the forked cases do not keep them.
void Journal::lock() {
  struct flock whole_file {};
  whole_file.l_type = F_WRLCK;
  whole_file.l_whence = SEEK_SET;
  if (::fcntl(descriptor_, F_SETLK, &whole_file) != 0) {
    throw InputError("another run is writing this table", file_,
                     "wait for it, or choose another --out");
  }
}

void Journal::load(const JournalKey& key, Mode mode) {
  std::string text;
  char buffer[65536];
  ssize_t n = 0;
  while ((n = ::read(descriptor_, buffer, sizeof buffer)) > 0) {
    text.append(buffer, static_cast<std::size_t>(n));
  }
  const std::size_t whole =
      text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1;
  if (whole > 0 && mode == Mode::fresh) {
    throw InputError("an earlier run did not finish", file_,
                     "add --resume to continue it, or delete that file");
  }
  const std::string first = key_line(key);
  std::size_t kept = 0;
  for (int number = 1; kept < whole; ++number) {
    const std::size_t end = text.find('\n', kept);
    const std::string_view line = std::string_view(text).substr(kept, end - kept);
    if (number == 1 && line != first) {
      throw InputError("the unfinished run had other settings or columns", file_,
                       "repeat them, choose another --out, or delete that file");
    }
    try {
      if (number > 1) rows_.push_back(from_json_line(line));
    } catch (const std::exception&) {
      if (end + 1 != text.size()) {
        throw InputError("damaged journal", fmt::format("{}:{}:1", file_, number),
                         "delete that line or the file");
      }
      break;  // the last line, torn by a crash of the machine
    }
    kept = end + 1;
  }
  if (::ftruncate(descriptor_, static_cast<off_t>(kept)) != 0 ||
      ::lseek(descriptor_, 0, SEEK_END) < 0) {
    throw InputError(std::string("cannot write: ") + std::strerror(errno), file_,
                     "choose an --out in a writable directory");
  }
  if (kept == 0) {
    try {
      write_all(descriptor_, first + '\n', file_);
    } catch (const InputError&) {
      ::unlink(file_.c_str());
      throw;
    }
  }
}

void Journal::append(const Row& row) {
  write_all(descriptor_, to_json_line(row) + '\n', file_);
  const auto now = std::chrono::steady_clock::now();
  if (now - synced_ < between_syncs) return;
  synced_ = now;
  if (::fdatasync(descriptor_) != 0 && errno != EINVAL && errno != EROFS) {
    throw InputError(std::string("cannot write: ") + std::strerror(errno), file_,
                     "free space, then --resume");
  }
}

void Journal::remove() { ::unlink(file_.c_str()); }

}  // namespace tress
