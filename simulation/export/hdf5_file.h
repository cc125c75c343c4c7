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
  using Close = int (*)(std::int64_t);
  Hdf5Handle(std::int64_t id, Close close) : id_(id), close_(close) {}
  ~Hdf5Handle() {
    if (id_ >= 0 && close_ != nullptr) close_(id_);
  }
  Hdf5Handle(const Hdf5Handle&) = delete;
  Hdf5Handle& operator=(const Hdf5Handle&) = delete;
  std::int64_t id() const { return id_; }
  /// Stays open to the end of the program.
  void keep_open() { close_ = nullptr; }

 private:
  std::int64_t id_;
  Close close_;
};

/// Numbers of an HDF5 file, little-endian on disk.
enum class Hdf5Type { float32, float64, int32 };

/// HDF5 file of datasets with two or three dimensions, the first of which may grow [The
/// HDF Group, HDF5 1.10]. Its metadata change on disk at flush() only. A file whose
/// writer was killed, or could not write on, holds the data of the last flush, unless
/// that happened within a flush (FileState helps). Throws InputError with HDF5's own
/// reason whenever a call fails.
class Hdf5File {
 public:
  enum class Mode { create, extend, read };
  Hdf5File(std::string file, Mode mode);

  /// Set or return an attribute of the file.
  void set(const std::string& name, const std::string& text);
  void set(const std::string& name, double number);
  double number(const std::string& name) const;

  struct Shape {
    Hdf5Type type;
    std::vector<std::size_t> size;   // at first; the first dimension may grow
    std::vector<std::size_t> chunk;  // what is compressed as one
    int level = 1;                   // of zlib, after a shuffle of bytes
  };
  void create(const std::string& dataset, const Shape& shape);
  bool has(const std::string& dataset) const;
  std::vector<std::size_t> size(const std::string& dataset) const;
  /// Entries of the first dimension: new ones are zero, those beyond are dropped.
  void resize(const std::string& dataset, std::size_t rows);

  /// Whole entries of the first dimension, one after the other, in the memory's kind of
  /// numbers.
  void write(const std::string& dataset, std::size_t row, std::span<const double> x);
  void write(const std::string& dataset, std::size_t row, std::span<const float> x);
  void write(const std::string& dataset, std::size_t row,
             std::span<const std::int32_t> x);
  void read(const std::string& dataset, std::size_t row, std::span<double> x) const;
  void read(const std::string& dataset, std::size_t row, std::span<float> x) const;
  void read(const std::string& dataset, std::size_t row, std::span<std::int32_t> x) const;

  /// A chunk as it is on disk, shuffled and compressed; `at`: of its first number.
  void write_chunk(const std::string& dataset, const std::vector<std::size_t>& at,
                   std::span<const char> bytes);
  std::vector<char> read_chunk(const std::string& dataset,
                               const std::vector<std::size_t>& at) const;

  /// Returns the place of the data in the file; no bytes if they were not written yet.
  FileRange place(const std::string& dataset, const std::vector<std::size_t>& at) const;

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
