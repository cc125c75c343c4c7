#include "simulation/files/file_state.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "contract/input_error.h"
#include "simulation/files/files.h"

namespace tress::simulation {

FileState state_of(const std::string& file, std::vector<FileRange> unchanging) {
  std::ifstream stream(file, std::ios::binary | std::ios::ate);
  const auto cannot = [&] { return InputError("cannot read", file, "check the disk"); };
  if (!stream) throw cannot();
  FileState state;
  state.length = static_cast<std::uint64_t>(std::streamoff(stream.tellg()));
  std::ranges::sort(unchanging, {}, &FileRange::begin);
  unchanging.push_back({state.length, 0});
  std::uint64_t at = 0;
  for (const auto& [begin, size] : unchanging) {
    if (begin > at) {
      state.ranges.push_back({at, begin - at});
      const std::size_t used = state.bytes.size();
      state.bytes.resize(used + begin - at);
      stream.seekg(static_cast<std::streamoff>(at));
      stream.read(state.bytes.data() + used, static_cast<std::streamsize>(begin - at));
    }
    at = begin + size;
  }
  if (!stream) throw cannot();
  return state;
}

void restore(const std::string& file, const FileState& state) {
  refuse_link(file);
  std::fstream stream(file, std::ios::binary | std::ios::in | std::ios::out);
  const char* from = state.bytes.data();
  for (const auto& [begin, size] : state.ranges) {
    stream.seekp(static_cast<std::streamoff>(begin));
    stream.write(from, static_cast<std::streamsize>(size));
    from += size;
  }
  stream.close();
  std::error_code error;
  if (stream) std::filesystem::resize_file(file, state.length, error);
  if (!stream || error) {
    throw InputError("cannot write", file, "free space or leave out --resume");
  }
}

}  // namespace tress::simulation
