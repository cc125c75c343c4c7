#include "simulation/head/make_head.h"

#include <limits>
#include <string>
#include <utility>
#include <variant>

#include "contract/input_error.h"
#include "integrators/block/step_limits.h"
#include "models/head/lane_kernel.h"
#include "simulation/head/stepping_head.h"

namespace tress::simulation {
namespace {

using models::HeadNumber;
using models::HeadPack;

constexpr const char* place = "batch";

/// Stiff strands need steps some halvings shorter than the first.
constexpr double room = 16;

/// Throws InputError unless such steps make sense.
void check_steps(const HeadOptions& options, const HeadPack& pack) {
  refuse_if(!(options.newton_tolerance > 0) || options.newton_iterations < 1,
            "no tolerance or no iterations", place, "give positive ones");
  refuse_if(!(options.tolerance >= 0 && options.tolerance < 1),
            "a tolerance that is no part of a length", place, "give one between 0 and 1");
  refuse_if(!(options.min_step >= 0), "a shortest step below 0", place,
            "give one in s, or leave it out");
  refuse_if(options.tolerance > 0 && options.method != HeadMethod::tr_bdf2,
            "a tolerance for equal steps", place, "use tr_bdf2, or give no tolerance");
  refuse_if(options.tolerance > 0 && !resolve(pack.number, options.tolerance),
            "a tolerance that " +
                std::string(pack.number == HeadNumber::float32 ? "32" : "64") +
                " bits do not resolve",
            place, "give a larger one, or use 64 bits");
}

/// Throws InputError if the method starts from an acceleration that strands do not have.
void check_start(const HeadOptions& options) {
  refuse_if(
      options.method == HeadMethod::tr_bdf2 && options.twist && !options.rotary_inertia,
      "no acceleration from which tr_bdf2 starts: twist has no inertia", place,
      "leave rotary_inertia on, or use backward_euler");
}

/// Throws InputError if steps are single corrections in single precision, for strands in
/// which their rounding errors grow.
void check_mended(const HeadOptions& options, const HeadPack& pack) {
  refuse_if(options.method == HeadMethod::linearly_implicit_midpoint &&
                pack.number == HeadNumber::float32,
            "32 bits, whose rounding a single correction does not mend", place,
            "use 64 bits, or tr_bdf2");
}

/// The method whose single correction is from zero acceleration is refused: with the
/// exact Jacobian there, strands of a shaken root are less stable (LinearlyImplicitStep).
void check_quaternions(const HeadOptions& options, const HeadPack& pack) {
  check_steps(options, pack);
  refuse_if(options.method == HeadMethod::linearly_implicit_euler,
            "linearly_implicit_euler with an exact Jacobian", place,
            "use linearly_implicit_midpoint, backward_euler or tr_bdf2");
  check_mended(options, pack);
}

bool linear(const HeadOptions& options) { return block_method(options.method).linear(); }
Jacobian jacobian(const HeadOptions& options) {
  return linear(options) ? Jacobian::elastic : Jacobian::exact;
}

std::unique_ptr<models::Head> in_steps(models::AnyLaneKernel kernel,
                                       const HeadOptions& options) {
  return std::visit(
      [&](auto& own) -> std::unique_ptr<models::Head> {
        return stepping_head(std::move(own), options);
      },
      kernel);
}

}  // namespace

bool resolve(HeadNumber number, double tolerance) {
  const double epsilon = number == HeadNumber::float64
                             ? std::numeric_limits<double>::epsilon()
                             : std::numeric_limits<float>::epsilon();
  const StepLimits limits =
      StepLimits::of(block_method(HeadMethod::tr_bdf2), tolerance, epsilon);
  return limits.first >= room * limits.shortest;
}

std::unique_ptr<models::Head> helix_head(const HeadOptions& options,
                                         const HeadPack& pack) {
  check_steps(options, pack);
  check_start(options);
  if (linear(options)) return stiff_helix_head(options, pack);
  return in_steps(models::helix_lanes(options, pack), options);
}

std::unique_ptr<models::Head> clothoid_head(const HeadOptions& options,
                                            const HeadPack& pack) {
  check_steps(options, pack);
  check_start(options);
  if (linear(options)) return stiff_clothoid_head(options, pack);
  return in_steps(models::clothoid_lanes(options, pack), options);
}

std::unique_ptr<models::Head> chain_head(const HeadOptions& options,
                                         const HeadPack& pack) {
  check_steps(options, pack);
  check_start(options);
  // Joints turn so freely in a step that of 32 bits no digit is left of some corrections:
  // rounding grows from step to step until strands are lost.
  check_mended(options, pack);
  if (linear(options)) return stiff_chain_head(options, pack);
  return in_steps(models::chain_lanes(options, pack), options);
}

std::unique_ptr<models::Head> der_head(const HeadOptions& options, const HeadPack& pack) {
  check_steps(options, pack);
  check_start(options);
  // Stretching keeps what rounding puts into it: in a second strands are off by 6e-4 of
  // their length.
  check_mended(options, pack);
  return in_steps(models::der_lanes(options, pack, jacobian(options)), options);
}

std::unique_ptr<models::Head> spring_head(const HeadOptions& options,
                                          const HeadPack& pack) {
  check_steps(options, pack);
  return in_steps(models::spring_lanes(options, pack, jacobian(options)), options);
}

std::unique_ptr<models::Head> corde_head(const HeadOptions& options,
                                         const HeadPack& pack) {
  check_quaternions(options, pack);
  return in_steps(models::corde_lanes(options, pack), options);
}

std::unique_ptr<models::Head> cosserat_head(const HeadOptions& options,
                                            const HeadPack& pack) {
  check_quaternions(options, pack);
  return in_steps(models::cosserat_lanes(options, pack), options);
}

}  // namespace tress::simulation
