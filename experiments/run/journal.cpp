#include "experiments/run/journal.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <nlohmann/json.hpp>
#include <stdexcept>

#include "contract/input_error.h"
#include "simulation/files/checksum.h"
#include "simulation/files/files.h"

namespace tress::experiments {
namespace {

using nlohmann::json;

/// A kill loses nothing that was written; only a power failure needs the sync, so once a
/// second is enough and short rows stay cheap.
constexpr std::chrono::seconds between_syncs{1};

std::string dump(const json& value) {
  return value.dump(-1, ' ', false, json::error_handler_t::replace);
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

Journal::Journal(std::string file, const RunKey& key, Mode mode)
    : name_(std::move(file)),
      file_(name_, "this table"),
      synced_(std::chrono::steady_clock::now()) {
  load(key, mode);
}

void Journal::load(const RunKey& key, Mode mode) {
  const std::string text = file_.read();
  const std::size_t whole = text.rfind('\n') + 1;  // npos + 1 = 0
  if (whole > 0 && mode == Mode::fresh) {
    throw InputError("an earlier run did not finish", name_,
                     "add --resume to continue it, or delete that file");
  }
  std::size_t at = 0;
  for (int number = 1; at < whole; ++number) {
    const std::size_t end = text.find('\n', at);
    const std::string_view line = std::string_view(text).substr(at, end - at);
    at = end + 1;
    try {
      const std::string_view content = unsealed(line);
      if (number == 1) {
        key.check(content, name_);
      } else {
        rows_.push_back(from_json_line(content));
      }
    } catch (const InputError&) {
      throw;
    } catch (const std::exception& error) {
      throw InputError(fmt::format("damaged journal: {}", error.what()),
                       fmt::format("{}:{}:1", name_, number),
                       "delete that line (the first: the file)");
    }
  }
  file_.truncate(whole);
  if (whole > 0) return;
  try {
    write_all(file_.descriptor(), sealed(key.line()) + '\n', name_);
  } catch (const InputError&) {
    file_.remove();
    throw;
  }
}

void Journal::append(const Row& row) {
  write_all(file_.descriptor(), sealed(to_json_line(row)) + '\n', name_);
  const auto now = std::chrono::steady_clock::now();
  if (now - synced_ < between_syncs) return;
  synced_ = now;
  if (::fdatasync(file_.descriptor()) != 0 && errno != EINVAL && errno != EROFS) {
    throw InputError(std::string("cannot write: ") + std::strerror(errno), name_,
                     "free space, then --resume");
  }
}

void Journal::remove() { file_.remove(); }

}  // namespace tress::experiments
