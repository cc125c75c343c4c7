#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <string>
#include <vector>

#include "contract/basics.h"
#include "contract/input_error.h"

/// numpy arrays as the spans of the contract, and back.
namespace tress::python {

namespace py = pybind11;

/// Numbers from Python: an array of float64 in C order is used in place, anything else
/// that numpy understands is converted.
using Numbers = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// The numbers of `x`. Throws InputError unless it has this many.
inline In in(const Numbers& x, std::size_t size, const char* name) {
  if (static_cast<std::size_t>(x.size()) != size) {
    throw InputError("the array has " + std::to_string(x.size()) + " numbers, not " +
                         std::to_string(size),
                     name, "give one number for each coordinate of the system");
  }
  return {x.data(), size};
}

inline py::array_t<double> array(std::size_t size) {
  return py::array_t<double>(static_cast<py::ssize_t>(size));
}

inline Out out(py::array_t<double>& x) {
  return {x.mutable_data(), static_cast<std::size_t>(x.size())};
}

template <class T>
py::array_t<T> copy(std::span<const T> x) {
  return py::array_t<T>(static_cast<py::ssize_t>(x.size()), x.data());
}

inline py::array_t<double> copy(In x) { return copy<double>(x); }

inline py::array_t<double> copy(In x, std::vector<py::ssize_t> shape) {
  return copy(x).reshape(std::move(shape));
}

/// Returns a read-only array over the same memory; `owner` lives as long as the array
/// does.
inline py::array view(In x, const py::handle& owner) {
  py::array all(py::dtype::of<double>(), {static_cast<py::ssize_t>(x.size())}, {},
                x.data(), owner);
  all.attr("setflags")(py::arg("write") = false);
  return all;
}

}  // namespace tress::python
