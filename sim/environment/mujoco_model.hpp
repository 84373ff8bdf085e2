// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string_view>
#include <vector>

#include "core/error.hpp"

struct mjModel_;
struct mjData_;

namespace aims {

struct MujocoDeleter {
  void operator()(mjModel_* model) const;
  void operator()(mjData_* data) const;
};
using MujocoModel = std::unique_ptr<mjModel_, MujocoDeleter>;
using MujocoData = std::unique_ptr<mjData_, MujocoDeleter>;

/// Compiles an MJCF document and fills its height field with `heights` (see `height_field_data`).
/// Error when the document is no model, or its height field has another number of points. From
/// then on an internal error of MuJoCo aborts the process; its own handler waits for a key.
Result<MujocoModel> load_mujoco_model(std::string_view mjcf, const std::vector<float>& heights);

}  // namespace aims
