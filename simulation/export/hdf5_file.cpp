#include "simulation/export/hdf5_file.h"

#include <fmt/format.h>
#include <hdf5.h>
#include <unistd.h>

#include <numeric>
#include <string_view>
#include <utility>

#include "contract/input_error.h"
#include "simulation/files/files.h"

namespace tress::simulation {
namespace {

using Sizes = std::vector<std::size_t>;

/// The innermost of the errors that HDF5 has gathered: what the system said.
std::string reason() {
  std::string text;
  H5Ewalk2(
      H5E_DEFAULT, H5E_WALK_UPWARD,
      [](unsigned, const H5E_error2_t* error, void* to) -> herr_t {
        *static_cast<std::string*>(to) = error->desc;
        return 1;  // the first is enough
      },
      &text);
  // "file write failed: time = ..., errno = 28, error message = 'No space left ...', ..."
  constexpr std::string_view of_system = "error message = '";
  if (const std::size_t at = text.find(of_system); at != std::string::npos) {
    const std::size_t begin = at + of_system.size();
    return text.substr(begin, text.find('\'', begin) - begin);
  }
  return text;
}

[[noreturn]] void failed(const std::string& file, const char* what) {
  throw InputError(std::string("cannot ") + what + ": " + reason(), file,
                   "free space or write elsewhere; a damaged file is written again "
                   "without --resume");
}

hid_t made(hid_t id, const std::string& file, const char* what) {
  if (id < 0) failed(file, what);
  return id;
}

/// Nor does HDF5 close at the program's end what is still open.
void start() {
  static const int started = H5dont_atexit();
  static_cast<void>(started);
}

std::int64_t opened(const std::string& file, Hdf5File::Mode mode) {
  start();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // errors are exceptions, not prints
  const Hdf5Handle access(made(H5Pcreate(H5P_FILE_ACCESS), file, "open"), H5Pclose);
  // Metadata stay in memory between flushes: what is on disk always fits together.
  H5AC_cache_config_t cache{};
  cache.version = H5AC__CURR_CACHE_CONFIG_VERSION;
  if (H5Pget_mdc_config(access.id(), &cache) < 0) failed(file, "open");
  cache.evictions_enabled = false;
  cache.incr_mode = H5C_incr__off;
  cache.flash_incr_mode = H5C_flash_incr__off;
  cache.decr_mode = H5C_decr__off;
  if (H5Pset_mdc_config(access.id(), &cache) < 0) failed(file, "open");
  if (mode != Hdf5File::Mode::read) refuse_link(file);
  if (mode == Hdf5File::Mode::create) {
    // A new file, not the old one emptied: it may have another name elsewhere.
    ::unlink(file.c_str());
    return made(H5Fcreate(file.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, access.id()), file,
                "create");
  }
  return made(
      H5Fopen(file.c_str(), mode == Hdf5File::Mode::read ? H5F_ACC_RDONLY : H5F_ACC_RDWR,
              access.id()),
      file, "open");
}

hid_t on_disk(Hdf5Type type) {
  switch (type) {
    case Hdf5Type::float32:
      return H5T_IEEE_F32LE;
    case Hdf5Type::float64:
      return H5T_IEEE_F64LE;
    default:
      return H5T_STD_I32LE;
  }
}

std::vector<hsize_t> dimensions(const Sizes& sizes) {
  return {sizes.begin(), sizes.end()};
}

}  // namespace

Hdf5File::Hdf5File(std::string file, Mode mode)
    : file_(std::move(file)), handle_(opened(file_, mode), H5Fclose) {}

std::int64_t Hdf5File::checked(std::int64_t result, const char* what) const {
  if (result >= 0) return result;
  if (what == std::string_view("write")) handle_.keep_open();
  failed(file_, what);
}

void Hdf5File::set(const std::string& name, const std::string& text) {
  const Hdf5Handle type(checked(H5Tcopy(H5T_C_S1), "write"), H5Tclose);
  checked(H5Tset_size(type.id(), text.size() + 1), "write");
  checked(H5Tset_cset(type.id(), H5T_CSET_UTF8), "write");
  const Hdf5Handle space(checked(H5Screate(H5S_SCALAR), "write"), H5Sclose);
  const Hdf5Handle attribute(checked(H5Acreate2(handle_.id(), name.c_str(), type.id(),
                                                space.id(), H5P_DEFAULT, H5P_DEFAULT),
                                     "write"),
                             H5Aclose);
  checked(H5Awrite(attribute.id(), type.id(), text.c_str()), "write");
}

void Hdf5File::set(const std::string& name, double number) {
  const Hdf5Handle space(checked(H5Screate(H5S_SCALAR), "write"), H5Sclose);
  const Hdf5Handle attribute(
      checked(H5Acreate2(handle_.id(), name.c_str(), H5T_IEEE_F64LE, space.id(),
                         H5P_DEFAULT, H5P_DEFAULT),
              "write"),
      H5Aclose);
  checked(H5Awrite(attribute.id(), H5T_NATIVE_DOUBLE, &number), "write");
}

double Hdf5File::number(const std::string& name) const {
  const Hdf5Handle attribute(
      checked(H5Aopen(handle_.id(), name.c_str(), H5P_DEFAULT), "read"), H5Aclose);
  double number = 0;
  checked(H5Aread(attribute.id(), H5T_NATIVE_DOUBLE, &number), "read");
  return number;
}

void Hdf5File::create(const std::string& dataset, const Shape& shape) {
  std::vector<hsize_t> size = dimensions(shape.size), most = size,
                       chunk = dimensions(shape.chunk);
  most.front() = H5S_UNLIMITED;
  const auto rank = static_cast<int>(size.size());
  const Hdf5Handle space(
      checked(H5Screate_simple(rank, size.data(), most.data()), "write"), H5Sclose);
  const Hdf5Handle layout(checked(H5Pcreate(H5P_DATASET_CREATE), "write"), H5Pclose);
  checked(H5Pset_chunk(layout.id(), rank, chunk.data()), "write");
  checked(H5Pset_shuffle(layout.id()), "write");
  checked(H5Pset_deflate(layout.id(), static_cast<unsigned>(shape.level)), "write");
  // Otherwise no two files would be the same bytes.
  checked(H5Pset_obj_track_times(layout.id(), false), "write");
  const Hdf5Handle groups(checked(H5Pcreate(H5P_LINK_CREATE), "write"), H5Pclose);
  checked(H5Pset_create_intermediate_group(groups.id(), 1), "write");
  const Hdf5Handle made(
      checked(H5Dcreate2(handle_.id(), dataset.c_str(), on_disk(shape.type), space.id(),
                         groups.id(), layout.id(), H5P_DEFAULT),
              "write"),
      H5Dclose);
}

Hdf5Handle Hdf5File::open(const std::string& dataset) const {
  return {checked(H5Dopen2(handle_.id(), dataset.c_str(), H5P_DEFAULT), "read"),
          H5Dclose};
}

/// Looks up every group on the way: HDF5 takes it for an error where one is missing.
bool Hdf5File::has(const std::string& dataset) const {
  for (std::size_t end = 0; end != std::string::npos;) {
    end = dataset.find('/', end + 1);
    const std::string part = dataset.substr(0, end);
    if (H5Lexists(handle_.id(), part.c_str(), H5P_DEFAULT) <= 0) return false;
  }
  return true;
}

Sizes Hdf5File::size(const std::string& dataset) const {
  const Hdf5Handle set = open(dataset);
  const Hdf5Handle space(checked(H5Dget_space(set.id()), "read"), H5Sclose);
  const auto rank = checked(H5Sget_simple_extent_ndims(space.id()), "read");
  std::vector<hsize_t> size(static_cast<std::size_t>(rank));
  checked(H5Sget_simple_extent_dims(space.id(), size.data(), nullptr), "read");
  return {size.begin(), size.end()};
}

void Hdf5File::resize(const std::string& dataset, std::size_t rows) {
  std::vector<hsize_t> all = dimensions(size(dataset));
  all.front() = rows;
  checked(H5Dset_extent(open(dataset).id(), all.data()), "write");
}

void Hdf5File::transfer(const std::string& dataset, std::size_t row, std::size_t count,
                        std::int64_t type, const void* from, void* to) const {
  std::vector<hsize_t> shape = dimensions(size(dataset)), start(shape.size());
  start.front() = row;
  shape.front() = 1;
  const hsize_t of_row = std::accumulate(shape.begin(), shape.end(), hsize_t{1},
                                         std::multiplies<>()),
                numbers = count;
  if (of_row == 0 || numbers % of_row != 0) failed(file_, "transfer parts of entries");
  shape.front() = numbers / of_row;
  const Hdf5Handle set = open(dataset);
  const Hdf5Handle disk(checked(H5Dget_space(set.id()), "read"), H5Sclose);
  checked(H5Sselect_hyperslab(disk.id(), H5S_SELECT_SET, start.data(), nullptr,
                              shape.data(), nullptr),
          "read");
  const Hdf5Handle memory(checked(H5Screate_simple(1, &numbers, nullptr), "read"),
                          H5Sclose);
  if (from != nullptr) {
    checked(H5Dwrite(set.id(), type, memory.id(), disk.id(), H5P_DEFAULT, from), "write");
  } else {
    checked(H5Dread(set.id(), type, memory.id(), disk.id(), H5P_DEFAULT, to), "read");
  }
}

void Hdf5File::write(const std::string& dataset, std::size_t row,
                     std::span<const double> x) {
  transfer(dataset, row, x.size(), H5T_NATIVE_DOUBLE, x.data(), nullptr);
}
void Hdf5File::write(const std::string& dataset, std::size_t row,
                     std::span<const float> x) {
  transfer(dataset, row, x.size(), H5T_NATIVE_FLOAT, x.data(), nullptr);
}
void Hdf5File::write(const std::string& dataset, std::size_t row,
                     std::span<const std::int32_t> x) {
  transfer(dataset, row, x.size(), H5T_NATIVE_INT32, x.data(), nullptr);
}
void Hdf5File::read(const std::string& dataset, std::size_t row,
                    std::span<double> x) const {
  transfer(dataset, row, x.size(), H5T_NATIVE_DOUBLE, nullptr, x.data());
}
void Hdf5File::read(const std::string& dataset, std::size_t row,
                    std::span<float> x) const {
  transfer(dataset, row, x.size(), H5T_NATIVE_FLOAT, nullptr, x.data());
}
void Hdf5File::read(const std::string& dataset, std::size_t row,
                    std::span<std::int32_t> x) const {
  transfer(dataset, row, x.size(), H5T_NATIVE_INT32, nullptr, x.data());
}

void Hdf5File::write_chunk(const std::string& dataset, const Sizes& at,
                           std::span<const char> bytes) {
  const std::vector<hsize_t> offset = dimensions(at);
  checked(H5Dwrite_chunk(open(dataset).id(), H5P_DEFAULT, 0, offset.data(), bytes.size(),
                         bytes.data()),
          "write");
}

std::vector<char> Hdf5File::read_chunk(const std::string& dataset,
                                       const Sizes& at) const {
  const std::vector<hsize_t> offset = dimensions(at);
  const Hdf5Handle set = open(dataset);
  hsize_t size = 0;
  checked(H5Dget_chunk_storage_size(set.id(), offset.data(), &size), "read");
  std::vector<char> bytes(size);
  std::uint32_t skipped = 0;
  checked(H5Dread_chunk(set.id(), H5P_DEFAULT, offset.data(), &skipped, bytes.data()),
          "read");
  return bytes;
}

FileRange Hdf5File::place(const std::string& dataset, const Sizes& at) const {
  const std::vector<hsize_t> offset = dimensions(at);
  haddr_t begin = 0;
  hsize_t size = 0;
  unsigned filters = 0;
  checked(H5Dget_chunk_info_by_coord(open(dataset).id(), offset.data(), &filters, &begin,
                                     &size),
          "read");
  return {begin, size};
}

void Hdf5File::flush() { checked(H5Fflush(handle_.id(), H5F_SCOPE_GLOBAL), "write"); }

void Hdf5File::sync() {
  flush();
  void* descriptor = nullptr;
  checked(H5Fget_vfd_handle(handle_.id(), H5P_DEFAULT, &descriptor), "write");
  if (::fsync(*static_cast<int*>(descriptor)) != 0) {
    throw InputError("cannot write to the disk", file_, "free space or write elsewhere");
  }
}

void shuffle(std::span<const char> from, std::size_t number_size, std::span<char> to) {
  const std::size_t count = from.size() / number_size;
  for (std::size_t byte = 0; byte < number_size; ++byte) {
    for (std::size_t i = 0; i < count; ++i) {
      to[byte * count + i] = from[i * number_size + byte];
    }
  }
}

}  // namespace tress::simulation
