#pragma once

#include <string>
#include <string_view>

#include "contract/input_error.h"
#include "simulation/device/cuda_driver.h"
#include "simulation/head/head_run.h"

namespace tress::simulation {

/// What takes the steps of a head: `automatic` is a GPU where there is one for it.
enum class DeviceChoice { cpu, gpu, automatic };
constexpr const char* device_choices = "cpu|gpu|auto";
/// One of these words.
DeviceChoice device_choice(std::string_view word);

struct ChosenDevice {
  std::string name = "cpu";  // or that of the GPU
  std::string why_not = {};  // automatic, on the processor: what speaks against a GPU
};
/// Steps of the head are taken there from now on. Throws InputError, which names the
/// place where `gpu` is asked for, if there is none for it.
ChosenDevice choose_device(HeadRun& run, DeviceChoice choice, const std::string& place);

/// What a failing device ends as.
InputError no_device(const DeviceFailure& failure, const std::string& place);

}  // namespace tress::simulation
