#include <fmt/format.h>

#include <algorithm>
#include <memory>
#include <string>

#include "contract/input_error.h"
#include "experiments/calibrate/calibrate.h"
#include "experiments/calibrate/point_fit.h"
#include "experiments/calibrate/shipped_records.h"
#include "experiments/problems/strand_models.h"
#include "experiments/run/settings.h"
#include "integrators/catalogue.h"
#include "simulation/files/parse.h"

namespace tress::experiments::calibrate {
namespace {

using calibrate::damping, calibrate::fitting;

constexpr Parameter settings_of_rows[] = {
    {.name = "data",
     .help = "CSV files, separated by ','. Oscillations: t_s,amplitude_m[,sigma_m]"
             "[,parameters of the strand]. Points of the strands of --scene: "
             "time_s,x_m,y_m,z_m[,strand][,point][,sigma_m]. Empty: those of "
             "experiments/calibrate/data",
     .text = true},
    {.name = "by",
     .help = "parameters to fit to points, separated by ',', by the names of [gradient] "
             "by; empty: those of the scene's [gradient]",
     .text = true},
    {.name = "bounds",
     .help = "limits of parameters of `by`: NAME:LOW:HIGH, separated by ','",
     .text = true},
    {.name = "priors",
     .help = "values and standard errors of parameters of `by` from before the records: "
             "NAME:VALUE:SIGMA, separated by ','",
     .text = true},
    {.name = "profile",
     .help =
         "intervals of parameters of `by` also by their profiles, which are right where "
         "linear ones are not; about 20 runs for each end",
     .choices = "off|on"},
    {.name = "signal",
     .help = "amplitude_m is the tip's displacement from the root, up to a constant, or "
             "half the difference of successive turning points, midway between them",
     .choices = "displacement|envelope"},
    {.name = "axis", .help = "axis of the displacement; z is up", .choices = "z|x|y"},
    {.name = "fit",
     .help =
         "fitted values: internal friction gamma, air drag nu, Young's modulus "
         "(stiffness), both = gamma and nu, all = these and stiffness; the others are "
         "parameters",
     .choices = "both|gamma|nu|stiffness|stiffness_gamma|stiffness_nu|all"},
    {.name = "confidence",
     .help = "confidence level of the intervals",
     .number = 0.95,
     .min = 0.5,
     .max = 0.9999},
    {.name = "scenes", .help = "scene files that define the strand", .text = true},
    {.name = "horizon_s",
     .help = "length of the record of a scene without data, at most the scene's (s)",
     .number = 1.5,
     .min = 1e-3,
     .max = 1e3},
    {.name = "noise_m",
     .help = "standard error of the record of a scene without data (m)",
     .number = 5e-4,
     .min = 1e-12,
     .max = 1e3},
    {.name = "noise_seed",
     .help = "random seed of the noise",
     .number = 1,
     .min = 0,
     .max = 1e9,
     .whole = true},
};

/// Options of one file of experiments/calibrate/data. A fit of stiffness starts from half
/// the true modulus.
struct Shown {
  std::string_view data, fit, integrator;
  bool slow = false;  // not with --quick
};
constexpr double usual_step = 2e-3;  // s
constexpr double most_work = 2e7;    // per run of a scene
constexpr Shown shown[] = {
    {"two_lengths", "both", fitting},          {"two_lengths", "both", damping},
    {"two_lengths", "all", fitting},           {"two_lengths", "stiffness", fitting},
    {"two_lengths_envelope", "both", fitting}, {"one_length", "both", fitting},
    {"one_length", "gamma", fitting},          {"one_length", "nu", fitting},
    {"curly_span", "gamma", fitting, true},
};

class Cases {
 public:
  explicit Cases(const CommandLine& line)
      : line_(line),
        settings_(line, calibrate_settings()),
        own_(settings_.experiment()) {}

  std::vector<Case> all() {
    if (are_points(files())) {
      const PointFit fit = point_fit(line_, settings_);
      Case& one = all_.emplace_back();
      one.identity = fit.identity();
      one.run_rows = [fit](const Row& row, const Deadline&) { return fit.rows(row); };
      return std::move(all_);
    }
    for (const std::string_view key : {"by", "bounds", "priors", "profile"}) {
      refuse_if(settings_.chosen(key), fmt::format("'{}' is of records of points", key),
                line_.place(fmt::format("set:{}", key)),
                "give data with the columns time_s, x_m, y_m, z_m");
    }
    if (observed() == Observed::envelope &&
        fits(fitted_of(own_.word("fit")), Fitted::stiffness)) {
      throw InputError("an envelope has no frequency, from which stiffness follows",
                       line_.place("set:fit"), "give records of signal=displacement");
    }
    if (!own_.word("scenes").empty()) {
      add_scenes();
    } else if (own_.word("data").empty()) {
      add_shipped();
    } else {
      add_measured();
    }
    return std::move(all_);
  }

 private:
  std::vector<std::string> files() const {
    if (own_.word("data").empty()) return {};
    return split(own_.word("data"), ',', line_.place("set:data"));
  }

  FitOptions options(std::string_view integrator, std::string_view fit) const {
    FitOptions how;
    how.integrator = integrator;
    Options start;
    start.step = usual_step;
    start.refresh = Refresh::every_step;
    how.options = settings_.options(start);
    how.fitted = fitted_of(fit);
    const std::string_view axes = "xyz";
    how.axis = static_cast<int>(axes.find(own_.word("axis")));
    how.confidence = own_.number("confidence");
    return how;
  }

  Observed observed() const {
    return own_.word("signal") == "envelope" ? Observed::envelope
                                             : Observed::displacement;
  }

  std::vector<std::string_view> methods(std::string_view usual) const {
    std::vector<std::string_view> chosen;
    for (const std::string& id : line_.integrators) {
      chosen.push_back(find_integrator(id).id);
    }
    if (chosen.empty()) chosen.push_back(usual);
    return chosen;
  }

  std::vector<const ModelEntry*> model_catalogue() const {
    if (line_.models.empty()) return {&find_model("super_helix")};
    std::vector<const ModelEntry*> chosen;
    for (const ModelEntry* model : strand_models()) {
      if (wanted(line_.models, model->id)) chosen.push_back(model);
    }
    return chosen;
  }

  /// One row per number of elements; none given: the model's setting.
  void add(const FitRow& work, const Parameters& parameters) {
    std::vector<int> counts = line_.elements;
    if (counts.empty()) counts = {parameters.whole("elements")};
    for (const int elements : counts) {
      Parameters p = parameters;
      p.set("elements", std::to_string(elements));
      FitRow one = work;
      one.strands = strands_of(*one.records, *one.model, p, one.how.fitted);
      one.elements = elements;
      add(one);
    }
  }

  void add(const FitRow& work) {
    for (const Specimen& strand : work.strands) {  // refuses what cannot be built
      Properties properties = strand.properties;
      if (fits(work.how.fitted, Fitted::gamma)) properties.gamma = 1e-12;
      static_cast<void>(strand.build(properties, 1));
    }
    all_.push_back(
        {work.identity(), [work](Row& row, const Deadline&) { work.measure(row); }});
  }

  void add_scenes() {
    leave_strands_to_the_scene(line_);
    settings_.leave_models_to_the_scene();
    const auto files = listed_files(own_.word("scenes"), line_.place("set:scenes"));
    const bool measured = !own_.word("data").empty();
    if (measured && files.size() > 1) {
      throw InputError("several scenes, but data is of one strand",
                       line_.place("set:scenes"), "give one scene");
    }
    for (const Scene& scene : read_scenes(files)) {
      static_cast<void>(specimen(scene));  // refuses a scene without a strand
      for (const std::string_view method :
           methods(find_integrator(scene.integrator).id)) {
        FitRow work{scene.name, nullptr, {}, scene.model, {}, options(method, "both"), 0};
        work.elements = static_cast<int>(scene.strands.front().segments.size());
        work.how.options = settings_.options(scene.options);
        if (work.how.options.max_work == 0) work.how.options.max_work = most_work;
        work.how.observed = observed();
        if (measured) {
          add_measured(scene, work);
        } else {
          add_simulated(scene, work);
        }
      }
    }
  }

  void add_measured(const Scene& scene, FitRow work) {
    for (const std::string& file : files()) {
      work.data = file;
      work.records = std::make_shared<const Records>(read_records(file, observed()));
      work.strands = strands_of(*work.records, scene);
      work.how.fitted = fitted_of(own_.word("fit"));
      add(work);
    }
  }

  /// Fits of records simulated from the scene itself.
  void add_simulated(const Scene& scene, FitRow work) {
    if (observed() == Observed::envelope) {
      throw InputError("a scene's own record is a displacement",
                       line_.place("set:signal"), "leave it out, or give data=file.csv");
    }
    work.records = std::make_shared<const Records>();
    work.strands = {specimen(scene)};
    work.truth = work.strands.front().properties;
    work.simulate = {
        std::min(own_.number("horizon_s"), scene.duration),
        {own_.number("noise_m"), static_cast<std::uint64_t>(own_.number("noise_seed"))}};
    const bool gamma = work.truth->gamma > 0, nu = work.truth->nu > 0;
    bool any = false;
    for (const Fitted fit :
         {Fitted::both, Fitted::gamma, Fitted::nu, Fitted::stiffness,
          Fitted::stiffness_gamma, Fitted::stiffness_nu, Fitted::all}) {
      if (settings_.chosen("fit") && own_.word("fit") != name(fit)) continue;
      if (!gamma && fits(fit, Fitted::gamma)) continue;
      if (!nu && fits(fit, Fitted::nu)) continue;
      work.how.fitted = fit;
      add(work);
      any = true;
    }
    if (any) return;
    throw InputError("the scene has nothing of what is to be found",
                     "scene " + scene.name,
                     "give internal_friction_kg_m3_s, [effects.linear_drag] with "
                     "drag_kg_m_s, or another fit");
  }

  void add_measured() {
    const std::string_view fit = own_.word("fit");
    for (const std::string& file : files()) {
      const auto records =
          std::make_shared<const Records>(read_records(file, observed()));
      for (const ModelEntry* model : model_catalogue()) {
        for (const std::string_view method : methods(fitting)) {
          FitRow work{file, records, {}, model, {}, options(method, fit), 0};
          work.how.observed = observed();
          add(work, settings_.parameters(*model));
        }
      }
    }
  }

  void add_shipped() {
    if (own_.word("axis") != "z") {
      throw InputError("the files of experiments/calibrate/data tell heights",
                       line_.place("set:axis"), "leave it out, or give data=file.csv");
    }
    for (const Shown& row : shown) {
      if (settings_.chosen("fit") && own_.word("fit") != row.fit) continue;
      if (line_.quick && row.slow) continue;
      // The chosen methods replace the fitting one.
      if (!line_.integrators.empty() && row.integrator != fitting) continue;
      const ShippedRecords& shipped =
          *std::ranges::find(shipped_records(), row.data, &ShippedRecords::name);
      if (settings_.chosen("signal") && observed() != shipped.observed) continue;
      const auto records = std::make_shared<const Records>(
          read_records(file_of(shipped), shipped.observed));
      for (const ModelEntry* model : model_catalogue()) {
        for (const std::string_view method : methods(row.integrator)) {
          FitRow work{std::string(row.data),    records, shipped.truth, model, {},
                      options(method, row.fit), 0};
          work.how.observed = shipped.observed;
          Parameters p = parameters(shipped, *model);
          if (fits(work.how.fitted, Fitted::stiffness)) {
            p.set(stiffness_key, fmt::format("{}", shipped.truth.youngs_modulus / 2));
            // A frequency is measured more accurately than a decay.
            p.set("elements", fmt::format("{}", 2 * shipped.elements));
          }
          add(work, p);
        }
      }
    }
  }

  Parameters parameters(const ShippedRecords& shipped, const ModelEntry& model) const {
    Parameters p = settings_.parameters(model);
    for (const auto& [key, value] : settings_of(shipped, shipped.elements)) {
      const bool word_known = key != "modes" || has_word(model, key, value);
      if (p.knows(key) && word_known && !settings_.chosen(key)) p.set(key, value);
    }
    return p;
  }

  const CommandLine& line_;
  const Settings settings_;
  const Parameters& own_;
  std::vector<Case> all_;
};

}  // namespace

std::span<const Parameter> calibrate_settings() { return settings_of_rows; }

std::vector<Case> calibrate_cases(const CommandLine& line) { return Cases(line).all(); }

}  // namespace tress::experiments::calibrate
