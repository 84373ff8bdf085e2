// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/yaml_position.hpp"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <optional>
#include <sstream>
#include <vector>

#include "core/files/yaml_document.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// Longest chain of bases that is followed; loading rejects cycles before.
constexpr int kMaxBases = 32;

struct Position {
  fs::path file;
  YAML::Mark mark;
  std::size_t depth = 0;  ///< parts of the key that were found
};

std::vector<std::string> parts_of(const std::string& key) {
  std::vector<std::string> parts;
  std::istringstream stream(key);
  for (std::string part; std::getline(stream, part, '.');) parts.push_back(part);
  return parts;
}

YAML::Node child_of(const YAML::Node& node, const std::string& part) {
  if (node.IsMap()) return node[part];
  const bool index = !part.empty() && part.find_first_not_of("0123456789") == std::string::npos;
  if (node.IsSequence() && index && part.size() < 9) return node[std::stoul(part)];
  return YAML::Node(YAML::NodeType::Undefined);
}

Position deepest(const fs::path& file, const YAML::Node& root,
                 const std::vector<std::string>& parts) {
  Position found{file, YAML::Mark::null_mark(), 0};
  YAML::Node node = root;
  for (const std::string& part : parts) {
    const YAML::Node child = child_of(node, part);
    if (!child.IsDefined()) break;
    node.reset(child);
    found.mark = node.Mark();
    ++found.depth;
  }
  return found;
}

/// The deepest match in the file or its bases; the file itself wins a tie.
Position search(fs::path file, const std::vector<std::string>& parts, const fs::path& named) {
  Position best{file, YAML::Mark::null_mark(), 0};
  for (int i = 0; i < kMaxBases; ++i) {
    const YAML::Node root = YAML::LoadFile(file.string());
    if (!root.IsMap()) break;
    const Position here = deepest(file, root, parts);
    if (here.depth > best.depth) best = here;
    if (!root["base"]) break;
    const auto base = find_base(file, root["base"].as<std::string>(), named);
    if (!base) break;
    file = *base;
  }
  return best;
}

}  // namespace

std::string with_position(const fs::path& file, const std::string& message, const fs::path& named) {
  try {
    const Position at = search(file, parts_of(message.substr(0, message.find(": "))), named);
    if (at.depth > 0) {
      return fmt::format("{}:{}:{}: {}", at.file.string(), at.mark.line + 1, at.mark.column + 1,
                         message);
    }
  } catch (const YAML::Exception&) {
    // The file changed since it was loaded: the message has no position.
  }
  return fmt::format("{}: {}", file.string(), message);
}

}  // namespace aims
