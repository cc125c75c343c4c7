#include "models/mesh/grid_cache.h"

#include <unistd.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string_view>
#include <system_error>
#include <utility>

#include "contract/input_error.h"
#include "contract/read_file.h"

namespace tress::models {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view mark = "tress mesh grid 1\n";

/// Numbers before the values.
struct Head {
  std::uint64_t nx = 0, ny = 0, nz = 0, triangles = 0, hash = 0;
  std::array<double, 5> real{};  // origin, spacing, error
};

std::uint64_t hash_of(std::string_view bytes) {
  return std::hash<std::string_view>{}(bytes);
}
template <class T>
std::string_view bytes_of(const T& from) {
  return {reinterpret_cast<const char*>(&from), sizeof from};
}
std::string_view bytes_of(const std::vector<double>& from) {
  return {reinterpret_cast<const char*>(from.data()), from.size() * sizeof(double)};
}

fs::path folder() {
  const char* const set = std::getenv("XDG_CACHE_HOME");
  if (set != nullptr && *set != 0) return fs::path(set) / "tress" / "meshes";
  const char* const home = std::getenv("HOME");
  if (home == nullptr || *home == 0) return {};
  return fs::path(home) / ".cache" / "tress" / "meshes";
}

}  // namespace

GridCache::GridCache(const std::string& mesh_file, const MeshGridOptions& options)
    : where_(mesh_file) {
  const fs::path in = folder();
  const std::string mesh = read_file(mesh_file);
  if (in.empty()) return;
  const std::array key{options.scale, options.spacing, options.offset};
  const std::array<std::uint64_t, 2> names{
      hash_of(mesh),
      hash_of(std::string(bytes_of(key)) + where_.substr(where_.find_last_of('.') + 1))};
  file_ = in / (std::to_string(mesh.size()) + "-" + std::to_string(names[0]) + "-" +
                std::to_string(names[1]) + ".grid");
}

std::optional<MeshGrid> GridCache::find() const {
  std::error_code error;
  if (file_.empty() || !fs::is_regular_file(file_, error)) return {};
  try {
    const std::string text = read_file(file_);
    Head head;
    if (!text.starts_with(mark) || text.size() < mark.size() + sizeof head) return {};
    std::memcpy(&head, text.data() + mark.size(), sizeof head);
    const std::string_view values =
        std::string_view(text).substr(mark.size() + sizeof head);
    const std::uint64_t hash = std::exchange(head.hash, 0);
    if (hash != hash_of(std::string(bytes_of(head)) + std::string(values))) return {};
    DistanceGrid::Samples s{.nx = head.nx,
                            .ny = head.ny,
                            .nz = head.nz,
                            .origin = {head.real[0], head.real[1], head.real[2]},
                            .spacing = head.real[3],
                            .value = std::vector<double>(values.size() / sizeof(double))};
    std::memcpy(s.value.data(), values.data(), s.value.size() * sizeof(double));
    return MeshGrid{DistanceGrid(std::move(s), where_), head.triangles, head.real[4]};
  } catch (const InputError&) {
    return {};  // damaged: it is computed again
  }
}

void GridCache::keep(const MeshGrid& made) const {
  if (file_.empty()) return;
  const DistanceGrid::Samples& s = made.grid.samples();
  Head head{s.nx, s.ny,
            s.nz, made.triangles,
            0,    {s.origin.x, s.origin.y, s.origin.z, s.spacing, made.error}};
  head.hash = hash_of(std::string(bytes_of(head)) + std::string(bytes_of(s.value)));
  const std::string fresh = file_ + "." + std::to_string(getpid());
  std::error_code error;
  fs::create_directories(fs::path(file_).parent_path(), error);
  std::ofstream to(fresh, std::ios::binary);
  to << mark << bytes_of(head) << bytes_of(s.value);
  to.close();
  if (to) {
    fs::rename(fresh, file_, error);
  } else {
    fs::remove(fresh, error);
  }
}

}  // namespace tress::models
