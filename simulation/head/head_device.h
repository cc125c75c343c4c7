#pragma once

#include <string>
#include <string_view>

#include "contract/input_error.h"
#include "simulation/device/cuda_driver.h"
#include "simulation/head/head_run.h"

namespace tress::simulation {

/// Device that takes the steps of a batch: `cpu`, `gpu`, or `automatic`, which is a GPU
/// if one supports the batch.
enum class DeviceChoice { cpu, gpu, automatic };
/// Words of device_choice().
constexpr const char* device_choices = "cpu|gpu|auto";
/// One of these words.
DeviceChoice device_choice(std::string_view word);

/// Device that was chosen.
struct ChosenDevice {
  std::string name = "cpu";  // or the name of the GPU
  std::string why_not = {};  // automatic, on the processor: what speaks against a GPU
};
/// Moves the steps of the batch to the device. Throws InputError, which names the place
/// of the request, if `gpu` is requested and no GPU supports the batch.
ChosenDevice choose_device(HeadRun& run, DeviceChoice choice, const std::string& place);

/// Returns the error for a failing device.
InputError no_device(const DeviceFailure& failure, const std::string& place);

}  // namespace tress::simulation
