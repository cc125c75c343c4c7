#include "experiments/head_accuracy/grooms.h"

#include <fmt/format.h>

#include "contract/input_error.h"

namespace tress::experiments::head_accuracy {
namespace {

struct Part {
  std::string_view name, text;
};

constexpr Part shapes[] = {
    {"straight", "shape = \"straight\"\n"},
    {"wavy", "shape = \"wavy\"\nwave_per_m = 40\nwavelength_m = 0.05\n"},
    {"curly", "shape = \"helix\"\ncurl_radius_m = 0.01\ncurl_pitch_m = 0.04\n"}};
constexpr Part variations[] = {
    {"alike", "length_variation = 0\ncurl_variation = 0\nphase = \"down\"\n"},
    {"varied", "length_variation = 0.3\ncurl_variation = 0.5\nphase = \"random\"\n"}};
constexpr Part drives[] = {
    {"released", "[root]\nmotion = \"fixed\"\n"},
    {"shaken",
     "[root]\nmotion = \"head\"\ncentre_m = [-0.02, 0, -0.1]\ntorque_n_m = 0.6\n"
     "frequency_hz = 2\n"}};

}  // namespace

std::vector<std::string> groom_names() {
  std::vector<std::string> all;
  for (const Part& shape : shapes) {
    for (const Part& variation : variations) {
      for (const Part& drive : drives) {
        all.push_back(fmt::format("{}_{}_{}", shape.name, variation.name, drive.name));
      }
    }
  }
  return all;
}

std::string groom_text(std::string_view name, std::size_t hairs) {
  for (const Part& shape : shapes) {
    for (const Part& variation : variations) {
      for (const Part& drive : drives) {
        if (name != fmt::format("{}_{}_{}", shape.name, variation.name, drive.name)) {
          continue;
        }
        return fmt::format(
            "title = \"{0} hair, {1}, {2}\"\nduration_s = 1\n[model]\n"
            "id = \"super_helix\"\nmodes = \"bend_twist\"\njacobian = \"elastic\"\n"
            "[integrator]\nid = \"linearly_implicit_euler\"\ndt_s = "
            "0.0033333333333333335\n"
            "[material]\nname = \"hair.caucasian\"\n[effects.gravity]\n"
            "[effects.linear_drag]\ndrag_kg_m_s = 5e-5\n"
            "[groom]\ncount = {3}\nelements = 10\nlength_m = 0.15\n"
            "cap_axis = [-1, 0, 0.3]\ncap_angle_rad = 0.4\n{4}{5}{6}",
            shape.name, variation.name, drive.name, hairs, shape.text, variation.text,
            drive.text);
      }
    }
  }
  throw InputError(fmt::format("unknown groom '{}'", name), "--set grooms",
                   fmt::format("there are: {}", fmt::join(groom_names(), ", ")));
}

}  // namespace tress::experiments::head_accuracy
