// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/python_classes.hpp"

#include <fmt/format.h>

#include "estimator/estimator_spec.hpp"

namespace aims {

Result<RunChoice> choose_run(const std::filesystem::path& file,
                             std::span<const std::string> overrides, const YamlFiles& files,
                             const std::vector<std::string>& standard, EstimatorConfigs& configs) {
  const auto read = [&](std::span<const std::string> settings) {
    auto texts = read_texts(file, settings, "run", files);
    return texts && *texts ? std::move(**texts) : standard;
  };
  RunChoice choice{read({}), read(overrides)};
  if (auto added = add_python_estimators(choice.all, configs); !added) {
    const char* from = choice.all == choice.of_file ? "run" : "--estimators";
    return failure(fmt::format("{}: {}", from, added.error().message));
  }
  // Of one that does not run, the file may hold settings; without the class they are unknown keys.
  static_cast<void>(add_python_estimators(choice.of_file, configs));
  return choice;
}

}  // namespace aims
