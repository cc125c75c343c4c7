#pragma once

#include <arkode/arkode_arkstep.h>
#include <arkode/arkode_erkstep.h>
#include <arkode/arkode_mristep.h>
#include <cvode/cvode.h>
#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <sundials/sundials_context.h>
#include <sundials/sundials_linearsolver.h>
#include <sundials/sundials_matrix.h>
#include <sundials/sundials_nonlinearsolver.h>
#include <sundials/sundials_version.h>

#include <array>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "contract/basics.h"

/// Ownership and return codes of SUNDIALS in one place. All differences between 6.4 and
/// 7.x are handled here; the rest of this folder works with both.
namespace tress::integrators {

/// Return code of a callback: 0, try a smaller step (+1), give up (-1).
constexpr int sundials_code(Status status) noexcept {
  return status == Status::ok ? 0 : status == Status::retry ? 1 : -1;
}

/// Return code of a linear solver's solve().
constexpr int linear_solver_code(Status status) noexcept {
#if SUNDIALS_VERSION_MAJOR >= 7
  constexpr int unrecoverable = SUN_ERR_EXT_FAIL;
#else
  constexpr int unrecoverable = SUNLS_PACKAGE_FAIL_UNREC;
#endif
  return status == Status::ok      ? 0
         : status == Status::retry ? SUNLS_PACKAGE_FAIL_REC
                                   : unrecoverable;
}

/// Throws if a call that sets up an integrator fails: the cause is a programming error or
/// lack of memory. Never used inside a callback.
inline void require(int code, const char* call) {
  if (code >= 0) return;
  throw std::runtime_error(std::string("SUNDIALS refused ") + call + " with code " +
                           std::to_string(code));
}

/// Returns the pointer; throws std::runtime_error naming `call` if it is null.
template <class Pointer>
Pointer require(Pointer made, const char* call) {
  if (made == nullptr) throw std::runtime_error(std::string("SUNDIALS failed: ") + call);
  return made;
}

/// The last error SUNDIALS reported, kept here instead of printed. Warnings are dropped:
/// the counters show the same.
class SundialsMessages {
 public:
  /// Returns the last error; empty if there was none.
  const char* last() const { return text_.data(); }
  /// Forgets the last error.
  void clear() noexcept { text_[0] = '\0'; }

  /// Keeps an error.
  void keep(const char* message) noexcept {
    std::strncpy(text_.data(), message == nullptr ? "" : message, text_.size() - 1);
  }

#if SUNDIALS_VERSION_MAJOR >= 7
  static void receive(int, const char*, const char*, const char* message, SUNErrCode code,
                      void* self, SUNContext) noexcept {
    if (code < 0) static_cast<SundialsMessages*>(self)->keep(message);
  }
#else
  /// Handler for SUNDIALS before 7; `self`: a SundialsMessages.
  static void receive(int code, const char*, const char*, char* message,
                      void* self) noexcept {
    if (code < 0) static_cast<SundialsMessages*>(self)->keep(message);
  }
#endif

 private:
  std::array<char, 256> text_{};
};

/// One per integrator: contexts are not shared between threads. Must outlive its users.
class SundialsContext {
 public:
  /// Creates a context that keeps its errors in `messages`.
  SundialsContext() {
#if SUNDIALS_VERSION_MAJOR >= 7
    require(-std::abs(SUNContext_Create(SUN_COMM_NULL, &context_)), "SUNContext_Create");
    SUNContext_ClearErrHandlers(context_);
    SUNContext_PushErrHandler(context_, &SundialsMessages::receive, &messages);
#else
    require(-std::abs(SUNContext_Create(nullptr, &context_)), "SUNContext_Create");
#endif
  }
  ~SundialsContext() { SUNContext_Free(&context_); }
  SundialsContext(const SundialsContext&) = delete;
  SundialsContext& operator=(const SundialsContext&) = delete;
  /// Returns SUNDIALS' handle.
  SUNContext handle() const { return context_; }

  SundialsMessages messages;  // errors of this context

 private:
  SUNContext context_ = nullptr;
};

/// Memory owned by this class, with an N_Vector as a view.
class SundialsVector {
 public:
  /// Allocates `length` numbers.
  SundialsVector(const SundialsContext& context, int length)
      : values_(static_cast<std::size_t>(length)),
        handle_(require(N_VMake_Serial(length, values_.data(), context.handle()),
                        "N_VMake_Serial")) {}
  /// Returns SUNDIALS' handle, a view of values().
  N_Vector handle() const { return handle_.get(); }
  /// Returns the numbers.
  Out values() { return values_; }
  /// Returns the numbers.
  In values() const { return values_; }

 private:
  struct Destroy {
    void operator()(N_Vector v) const { N_VDestroy(v); }
  };
  std::vector<double> values_;
  std::unique_ptr<std::remove_pointer_t<N_Vector>, Destroy> handle_;
};

/// Returns the numbers of a serial N_Vector.
inline Out entries(N_Vector v) noexcept {
  return {N_VGetArrayPointer(v), static_cast<std::size_t>(N_VGetLength(v))};
}

/// Deleter for SUNDIALS' memory.
template <void (*Free)(void**)>
struct FreeSundials {
  /// Frees the memory.
  void operator()(void* memory) const { Free(&memory); }
};
/// Memory of CVODE.
using CvodeMemory = std::unique_ptr<void, FreeSundials<CVodeFree>>;
/// Memory of IDA.
using IdaMemory = std::unique_ptr<void, FreeSundials<IDAFree>>;
/// Memory of ARKStep.
using ArkstepMemory = std::unique_ptr<void, FreeSundials<ARKStepFree>>;
/// Memory of ERKStep.
using ErkstepMemory = std::unique_ptr<void, FreeSundials<ERKStepFree>>;
/// Memory of MRIStep.
using MristepMemory = std::unique_ptr<void, FreeSundials<MRIStepFree>>;

/// Deleter for the fast steps inside those of MRIStep.
struct FreeInnerStepper {
  /// Frees the stepper, not the memory that it steps with.
  void operator()(MRIStepInnerStepper stepper) const {
    MRIStepInnerStepper_Free(&stepper);
  }
};
/// Fast steps of MRIStep.
using InnerStepper =
    std::unique_ptr<std::remove_pointer_t<MRIStepInnerStepper>, FreeInnerStepper>;

/// Deleter for SUNDIALS' nonlinear solvers.
struct FreeNonlinearSolver {
  /// Frees the solver.
  void operator()(SUNNonlinearSolver solver) const { SUNNonlinSolFree(solver); }
};
/// Nonlinear solver of SUNDIALS.
using NonlinearSolver =
    std::unique_ptr<std::remove_pointer_t<SUNNonlinearSolver>, FreeNonlinearSolver>;

/// Sends an integrator's errors to `messages`; in 7.x its context does that already.
#if SUNDIALS_VERSION_MAJOR >= 7
template <class Memory>
int send_messages(const Memory&, SundialsMessages&) {
  return 0;
}
#else
inline int send_messages(const CvodeMemory& memory, SundialsMessages& messages) {
  return CVodeSetErrHandlerFn(memory.get(), &SundialsMessages::receive, &messages);
}
/// Sends the errors of IDA to `messages`.
inline int send_messages(const IdaMemory& memory, SundialsMessages& messages) {
  return IDASetErrHandlerFn(memory.get(), &SundialsMessages::receive, &messages);
}
/// Sends the errors of ARKStep to `messages`.
inline int send_messages(const ArkstepMemory& memory, SundialsMessages& messages) {
  return ARKStepSetErrHandlerFn(memory.get(), &SundialsMessages::receive, &messages);
}
/// Sends the errors of ERKStep to `messages`.
inline int send_messages(const ErkstepMemory& memory, SundialsMessages& messages) {
  return ERKStepSetErrHandlerFn(memory.get(), &SundialsMessages::receive, &messages);
}
/// Sends the errors of MRIStep to `messages`.
inline int send_messages(const MristepMemory& memory, SundialsMessages& messages) {
  return MRIStepSetErrHandlerFn(memory.get(), &SundialsMessages::receive, &messages);
}
#endif

/// SUNDIALS' name of a return code ("CV_CONV_FAILURE"), from the package's own function.
inline std::string code_name(char* (*name_of)(long int), int code) {
  const std::unique_ptr<char, decltype(&std::free)> text(name_of(code), &std::free);
  return text == nullptr ? "code " + std::to_string(code) : std::string(text.get());
}

}  // namespace tress::integrators
