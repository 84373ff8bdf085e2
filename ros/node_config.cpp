// SPDX-License-Identifier: BSD-3-Clause
#include "ros/node_config.hpp"

#include "core/files/yaml_config.hpp"
#include "estimator/registry.hpp"

namespace aims {

void describe(Fields& fields, NodeConfig& config) {
  fields.group("recording", config.recording);
  fields.group("estimator", config.estimator);
}

Result<NodeConfig> load_node_config(const NodeOptions& options) {
  NodeConfig config;
  if (!options.config.empty()) {
    if (auto ok = load_config(options.config, config); !ok) return tl::unexpected(ok.error());
  }
  if (auto ok = apply_overrides(config, options.overrides); !ok) return tl::unexpected(ok.error());
  if (auto known = make_estimator(options.estimator, config.estimator, {}); !known) {
    return tl::unexpected(known.error());
  }
  config.recording.topics.truth = "none";  // for scoring alone
  return config;
}

}  // namespace aims
