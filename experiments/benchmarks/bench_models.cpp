// Every call of the contract (contract/system.h) on every model of the catalogue: the
// chain, the beam and the strands over sizes, the others as they come. A new model is
// measured by itself.
#include <algorithm>
#include <memory>

#include "contract/forms/constraint_form.h"
#include "contract/forms/explicit_form.h"
#include "contract/forms/sparse_form.h"
#include "experiments/benchmarks/fixture.h"

namespace tress::experiments::benchmarks {
namespace {

constexpr double h = 1e-3;  // s
constexpr Weights backward_euler{1, h, h* h};

struct Operation {
  std::string_view name;
  bool (*offered)(System&);
  Status (*call)(Moving&);
  Status (*prepare)(Moving&) = nullptr;
};

bool always(System&) { return true; }
bool regular_mass(System& system) { return system.traits().regular_mass; }
bool sparse(System& system) { return system.sparse_form() != nullptr; }
bool explicit_form(System& system) { return system.explicit_form() != nullptr; }
bool constrained(System& system) { return system.constraint_form() != nullptr; }

Status linearize(Moving& x) {
  return x.system->linearize(x.t, x.state.q, x.state.v, x.a, backward_euler);
}
Status residual(Moving& x) {
  return x.system->residual(x.t, x.state.q, x.state.v, x.a, x.first(x.a.size()));
}
Status solve(Moving& x) { return x.system->solve(x.a, x.first(x.a.size())); }
Status sparse_values(Moving& x) {
  SparseForm& form = *x.system->sparse_form();
  const auto nonzeros = static_cast<std::size_t>(form.pattern().nonzeros());
  return form.values(x.t, x.state.q, x.state.v, x.a, backward_euler, x.first(nonzeros));
}
Status acceleration(Moving& x) {
  return x.system->explicit_form()->acceleration(x.t, x.state.q, x.state.v,
                                                 x.first(x.a.size()));
}
Status constraint_value(Moving& x) {
  return x.system->constraint_form()->value(x.t, x.state.q, x.first(x.lambda.size()));
}
Status constraint_gradient(Moving& x) {
  ConstraintForm& form = *x.system->constraint_form();
  const auto nonzeros = static_cast<std::size_t>(form.pattern().nonzeros());
  return form.gradient(x.t, x.state.q, x.first(nonzeros));
}
Status constraint_bias(Moving& x) {
  return x.system->constraint_form()->bias(x.t, x.state.q, x.state.v,
                                           x.first(x.lambda.size()));
}

constexpr Operation operations[] = {
    {"residual", always, residual},
    {"linearize", regular_mass, linearize},
    {"solve", regular_mass, solve, linearize},
    {"sparse_values", sparse, sparse_values},
    {"acceleration", explicit_form, acceleration},
    {"constraint_value", constrained, constraint_value},
    {"constraint_gradient", constrained, constraint_gradient},
    {"constraint_bias", constrained, constraint_bias},
};

/// A model measured over sizes: the parameter that sets the size.
struct Sized {
  std::string_view model;
  ModelSettings (*settings)(int size);
  std::span<const int> sizes;
};

ModelSettings beam(int segments) { return {{"segments", std::to_string(segments)}}; }

ModelSettings strand(int elements) { return {{"elements", std::to_string(elements)}}; }

constexpr std::array beam_segments = {10, 40, 160, 640, 1280};
constexpr std::array strand_elements = {5, 20, 80, 320};
constexpr std::array sized_models = {
    Sized{"inextensible_chain", spinning_chain, chain_links},
    Sized{"beam", beam, beam_segments},
    Sized{"super_helix", strand, strand_elements},
    Sized{"articulated_chain", strand, strand_elements},
};

void run(benchmark::State& state, const Operation& operation, Moving& moving) {
  if (moving.status != Status::ok ||
      (operation.prepare != nullptr && operation.prepare(moving) != Status::ok)) {
    state.SkipWithError("no state to measure at");
    return;
  }
  measure(state, [&] { return operation.call(moving); });
}

void register_model(const ModelEntry& entry) {
  const auto sized = std::ranges::find(sized_models, entry.id, &Sized::model);
  const bool fixed = sized == sized_models.end();
  const auto family = fixed ? std::make_shared<MovingFamily>(
                                  entry.id, [](int) { return ModelSettings{}; })
                            : std::make_shared<MovingFamily>(entry.id, sized->settings);
  const auto system = make_model(entry.id);
  for (const Operation& operation : operations) {
    if (!operation.offered(*system)) continue;
    const std::string name = std::string(entry.id) + '/' + std::string(operation.name);
    if (fixed) {
      benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
        run(state, operation, family->at(0));
      });
      continue;
    }
    auto* registered =
        benchmark::RegisterBenchmark(name.c_str(), [=](benchmark::State& state) {
          const auto size = static_cast<int>(state.range(0));
          run(state, operation, family->at(size));
          state.SetComplexityN(size);
          count_per_element(state, size);
        });
    with_sizes(registered, sized->sizes);
  }
}

}  // namespace
}  // namespace tress::experiments::benchmarks

int main(int argc, char** argv) {
  for (const tress::models::ModelEntry& entry : tress::models::model_catalogue())
    tress::experiments::benchmarks::register_model(entry);
  return tress::experiments::benchmarks::run_benchmarks(argc, argv).exit_code;
}
