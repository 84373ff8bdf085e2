// SPDX-License-Identifier: BSD-3-Clause
#include "ros/node_config.hpp"

#include <utility>
#include <vector>

#include "core/files/yaml_config.hpp"
#include "estimator/estimator_spec.hpp"

namespace aims {

void describe(Fields& fields, NodeConfig& config) {
  fields.group("recording", config.recording);
  describe_estimators(fields, {config.estimator}, config.estimators);
}

Result<NodeConfig> load_node_config(const NodeOptions& options) {
  NodeConfig config;
  if (auto spec = parse_estimator_spec(options.estimator); !spec) {
    return tl::unexpected(spec.error());
  }
  config.estimator = options.estimator;
  std::vector<AssignedKey> assigned;
  if (!options.config.empty()) {
    auto ok = load_config(options.config, config, &assigned);
    if (!ok) return tl::unexpected(ok.error());
  }
  if (auto ok = apply_overrides(config, options.overrides, &assigned); !ok) {
    return tl::unexpected(ok.error());
  }
  const std::vector<std::string> run = {config.estimator};
  auto acts = check_effects(fields_of(config), std::move(assigned), true, run, config.estimators);
  if (!acts) return tl::unexpected(acts.error());
  config.recording.topics.truth = "none";  // for scoring alone
  return config;
}

}  // namespace aims
