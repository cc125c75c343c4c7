// Which internal friction and which air drag does a measured oscillation of a strand
// tell, and how well? Without data of one's own: does a fit find the truth of simulated
// records?
#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include "contract/input_error.h"
#include "experiments/calibrate/calibrate_claims.h"
#include "experiments/calibrate/friction_fit.h"
#include "experiments/calibrate/shipped_records.h"
#include "experiments/problems/strand_models.h"
#include "experiments/run/experiment.h"
#include "experiments/run/settings.h"
#include "integrators/catalogue.h"
#include "simulation/files/parse.h"

namespace tress {
namespace {

using calibrate::damping, calibrate::fitting;

constexpr Column columns[] = {
    {"data",
     "file, or the name of one in experiments/calibrate/data, whose truth is known"},
    {"data_hash", "of its text"},
    {"signal", "displacement of the tip, or envelope of it"},
    {"axis", "along which"},
    {"fit", "both, gamma or nu; the other one is known"},
    {"model", "catalogue id"},
    {"integrator", "method"},
    {"elements", "number of elements"},
    {"confidence", "of the intervals"},
    {"records", "oscillations fitted at once"},
    {"points", "of all records"},
    {"gamma_kg_m3_s", "internal friction"},
    {"gamma_low_kg_m3_s", "lower end of its interval; empty: known, not fitted"},
    {"gamma_high_kg_m3_s", "upper end"},
    {"gamma_true_kg_m3_s", "with which a file of experiments/calibrate/data was made"},
    {"nu_kg_m_s", "air drag per length"},
    {"nu_low_kg_m_s", "lower end of its interval; empty: known, not fitted"},
    {"nu_high_kg_m_s", "upper end"},
    {"nu_true_kg_m_s", "with which a file of experiments/calibrate/data was made"},
    {"correlation", "of ln gamma and ln nu"},
    {"condition", "of the derivatives of the signal with respect to these"},
    {"residual_rms_m", "root mean square of measured less fitted"},
    {"reduced_chi2", "sum of squares over sigma_m, over the degrees of freedom"},
    {"autocorrelation", "of successive residuals: near 0 for errors of measurement"},
    {"step_shift", "largest move of a fitted value with half the step, half-intervals"},
    {"elements_shift", "the same with twice as many elements"},
    {"degrees", "of freedom"},
    {"evaluations", "simulations of all records"},
};

constexpr Parameter settings_of_rows[] = {
    {.name = "data",
     .help = "CSV files, separated by ',': t_s,amplitude_m[,sigma_m][,parameters of the "
             "strand]; empty: those of experiments/calibrate/data",
     .text = true},
    {.name = "signal",
     .help = "amplitude_m is the tip's displacement from the root, up to a constant, or "
             "half the difference of successive turning points, midway between them",
     .choices = "displacement|envelope"},
    {.name = "axis", .help = "of the displacement; z is up", .choices = "z|x|y"},
    {.name = "fit",
     .help = "internal friction gamma, air drag nu; what is not fitted is a parameter",
     .choices = "both|gamma|nu"},
    {.name = "confidence",
     .help = "of the intervals",
     .number = 0.95,
     .min = 0.5,
     .max = 0.9999},
};

/// What a file of experiments/calibrate/data is to show.
struct Shown {
  std::string_view data, fit, integrator;
  bool slow = false;  // not with --quick
};
constexpr double usual_step = 2e-3;  // s
constexpr Shown shown[] = {
    {"two_lengths", "both", fitting},          {"two_lengths", "both", damping},
    {"two_lengths_envelope", "both", fitting}, {"one_length", "both", fitting},
    {"one_length", "gamma", fitting},          {"one_length", "nu", fitting},
    {"curly_span", "gamma", fitting, true},
};

Fitted fitted_of(std::string_view word) {
  return word == "both" ? Fitted::both : word == "gamma" ? Fitted::gamma : Fitted::nu;
}

struct Work {
  std::string data;
  std::shared_ptr<const Records> records;
  const ShippedRecords* shipped;  // null: the user's
  const ModelEntry* model;
  std::vector<Parameters> strands;
  FitOptions how;

  Row identity(std::string_view fit, const Parameters& settings, int elements) const {
    Row row;
    row.set("data", data).set("data_hash", records->hash);
    row.set("signal", how.observed == Observed::envelope ? "envelope" : "displacement");
    row.set("axis", settings.word("axis")).set("fit", fit).set("model", model->id);
    row.set("integrator", how.integrator).set("elements", elements);
    row.set("confidence", how.confidence);
    return row;
  }
};

void set(Row& row, const Estimate& estimate, const std::string& name,
         const std::string& unit) {
  row.set(name + unit, estimate.value);
  row.set(name + "_low" + unit, estimate.low).set(name + "_high" + unit, estimate.high);
}

void measure(const Work& work, Row& row) {
  const auto system = work.model->make(work.strands.front());
  const std::string objection = refusal(find_integrator(work.how.integrator), *system,
                                        work.how.options.formulation);
  if (!objection.empty()) {
    row.failed("refused", objection);
    return;
  }
  if (work.shipped != nullptr) {
    row.set("gamma_true_kg_m3_s", work.shipped->gamma);
    row.set("nu_true_kg_m_s", work.shipped->nu);
  }
  const FrictionFit fit =
      fit_friction(*work.records, *work.model, work.strands, work.how);
  row.set("records", work.records->all.size()).set("points", work.records->points());
  set(row, fit.gamma, "gamma", "_kg_m3_s");
  set(row, fit.nu, "nu", "_kg_m_s");
  row.set("correlation", fit.correlation).set("condition", fit.condition);
  row.set("residual_rms_m", fit.rms).set("reduced_chi2", fit.reduced_chi2);
  row.set("autocorrelation", fit.autocorrelation).set("step_shift", fit.step_shift);
  row.set("elements_shift", fit.elements_shift);
  row.set("degrees", fit.degrees).set("evaluations", fit.evaluations);
  if (fit.status != "ok") row.failed(fit.status, fit.reason);
}

class Cases {
 public:
  explicit Cases(const CommandLine& line)
      : line_(line), settings_(line, settings_of_rows), own_(settings_.experiment()) {}

  std::vector<Case> all() {
    if (own_.word("data").empty()) {
      add_shipped();
    } else {
      add_measured();
    }
    return std::move(all_);
  }

 private:
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

  std::vector<const ModelEntry*> models() const {
    if (line_.models.empty()) return {&find_model("super_helix")};
    std::vector<const ModelEntry*> chosen;
    for (const ModelEntry* model : strand_models()) {
      if (wanted(line_.models, model->id)) chosen.push_back(model);
    }
    return chosen;
  }

  /// One row for each number of elements; none given: those of the model as it is set.
  void add(const Work& work, const Parameters& parameters, std::string_view fit) {
    std::vector<int> counts = line_.elements;
    if (counts.empty()) counts = {parameters.whole("elements")};
    for (const int elements : counts) {
      Parameters p = parameters;
      p.set("elements", std::to_string(elements));
      Work one = work;
      one.strands = strands_of(*one.records, p, one.how.fitted);
      for (Parameters strand : one.strands) {  // refuses what cannot be made
        if (one.how.fitted != Fitted::nu)
          strand.set("internal_friction_kg_m3_s", "1e-12");
        static_cast<void>(one.model->make(strand));
      }
      all_.push_back({one.identity(fit, own_, elements),
                      [one](Row& row, const Deadline&) { measure(one, row); }});
    }
  }

  void add_measured() {
    const std::string_view fit = own_.word("fit");
    for (const std::string& file :
         split(own_.word("data"), ',', line_.place("set:data"))) {
      const auto records =
          std::make_shared<const Records>(read_records(file, observed()));
      for (const ModelEntry* model : models()) {
        for (const std::string_view method : methods(fitting)) {
          Work work{file, records, nullptr, model, {}, options(method, fit)};
          work.how.observed = observed();
          add(work, settings_.parameters(*model), fit);
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
      // The methods chosen stand in for the one that fits.
      if (!line_.integrators.empty() && row.integrator != fitting) continue;
      const ShippedRecords& shipped =
          *std::ranges::find(shipped_records(), row.data, &ShippedRecords::name);
      if (settings_.chosen("signal") && observed() != shipped.observed) continue;
      const auto records = std::make_shared<const Records>(
          read_records(file_of(shipped), shipped.observed));
      for (const ModelEntry* model : models()) {
        for (const std::string_view method : methods(row.integrator)) {
          Work work{std::string(row.data),   records, &shipped, model, {},
                    options(method, row.fit)};
          work.how.observed = shipped.observed;
          add(work, parameters(shipped, *model), row.fit);
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

std::vector<Case> cases(const CommandLine& line) { return Cases(line).all(); }

/// Of simulated records: what they are there to show.
bool finding(const Row& row) {
  return row.has("gamma_true_kg_m3_s") &&
         (row.status() == "not_identified" || row.status() == "time_error");
}

constexpr Unused unused[] = {not_repeated, not_random};

}  // namespace
}  // namespace tress

int main(int argc, char** argv) {
  using namespace tress;
  const Experiment experiment{
      .name = "calibrate",
      .question =
          "which internal friction and air drag does a measured oscillation tell?",
      .example = "--set data=measured.csv --set length_m=0.15 --set fit=gamma",
      .timed = false,
      .columns = columns,
      .settings = settings_of_rows,
      .unused = unused,
      .cases = cases,
      .checks = check_calibrate_claims,
      .finding = finding};
  return run_experiment(experiment, argc, argv);
}
