#pragma once

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "contract/layers.h"
#include "simulation/files/file_state.h"

namespace tress::simulation {

/// An identifier of HDF5's, closed on every path.
class Hdf5Handle {
 public:
  /// Function of HDF5 that closes the identifier.
  using Close = int (*)(std::int64_t);
  /// Takes an identifier, negative if the call that made it failed.
  Hdf5Handle(std::int64_t id, Close close) : id_(id), close_(close) {}
  ~Hdf5Handle() {
    if (id_ >= 0 && close_ != nullptr) close_(id_);
  }
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  /// Returns the identifier.
  std::int64_t id() const { return id_; }
  /// Stays open to the end of the program.
  void keep_open() { close_ = nullptr; }

 private:
  std::int64_t id_;
  Close close_;
};

/// Type of the numbers of a dataset: `float32`, `float64` or `int32`, little-endian on
/// disk.
enum class Hdf5Type { float32, float64, int32 };

/// HDF5 file of datasets with two or three dimensions, the first of which may grow [The
/// HDF Group, HDF5 1.10]. Its metadata change on disk at flush() only. A file whose
/// writer was killed, or could not write on, holds the data of the last flush, unless
/// that happened within a flush (FileState helps). Throws InputError with HDF5's own
/// reason whenever a call fails.
class Hdf5File {
 public:
  /// Use of the file: `create` a new one, `extend` one that exists, or `read`.
  enum class Mode { create, extend, read };
  /// Opens the file.
  Hdf5File(std::string file, Mode mode);

  /// Set or return an attribute of the file.
  void set(const std::string& name, const std::string& text);
  /// Sets an attribute that is a number.
  void set(const std::string& name, double number);
  /// Returns an attribute that is a number.
  double number(const std::string& name) const;

  /// Layout of a dataset.
  struct Shape {
    Hdf5Type type;                   // numbers on disk
    std::vector<std::size_t> size;   // at first; the first dimension may grow
    std::vector<std::size_t> chunk;  // what is compressed as one
    int level = 1;                   // of zlib, after a shuffle of bytes
  };
  /// Creates a dataset.
  void create(const std::string& dataset, const Shape& shape);
  /// Returns true if the file has a dataset of this name.
  bool has(const std::string& dataset) const;
  /// Returns the sizes of a dataset's dimensions.
  std::vector<std::size_t> size(const std::string& dataset) const;
  /// Entries of the first dimension: new ones are zero, those beyond are dropped.
  void resize(const std::string& dataset, std::size_t rows);

  /// Whole entries of the first dimension, one after the other, in the memory's kind of
  /// numbers.
  void write(const std::string& dataset, std::size_t row, std::span<const double> x);
  /// Writes entries in single precision.
  void write(const std::string& dataset, std::size_t row, std::span<const float> x);
  /// Writes entries that are whole numbers.
  void write(const std::string& dataset, std::size_t row,
             std::span<const std::int32_t> x);
  /// Reads entries from `row` on into all of x.
  void read(const std::string& dataset, std::size_t row, std::span<double> x) const;
  /// Reads entries in single precision.
  void read(const std::string& dataset, std::size_t row, std::span<float> x) const;
  /// Reads entries that are whole numbers.
  void read(const std::string& dataset, std::size_t row, std::span<std::int32_t> x) const;

  /// A chunk as it is on disk, shuffled and compressed; `at`: of its first number.
  void write_chunk(const std::string& dataset, const std::vector<std::size_t>& at,
                   std::span<const char> bytes);
  /// Returns a chunk as it is on disk.
  std::vector<char> read_chunk(const std::string& dataset,
                               const std::vector<std::size_t>& at) const;

  /// Returns the place of the data in the file; no bytes if they were not written yet.
  FileRange place(const std::string& dataset, const std::vector<std::size_t>& at) const;

  /// Writes the metadata to the file.
  void flush();
  /// A flush that also reaches the disk.
  void sync();

 private:
  void transfer(const std::string& dataset, std::size_t row, std::size_t count,
                std::int64_t type, const void* from, void* to) const;
  Hdf5Handle open(const std::string& dataset) const;
  std::int64_t checked(std::int64_t result, const char* what) const;

  std::string file_;
  mutable Hdf5Handle handle_;  // kept open after a failure, as closing it is a flush
};

/// The bytes of HDF5's shuffle filter: the first bytes of all numbers, then the second.
void shuffle(std::span<const char> from, std::size_t number_size, std::span<char> to);

}  // namespace tress::simulation
