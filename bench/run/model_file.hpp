// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "core/config.hpp"
#include "core/error.hpp"
#include "core/files/yaml_config.hpp"
#include "sim/sensors/sensor_level.hpp"

namespace aims {

/// A file of models: what it states of the part (`sheet`), and what each level adds to the one
/// before. A level that is not wanted goes nowhere.
template <class Sheet, class Config>
struct ModelFile {
  Sheet& sheet;
  Config& ideal;
  Config& datasheet;
  Config& field;
};

template <class Sheet, class Config>
void describe(Fields& f, ModelFile<Sheet, Config>& file) {
  f.group("sheet", file.sheet);
  f.group("ideal", file.ideal);
  f.group("datasheet", file.datasheet);
  f.group("field", file.field);
}

/// Sets the keys of `config` that the file gives at that level, and returns its sheet. Errors name
/// the file as `name`.
template <class Sheet, class Config>
Result<Sheet> apply_model_file(std::string_view text, const std::string& name, SensorLevel level,
                               Config& config) {
  Sheet sheet;
  Config unused;
  ModelFile<Sheet, Config> file{sheet, config, level == SensorLevel::kIdeal ? unused : config,
                                level == SensorLevel::kField ? config : unused};
  if (auto ok = load_config_text(text, name, file); !ok) return tl::unexpected(ok.error());
  return sheet;
}

}  // namespace aims
