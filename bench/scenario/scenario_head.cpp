// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scenario/scenario_head.hpp"

#include "core/files/yaml_config.hpp"

namespace aims {

Result<ScenarioHead> load_scenario_head(const std::filesystem::path& file,
                                        const std::filesystem::path& folder) {
  ScenarioHead head;
  head.name = file.stem().string();
  const CollectFields collect = [&head] {
    Fields fields;
    describe_head(fields, head);
    return fields;
  };
  std::vector<std::string> keys;
  const Fields fields = collect();
  for (const Parameter& each : fields.parameters()) keys.push_back(each.key);
  if (auto loaded = load_keys(file, keys, collect, YamlFiles(folder)); !loaded) {
    return tl::unexpected(loaded.error());
  }
  return head;
}

}  // namespace aims
