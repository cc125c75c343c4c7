#include "tests/fuzz/random_scene.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "integrators/catalogue.h"
#include "models/catalogue.h"

namespace tress::testing_support {

using namespace integrators;
using namespace models;
namespace {

class Draw {
 public:
  explicit Draw(std::uint64_t seed) : bits_(seed) {}

  double uniform(double low, double high) {
    return low + (high - low) * (static_cast<double>(bits_() >> 11) * 0x1p-53);
  }
  double spread(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  int whole(int low, int high) {  // both included
    return low + static_cast<int>(bits_() % static_cast<std::uint64_t>(high - low + 1));
  }
  bool chance(double share) { return uniform(0, 1) < share; }
  template <class List>
  const auto& of(const List& list) {
    return list[bits_() % std::size(list)];
  }
  double sign() { return chance(0.5) ? 1 : -1; }

 private:
  std::mt19937_64 bits_;
};

constexpr double earth = 9.81;  // m/s^2
// J/m of [effects.strand_interaction] as it is: K P^2/2 of each of six strands.
constexpr double contact_energy = 6 * 2e-4 * 3e-3 * 3e-3 / 2;

constexpr double affordable = 5;  // s of processor time for a scene
// No scene is cut to fewer: of a fixed step, and in each frame of an adaptive one.
constexpr int least_steps = 50, least_steps_of_frame = 20, most_steps_of_frame = 3000;

/// s of processor time, roughly, from the times of some hundred such scenes.
double seconds_per_step(const IntegratorEntry& entry, int elements, bool monolithic) {
  const bool explicit_one = !entry.tangent && entry.order(Formulation::parametric);
  const double n = elements, pairs = monolithic ? n * n : 0;
  // Each of its columns takes a difference of the acceleration.
  if (entry.id == "gsl_bsimp") return 13e-6 * n * n * (1 + n / 50);
  if (explicit_one) return 10e-6 * n + 1e-6 * pairs;
  return 100e-6 * n * (1 + n / 50) + 30e-6 * pairs;
}

class Writer {
 public:
  explicit Writer(std::uint64_t seed) : draw_(seed) {}

  RandomScene write() {
    model();
    method_ = &draw_.of(integrator_catalogue());
    frames_ = draw_.whole(5, 40);
    material();
    strands();
    integrator();
    root();
    effects();
    if (weight_) gravity_ = earth;
    scene_.weight_work = scene_.mass * (gravity_ * length_) + force_ * total_ * length_;
    if (touching_) scene_.weight_work += total_ * contact_energy;
    const std::string top = fmt::format(
        "title = \"extreme\"\nduration_s = {:.17g}\nframes_per_s = {:.17g}\nseed = {}\n",
        duration_, frames_ / duration_, draw_.whole(1, 1000));
    scene_.text = top + text_;
    return scene_;
  }

 private:
  template <class... T>
  void line(std::string_view format, const T&... values) {
    text_ += fmt::vformat(format, fmt::make_format_args(values...)) + '\n';
  }

  void model() {
    std::vector<const ModelEntry*> strands;
    for (const ModelEntry& entry : model_catalogue()) {
      if (entry.on_strand != nullptr) strands.push_back(&entry);
    }
    const ModelEntry& entry = *draw_.of(strands);
    line("[model]\nid = \"{}\"", entry.id);
    for (const Parameter& p : entry.parameters) {
      if (p.choices.empty() || !draw_.chance(0.3)) continue;
      std::vector<std::string_view> words;
      for (std::size_t from = 0; from <= p.choices.size();) {
        const std::size_t to = std::min(p.choices.find('|', from), p.choices.size());
        words.push_back(p.choices.substr(from, to - from));
        from = to + 1;
      }
      line("{} = \"{}\"", p.name, draw_.of(words));
    }
    constrained_ = entry.id == "inextensible_strand" || entry.id == "dynamic_spline" ||
                   text_.find("\"inextensible\"") != std::string::npos;
  }

  void material() {
    constexpr std::string_view names[] = {"hair.caucasian", "hair.asian", "hair.african"};
    line("[material]\nname = \"{}\"", draw_.of(names));
    radius_ = draw_.spread(1e-5, 1e-3);
    density_ = draw_.spread(300, 9000);
    line("radius_m = {:.17g}\ndensity_kg_m3 = {:.17g}", radius_, density_);
    line("ellipticity = {:.3g}", draw_.uniform(1, 2));
    line("youngs_modulus_pa = {:.3g}\npoisson_ratio = {:.3g}", draw_.spread(1e5, 1e11),
         draw_.uniform(0, 0.5));
    line("internal_friction_kg_m3_s = {:.3g}",
         draw_.chance(0.5) ? 0 : draw_.spread(1e-13, 1e-8));
  }

  /// So many of each strand, or as many fewer as leave it the least steps.
  int affordable_elements(int wanted, int strands) const {
    const int least = method_->adaptive ? least_steps_of_frame * frames_ : least_steps;
    while (wanted > 1 &&
           least * seconds_per_step(*method_, strands * wanted, monolithic_) >
               affordable) {
      --wanted;
    }
    return wanted;
  }

  void strands() {
    const int count = draw_.chance(0.75) ? 1 : draw_.whole(2, 6);
    touching_ = count > 1 && draw_.chance(0.5);
    monolithic_ = touching_ && draw_.chance(0.3);
    length_ = draw_.spread(0.005, 2);
    const int wanted = draw_.chance(0.1) ? draw_.whole(41, 120) : draw_.whole(1, 40);
    const int elements = affordable_elements(wanted, count);
    elements_ = count * elements;
    std::string shape =
        fmt::format("length_m = {:.17g}\nelements = {}\n", length_, elements);
    if (draw_.chance(0.2))
      shape += fmt::format("grading = {:.3g}\n", draw_.spread(0.2, 5));
    switch (draw_.whole(0, 4)) {
      case 0:
        shape += fmt::format("shape = \"helix\"\ncurl_radius_m = {:.3g}\n",
                             draw_.spread(5e-4, 0.05));
        shape += fmt::format("curl_pitch_m = {:.3g}\n",
                             draw_.sign() * draw_.spread(1e-3, 0.1));
        break;
      case 1:
        shape +=
            fmt::format("shape = \"wavy\"\nwave_per_m = {:.3g}\nwavelength_m = {:.3g}\n",
                        draw_.spread(1, 500), draw_.spread(0.3, 3) * length_);
        break;
      case 2:
        shape += "shape = \"material\"\n";
        break;
      default:
        break;
    }
    if (draw_.chance(0.3)) shape += "initial = \"straight\"\n";
    const double along = draw_.uniform(-1, 1), up = draw_.uniform(-1, 1);
    for (int k = 0; k < count; ++k) {
      line(
          "[[strand]]\nposition_m = [0, {:.17g}, 0]\nroot_tangent = [{:.3g}, 0.1, "
          "{:.3g}]\n{}",
          k * draw_.spread(1e-4, 0.01), along, up, shape);
    }
    scene_.lightest = density_ * std::numbers::pi * radius_ * radius_ * length_;
    scene_.mass = count * scene_.lightest;
    total_ = count * length_;
  }

  /// No more steps than the scene can afford.
  void integrator() {
    line("[integrator]\nid = \"{}\"", method_->id);
    if (constrained_) {
      std::vector<Formulation> usable;
      for (const auto& [one, order] : method_->formulations) {
        if (one != Formulation::parametric) usable.push_back(one);
      }
      if (!usable.empty()) line("formulation = \"{}\"", name(draw_.of(usable)));
    }
    const double most = affordable / seconds_per_step(*method_, elements_, monolithic_);
    if (method_->adaptive) {
      line("rtol = {:.3g}\nmax_steps = {}", draw_.spread(1e-8, 1e-2),
           static_cast<int>(std::min<double>(most_steps_of_frame, most / frames_)));
      duration_ = draw_.spread(1e-3, 0.1);
    } else {
      const double step = draw_.spread(1e-6, 0.05);
      line("dt_s = {:.3g}", step);
      duration_ = std::min(step * std::min<double>(draw_.whole(20, 200), most), 2.0);
    }
  }

  /// The root carries the strand's frame; `f` is its acceleration, `spin` and `turn` its
  /// angular velocity and acceleration at most.
  void driven(double f, double v, double turn = 0, double spin = 0) {
    scene_.passive = false;
    scene_.pushed += (f + (turn + spin * spin) * length_) * duration_;
    scene_.worked += 2 * spin * earth * length_ * duration_;
    scene_.carried += v + spin * length_;
  }

  void root() {
    line("[root]");
    const double amplitude = draw_.spread(1e-3, 0.3), frequency = draw_.spread(0.2, 20),
                 w = 2 * std::numbers::pi * frequency, angle = draw_.uniform(0.1, 1.5),
                 arm = 0.05;
    const auto shaken = [&] {
      line("amplitude_m = {:.17g}\nfrequency_hz = {:.17g}", amplitude, frequency);
    };
    const auto turned = [&] {
      line("angle_rad = {:.17g}\ncentre_m = [-{:.3g}, 0, 0]", angle, arm);
      const double spin = angle * w, turn = spin * w;
      driven((turn + spin * spin) * arm, spin * arm, turn, spin);
    };
    switch (draw_.chance(0.4) ? 0 : draw_.whole(1, 7)) {
      case 1:
        line("motion = \"shake\"");
        shaken();
        return driven(amplitude * w * w, amplitude * w);
      case 2:
        line("motion = \"rotate\"\nfrequency_hz = {:.17g}", frequency);
        return turned();
      case 3:
        line("motion = \"shake_rotate\"");
        shaken();
        driven(amplitude * w * w, amplitude * w);
        return turned();
      case 4:
        line("motion = \"swing\"");
        shaken();
        return driven(amplitude * w * w, amplitude * w);
      case 5: {
        const double speed = draw_.spread(0.1, 5), time = draw_.spread(1e-3, 0.5);
        line("motion = \"stop\"\nspeed_m_s = {:.17g}\ntime_s = {:.17g}", speed, time);
        return driven(2 * speed / time, speed);
      }
      case 6:
        line("motion = \"drop_pull\"\ndirection = [0, 0, -1]");
        shaken();
        // smooth_step: 10/sqrt(3) heights over the square of its time, half a period.
        return driven(6 * amplitude * 4 * frequency * frequency,
                      2 * amplitude * 2 * frequency);
      case 7:
        line(
            "motion = \"free\"\nvelocity_m_s = [{:.3g}, 0, 1]\nspin_rad_s = [1, {:.3g}, "
            "2]",
            draw_.uniform(-3, 3), draw_.uniform(-20, 20));
        return;
      default:
        line("motion = \"fixed\"");
    }
  }

  void effects() {
    if (draw_.chance(0.9)) {
      line("[effects.gravity]");
      weight_ = true;
    }
    if (draw_.chance(0.3))
      line("[effects.linear_drag]\ndrag_kg_m_s = {:.3g}", draw_.spread(1e-7, 1e-2));
    if (draw_.chance(0.1)) line("[effects.quadratic_drag]");
    if (draw_.chance(0.15)) {
      const double speed = draw_.spread(0.1, 30);
      constexpr std::string_view laws[] = {"linear", "quadratic"};
      constexpr std::string_view profiles[] = {"constant", "sine", "gusts"};
      line(
          "[effects.wind]\nvelocity_m_s = [{:.3g}, 0, 0]\nlaw = \"{}\"\nprofile = \"{}\"",
          speed, draw_.of(laws), draw_.of(profiles));
      scene_.passive = false;
      // Gusts of 0.5 m/s rms are five times that at times.
      scene_.pushed += speed + 2.5;
    }
    if (draw_.chance(0.1)) {
      force_ = draw_.spread(1e-6, 1e-2);  // N/m
      line("[effects.constant_force]\nforce_n_m = [0, 0, {:.17g}]", force_);
    }
    if (draw_.chance(0.15)) {
      const double k = draw_.spread(1e-6, 10);
      line("[effects.tether]\nstiffness_n_m = {:.17g}\ntarget_m = [{:.17g}, 0, 0]", k,
           length_);
      scene_.passive = false;
      // From the far side of the strand and of wherever its root is carried.
      scene_.worked += k * std::pow(3 * length_ + 1, 2) / 2 / scene_.lightest;
    }
    if (draw_.chance(0.25)) {
      constexpr std::string_view shapes[] = {"plane", "sphere", "capsule"};
      line(
          "[[effects.body]]\nshape = \"{}\"\ncentre_m = [0, 0, -{:.3g}]\nradius_m = "
          "{:.3g}",
          draw_.of(shapes), draw_.uniform(0.2, 1.2) * length_, 0.15 * length_);
      line("stiffness_n_m2 = {:.3g}\nfriction = {:.3g}", draw_.spread(0.1, 1e4),
           draw_.uniform(0, 1));
      if (!scene_.passive) scene_.pushed += 10 * scene_.carried;
    }
    if (touching_) {
      line("[effects.strand_interaction]\ncoupling = \"{}\"",
           monolithic_ ? "monolithic" : "lagged");
    }
  }

  Draw draw_;
  RandomScene scene_;
  std::string text_;
  double duration_ = 1, radius_ = 0, density_ = 0, length_ = 0, total_ = 0, gravity_ = 0,
         force_ = 0;
  const IntegratorEntry* method_ = nullptr;
  int frames_ = 0, elements_ = 0;  // elements of all strands
  bool constrained_ = false, weight_ = false, touching_ = false, monolithic_ = false;
};

}  // namespace

RandomScene random_scene(std::uint64_t seed) { return Writer(seed).write(); }

}  // namespace tress::testing_support
