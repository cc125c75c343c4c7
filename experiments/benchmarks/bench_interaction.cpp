// Interaction between strands: update, loads and derivatives of a head in motion, by
// strands at equal density and by density, as multiples of the reference kernel.
#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "experiments/benchmarks/fixture.h"
#include "experiments/benchmarks/reference_strands.h"
#include "models/effects/strand_interaction.h"
#include "simulation/run/timing.h"

namespace tress::experiments::benchmarks {
namespace {

constexpr int elements = 10, points_of_element = 4;
constexpr double element = 0.02, step = 3e-3;  // m, s
constexpr models::ContactLaw::Values law{
    .stiffness = 2e-4, .viscosity = 2e-3, .inner = 3e-3, .outer = 6e-3};

/// Hair that hangs from a flat head, which shakes and turns; every strand swings with a
/// phase of its own.
class Hanging {
 public:
  /// `near`: other strands within the law's outer radius of a point, on average. Strands
  /// follow each other row by row, or in no order.
  Hanging(std::size_t strands, double near, double swing, bool shuffled)
      : strands_(strands),
        swing_(swing),
        interaction_({law, "benchmark"}, std::vector<int>(strands, elements + 1)),
        x_(3 * (elements + 1) * strands),
        v_(x_.size()) {
    const double apart = law.outer * std::sqrt(std::numbers::pi / near);
    const auto row = static_cast<std::size_t>(std::ceil(std::sqrt(strands)));
    for (std::size_t k = 0; k < strands; ++k) {
      const double a = noise(2 * k), b = noise(2 * k + 1);
      roots_.push_back({apart * (static_cast<double>(k % row) + a),
                        apart * (static_cast<double>(k / row) + b), 0});
      effects_.push_back(interaction_.effect(k));
    }
    for (std::size_t k = strands; shuffled && k-- > 1;) {
      std::swap(roots_[k],
                roots_[static_cast<std::size_t>(noise(k) * static_cast<double>(k + 1))]);
    }
    move();
  }

  /// To the next step: not part of what is measured.
  void move() {
    t_ += step;
    for (std::size_t k = 0; k < strands_; ++k) {
      for (int i = 0; i <= elements; ++i) {
        const std::size_t at = 3 * (k * (elements + 1) + static_cast<std::size_t>(i));
        const Vec now = place(k, i, t_), next = place(k, i, t_ + 1e-6);
        store3(now, &x_[at]);
        store3(1e6 * (next - now), &v_[at]);
      }
    }
  }

  void update() { interaction_.update(x_, v_); }

  /// Sum of all loads and derivatives, so that nothing is left out.
  double loads() {
    constexpr int count = elements * points_of_element;
    double x[3 * count], v[3 * count], f[3 * count] = {}, blocks[9 * count] = {};
    static const std::vector<double> length(count, element / points_of_element);
    const models::Points p{count, x, v, {}, {}, length};
    double sum = 0;
    for (std::size_t k = 0; k < strands_; ++k) {
      for (int i = 0; i < count; ++i) {
        const auto node =
            k * (elements + 1) + static_cast<std::size_t>(i / points_of_element);
        const double s = (i % points_of_element + 0.5) / points_of_element;
        for (std::size_t c = 0; c < 3; ++c) {
          const std::size_t at = 3 * static_cast<std::size_t>(i) + c;
          x[at] = (1 - s) * x_[3 * node + c] + s * x_[3 * node + 3 + c];
          v[at] = (1 - s) * v_[3 * node + c] + s * v_[3 * node + 3 + c];
        }
      }
      effects_[k]->add_both(t_, p, 1, 1, f, blocks);
      sum += f[0] + blocks[0];
    }
    return sum;
  }

  const models::StrandInteraction& interaction() const { return interaction_; }
  const std::vector<double>& places() const { return x_; }
  std::size_t elements_of_all() const { return strands_ * elements; }

 private:
  static double noise(std::size_t k) {
    const double x = 0.5 + 12345.678 * std::sin(0.713 * static_cast<double>(k) + 0.1);
    return x - std::floor(x);
  }

  Vec place(std::size_t strand, int node, double t) const {
    const double s = static_cast<double>(node) / elements;
    const double phase = 2 * std::numbers::pi * noise(strand + 17), w = 12;
    // At the tip as fast as swing_ relative to the head.
    const double off =
        swing_ / w * s * std::sin(w * t + phase) + 0.004 * s * std::sin(6 * s + phase);
    const Vec hair{roots_[strand].x + off, roots_[strand].y + 0.5 * off,
                   -element * elements * s};
    const double turn = 0.3 * std::sin(5 * t);
    return rotation({0, 0, 1}, turn) * hair +
           Vec{0.1 * std::sin(8 * t), 0, 0.03 * std::sin(11 * t)};
  }

  std::size_t strands_;
  double swing_, t_ = 0;
  models::StrandInteraction interaction_;
  std::vector<std::unique_ptr<const models::Effect>> effects_;
  std::vector<Vec> roots_;
  std::vector<double> x_, v_;
};

struct Line {
  std::size_t strands;
  double near, swing;  // m/s
  bool shuffled;
};

struct Cost {
  double update, loads;  // s an element and step
  double epochs;         // in which segments are sorted, a step
};
Cost cost(const Line& line) {
  Hanging hair(line.strands, line.near, line.swing, line.shuffled);
  constexpr int warm = 10;
  const int steps = line.strands > 20000 ? 12 : 40;
  Cost sum{};
  long before = 0;
  for (int s = 0; s < warm + steps; ++s) {
    hair.move();
    const double update = seconds_of([&] { hair.update(); });
    const double loads = seconds_of([&] { benchmark::DoNotOptimize(hair.loads()); });
    if (s == warm - 1) before = hair.interaction().partners().epochs();
    if (s < warm) continue;
    sum.update += update;
    sum.loads += loads;
  }
  const double all = steps * static_cast<double>(hair.elements_of_all());
  return {sum.update / all, sum.loads / all,
          static_cast<double>(hair.interaction().partners().epochs() - before) / steps};
}

// At the density of 6400 guides on a head when they begin to fall, and at others.
constexpr Line judged[] = {{1000, 6, 0.1, false},
                           {6400, 6, 0.1, false},
                           {50000, 6, 0.1, false},
                           {50000, 6, 0.1, true}};
constexpr Line shown[] = {{6400, 0.2, 0.1, false}, {6400, 1, 0.1, false},
                          {6400, 15, 0.1, false},  {6400, 6, 0, false},
                          {6400, 6, 0.3, false},   {6400, 6, 1, false}};

// 0.4 us where the reference takes 0.082 us: a multiple of it.
constexpr double most = 0.4 / 0.082;

bool costs_met() {
  const double unit = reference_time();
  fmt::print("reference kernel: {:.4f} us an element and step\n", unit * 1e6);
  bool met = true;
  const auto tell = [&](const Line& line, bool judges) {
    const Cost c = cost(line);
    const double all = (c.update + c.loads) / unit;
    const bool good = all <= most;
    fmt::print(
        "{}{} strands{}, {:g} near, swinging at {:g} m/s: {:.2f} x the reference "
        "(at most {:.2f}), {:.3f} us: update {:.3f}, loads and derivatives {:.3f}; "
        "segments sorted every {:.1f} steps\n",
        judges ? good ? "requirement: met: " : "requirement: NOT met: " : "",
        line.strands, line.shuffled ? " in no order" : "", line.near, line.swing, all,
        most, (c.update + c.loads) * 1e6, c.update * 1e6, c.loads * 1e6, 1 / c.epochs);
    if (judges) met = good && met;
  };
  for (const Line& line : judged) tell(line, true);
  for (const Line& line : shown) tell(line, false);
  return met;
}

}  // namespace
}  // namespace tress::experiments::benchmarks

int main(int argc, char** argv) {
  using namespace tress::experiments::benchmarks;
  return run_and_judge(argc, argv, [](const Measured&) { return costs_met(); });
}
