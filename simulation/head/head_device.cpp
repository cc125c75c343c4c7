#include "simulation/head/head_device.h"

namespace tress::simulation {

DeviceChoice device_choice(std::string_view word) {
  if (word == "gpu") return DeviceChoice::gpu;
  return word == "auto" ? DeviceChoice::automatic : DeviceChoice::cpu;
}

ChosenDevice choose_device(HeadRun& run, DeviceChoice choice, const std::string& place) {
  if (choice == DeviceChoice::cpu) return {};
  try {
    if (run.ranks().size() > 1) {
      throw InputError("ranks share a batch on processors only", place,
                       "leave out mpirun, or give --device cpu");
    }
    return {.name = run.move_to_device()};
  } catch (const InputError& no) {
    if (choice == DeviceChoice::gpu) throw;
    return {.name = "cpu", .why_not = no.what()};
  } catch (const DeviceFailure& no) {
    if (choice == DeviceChoice::gpu) throw no_device(no, place);
    return {.name = "cpu", .why_not = no.what()};
  }
}

InputError no_device(const DeviceFailure& failure, const std::string& place) {
  return InputError(failure.what(), "--device gpu of " + place,
                    "give --device cpu, or auto to go on without a device");
}

}  // namespace tress::simulation
