#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "simulation/scene_changes/changes.h"

namespace tress::experiments::cost_of_accuracy {

/// Model, integrator and options of a run, and the way to choose its accuracy.
struct Method : simulation::Method {
  Refresh refresh = Refresh::every_iteration;
  /// Adaptive: the tolerance falls with the "substeps" s as an error of steps 1/s does,
  /// so that work rises with s as with a number of steps (tolerance_of).
  bool by_tolerance = false;
  /// Tips with n and n/2 elements, extrapolated as an error that falls with the model's
  /// power of them (extrapolation). Not where something touches: the instant of contact
  /// depends on the elements.
  bool extrapolated = false;
  /// Elements share what bends a strand at rest; else they are those of the scene.
  bool cut_at_rest = false;
};

/// Step or tolerance that decides the accuracy of a run in time: one of the two is 0.
struct Accuracy {
  double step = 0;       // s
  double tolerance = 0;  // of the length
};

/// A frame of 1/rate in s steps; adaptive: tolerance 0.1 (fineness_unit/s)^p over the
/// length, p the method's order, to two digits. A looser tolerance than 0.1 does not
/// control the error: its longest steps are right or wrong by luck.
inline constexpr int fineness_unit = 8;
Accuracy accuracy(const Method& method, int substeps, double rate);

/// Steps of a run that an integer s counts as one, its fewest (fineness_unit, or 1), and
/// the work of
/// a frame, in elements x steps of one linear solve.
int steps_unit(const Method& method);
double frame_work(const Method& method, int elements, int substeps);

/// Returns the number of elements of the coarser part of an extrapolated run.
inline int coarser(int elements) { return (elements + 1) / 2; }

/// Returns c of the limit x_n + c (x_n - x_m) of an error C/n^p [Richardson 1911]. The
/// model's order is p, the number of elements n and m = coarser(n). c is 1/3 for p = 2
/// and n = 2 m.
double extrapolation(const Method& method, int elements);

/// Whether the error of a run may be extrapolated in elements: nothing touches, and no
/// point is held, which need not be a point of half the elements.
bool may_extrapolate(const Scene& scene);

/// A scene whose model, integrator, numbers of elements and steps are left open. Throws
/// InputError as read_scene does, and where the scene has no strand, strands that
/// touch each other, or a point at which no equal elements end (element_unit).
Scene read_open_scene(const std::string& file);

/// Returns whether the scene has supports or joints.
bool held(const Scene& scene);

/// The scene by this method, with `elements` per strand, `rate` frames per second and
/// this step or tolerance. Throws InputError as with_elements does.
Scene trial_scene(Scene given, const Method& method, int elements, Accuracy accuracy,
                  double rate);
/// Returns the scene with steps that divide a frame, or a tolerance, of `substeps`.
/// Throws as above.
Scene trial_scene(Scene given, const Method& method, int elements, int substeps,
                  double rate);

/// Everything that determines the continuous solution, for keys of references: the scene
/// without the open choices, and the contents of the files it names.
std::string physics(Scene scene);

/// Newton's corrections below 1e-6 of the scale of an unknown, with fixed steps: a
/// hundredth of the smallest target error.
inline constexpr double newton_tolerance = 1e-6;

/// Choice of methods: every strand model with its options and every integrator that can
/// drive it on this scene. Methods with error control run with fixed steps and adaptive,
/// unless a Jacobian decides about their steps. Adaptive runs are also extrapolated.
/// Other adaptive methods are left out: they control an error of the unknowns and not of
/// the strand. Options that lose digits (models::loses_digits) are left out as well.
struct MethodChoice {
  std::vector<std::string> models, integrators;  // empty: all
  /// Varied options of models, "key" or "key=word"; empty: all. `modes` and `jacobian` in
  /// all pairs, others one at a time.
  std::vector<std::string> options;
  /// Integrators with error control also with fixed steps.
  bool fixed_steps = true;
  /// Adaptive runs are also extrapolated.
  bool extrapolated = true;
  /// Elements also as strands at rest need them, where a scene leaves that open.
  bool cuts_at_rest = false;
  /// When integrators that iterate rebuild their matrix.
  std::vector<Refresh> refreshes = {Refresh::every_iteration, Refresh::every_step,
                                    Refresh::when_slow};
  /// Further integrators, tried with the default options of the models.
  std::vector<std::string> plain = {};
};

/// Integrators whose cheapest run has a row of its own for each target error, in kind
/// `without`. Other solver packages are known for these methods.
inline constexpr std::string_view always_shown[] = {"radau5", "rodas5p"};

std::vector<Method> methods(const Scene& given, const MethodChoice& choice);

/// A model or an integrator of a choice without a method, and the reason.
struct LeftOut {
  std::string id, why;
};
/// Returns those without a method among `taken`, which are methods().
std::vector<LeftOut> left_out(const Scene& given, const MethodChoice& choice,
                              const std::vector<Method>& taken);

/// Methods that differ from `method` in this one option of the model and can represent
/// the scene.
std::vector<Method> with_other_words(const Scene& given, const Method& method,
                                     std::string_view choice);

/// The model's options.
std::vector<std::string_view> choices_of(const ModelEntry& model);

/// Whether two methods agree in model, integrator, options and everything else.
bool same(const Method& a, const Method& b);

}  // namespace tress::experiments::cost_of_accuracy
