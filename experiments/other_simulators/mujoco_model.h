#pragma once

#include <mujoco/mujoco.h>

#include <cstring>
#include <memory>
#include <stdexcept>
#include <string>

#include "contract/layers.h"

namespace tress::experiments::other_simulators {

/// A model in MuJoCo's own format, compiled, with its data.
class MujocoModel {
 public:
  explicit MujocoModel(const std::string& text)
      : model_(compile(text)), data_(mj_makeData(model_.get())) {
    mju_user_warning = [](const char*) {};  // else it writes a log file where it stands
  }
  mjModel& model() const { return *model_; }
  mjData& data() const { return *data_; }

 private:
  struct Free {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  static std::unique_ptr<mjModel, Free> compile(const std::string& text) {
    const auto files = std::make_unique<mjVFS>();
    mj_defaultVFS(files.get());
    constexpr const char* name = "model.xml";
    mj_makeEmptyFileVFS(files.get(), name, static_cast<int>(text.size()));
    std::memcpy(files->filedata[mj_findFileVFS(files.get(), name)], text.data(),
                text.size());
    char error[500] = "";
    std::unique_ptr<mjModel, Free> model(
        mj_loadXML(name, files.get(), error, sizeof error));
    mj_deleteVFS(files.get());
    if (!model) throw std::runtime_error(std::string("MuJoCo: ") + error);
    return model;
  }

  std::unique_ptr<mjModel, Free> model_;
  std::unique_ptr<mjData, Free> data_;
};

}  // namespace tress::experiments::other_simulators
