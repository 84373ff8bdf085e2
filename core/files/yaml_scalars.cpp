// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/yaml_scalars.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include "core/files/yaml_document.hpp"

namespace aims {
namespace {

using Scalars = std::map<std::string, std::string>;

/// Nodes of the largest text: aliases can repeat a few nodes without end.
constexpr int kMaxNodes = 200'000;

/// `budget`: nodes that may still be visited.
void add_scalars(const YAML::Node& node, const std::string& place, int& budget, Scalars& scalars) {
  if (--budget < 0) return;
  const std::string prefix = place.empty() ? place : place + '.';
  if (node.IsScalar()) {
    scalars.emplace(place, node.Scalar());
  } else if (node.IsSequence()) {
    for (std::size_t i = 0; i < node.size(); ++i) {
      add_scalars(node[i], fmt::format("{}{}", prefix, i), budget, scalars);
    }
  } else if (node.IsMap()) {
    for (const auto& each : node) {
      if (!each.first.IsScalar()) continue;
      add_scalars(each.second, prefix + each.first.Scalar(), budget, scalars);
    }
  }
}

}  // namespace

Result<Scalars> yaml_scalars(const std::string& text, const std::string& name) {
  const auto document = parse_document(text, name);
  if (!document) return tl::unexpected(document.error());
  Scalars scalars;
  int budget = kMaxNodes;
  add_scalars(*document, "", budget, scalars);
  if (budget < 0) return failure(fmt::format("{}: expected at most {} values", name, kMaxNodes));
  return scalars;
}

}  // namespace aims
