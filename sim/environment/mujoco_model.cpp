// SPDX-License-Identifier: BSD-3-Clause
#include "sim/environment/mujoco_model.hpp"

#include <mujoco/mujoco.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>

namespace aims {
namespace {

void on_error(const char* message) {
  std::fprintf(stderr, "physics engine: %s\n", message);
  std::abort();
}

/// MuJoCo counts its warnings itself, see World::warning_count.
void on_warning(const char*) {}

}  // namespace

void MujocoDeleter::operator()(mjModel* model) const { mj_deleteModel(model); }
void MujocoDeleter::operator()(mjData* data) const { mj_deleteData(data); }

Result<MujocoModel> load_mujoco_model(std::string_view mjcf, const std::vector<float>& heights) {
  mju_user_error = on_error;
  mju_user_warning = on_warning;
  auto files = std::make_unique<mjVFS>();  // 2 MB
  mj_defaultVFS(files.get());
  constexpr const char* kName = "world.xml";
  mj_makeEmptyFileVFS(files.get(), kName, static_cast<int>(mjcf.size()));
  std::memcpy(files->filedata[mj_findFileVFS(files.get(), kName)], mjcf.data(), mjcf.size());
  std::array<char, 1000> message{};
  MujocoModel model(mj_loadXML(kName, files.get(), message.data(), message.size()));
  mj_deleteVFS(files.get());
  if (!model) return failure("physics model: " + std::string(message.data()));
  if (static_cast<std::size_t>(model->nhfielddata) != heights.size()) {
    return failure("physics model: its height field has " + std::to_string(model->nhfielddata) +
                   " points, but " + std::to_string(heights.size()) + " heights were given");
  }
  std::copy(heights.begin(), heights.end(), model->hfield_data);
  return model;
}

}  // namespace aims
