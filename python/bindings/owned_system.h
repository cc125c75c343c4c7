#pragma once

#include <memory>
#include <thread>
#include <vector>

#include "contract/system.h"
#include "python/bindings/arrays.h"

namespace tress::python {

/// An evaluation or a step without a result; tress.SolveError in Python.
class SolveError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// A system as Python holds it.
struct OwnedSystem {
  std::unique_ptr<System> system;
  std::shared_ptr<const void> kept;  // what the system refers to
  /// The thread that steps it without the interpreter's lock; only that thread may call
  /// it meanwhile, from its observer.
  std::thread::id stepping = {};

  std::size_t n() const { return static_cast<std::size_t>(system->layout().coordinates); }
  std::size_t m() const { return static_cast<std::size_t>(system->layout().constraints); }
  /// Throws SolveError where another thread steps the system.
  System& free() const;
};

/// Marks a system while it lives.
class Stepping {
 public:
  explicit Stepping(OwnedSystem& system);
  ~Stepping() { system_.stepping = before_; }
  Stepping(const Stepping&) = delete;
  Stepping& operator=(const Stepping&) = delete;

 private:
  OwnedSystem& system_;
  std::thread::id before_;
};

/// Raises what a System written in Python has raised, if it has.
void raise_pending(System& system);

/// Makes a System of a Python object; see python/tress/systems.py for what it offers.
std::unique_ptr<System> user_system(py::object model);

void add_systems(py::module_& m);
void add_errors(py::module_& m);
void add_gradients(py::module_& m);
void add_integrators(py::module_& m);
void add_scenes(py::module_& m);

}  // namespace tress::python
