// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/rosbag2/rosbag2_metadata.hpp"

#include <fmt/format.h>
#include <sys/stat.h>

#include <algorithm>
#include <array>
#include <map>
#include <optional>
#include <set>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/files/atomic_file.hpp"
#include "core/files/yaml_scalars.hpp"
#include "core/text.hpp"
#include "recordings/messages/message_definition.hpp"
#include "recordings/messages/quality_of_service.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxMetadataBytes = std::size_t{16} << 20;
constexpr std::size_t kMaxFiles = 10'000;
constexpr std::string_view kGroup = "rosbag2_bagfile_information.";

using Scalars = std::map<std::string, std::string>;

std::string scalar(const Scalars& scalars, const std::string& key) {
  const auto found = scalars.find(std::string(kGroup) + key);
  return found == scalars.end() ? std::string() : found->second;
}

/// Whether the recording is compressed; error for a compression that cannot be read.
Result<bool> is_compressed(const Scalars& scalars, const fs::path& metadata) {
  const std::string mode = lower_case(scalar(scalars, "compression_mode"));
  const std::string format = lower_case(scalar(scalars, "compression_format"));
  if (mode.empty() || mode == "none") return false;
  if (mode != "file" && mode != "message") {
    return failure(fmt::format("{}: compression_mode: expected NONE, FILE or MESSAGE, found '{}'",
                               metadata.string(), scalar(scalars, "compression_mode")));
  }
  if (format == "zstd") return true;
  return failure(fmt::format("{}: compression_format: expected zstd, found '{}'", metadata.string(),
                             scalar(scalars, "compression_format")));
}

/// Where a listed file lies: ROS 2 Foxy lists it with the name of the folder.
Result<fs::path> listed_file(const fs::path& folder, const std::string& listed) {
  std::error_code ignored;
  const fs::path plain = fs::path(listed).lexically_normal();
  const bool inside = !plain.is_absolute() && !plain.empty() && *plain.begin() != "..";
  for (const fs::path& file : {inside ? folder / plain : fs::path(), folder / plain.filename()}) {
    if (!file.empty() && fs::exists(file, ignored)) return file;
  }
  return failure(fmt::format("{}: expected the file '{}', which {} lists", folder.string(), listed,
                             kRosbag2Metadata));
}

/// NAME and N of "NAME_N.db3"; nothing for other names.
std::optional<std::pair<std::string, int>> numbered(const fs::path& file) {
  const std::string name = file.filename().string();
  const std::size_t mark = name.rfind('_');
  if (mark == std::string::npos) return std::nullopt;
  std::string_view extension = std::string_view(name).substr(mark + 1);
  const auto number = number_from<int>(take_until(extension, '.'));
  constexpr std::array<std::string_view, 4> kExtensions = {"db3", "mcap", "db3.zstd", "mcap.zstd"};
  if (!number || std::ranges::find(kExtensions, extension) == kExtensions.end()) {
    return std::nullopt;
  }
  return std::pair(name.substr(0, mark), *number);
}

/// A text as YAML in double quotes.
std::string quoted(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    if (c == '\n') {
      out += "\\n";
      continue;
    }
    if (c == '"' || c == '\\') out += '\\';
    out += c;
  }
  return out + '"';
}

}  // namespace

Result<Rosbag2Metadata> read_rosbag2_metadata(const fs::path& folder) {
  const fs::path file = folder / kRosbag2Metadata;
  const auto text = read_file(file, kMaxMetadataBytes);
  if (!text) return tl::unexpected(text.error());
  const auto scalars = yaml_scalars(*text, file.string());
  if (!scalars) return tl::unexpected(scalars.error());
  const auto compressed = is_compressed(*scalars, file);
  if (!compressed) return tl::unexpected(compressed.error());
  Rosbag2Metadata metadata;
  metadata.compressed = *compressed;
  std::set<std::pair<dev_t, ino_t>> listed_before;  // one that is listed twice is read once
  for (std::size_t i = 0;; ++i) {
    const std::string listed = scalar(*scalars, fmt::format("relative_file_paths.{}", i));
    if (listed.empty()) break;
    auto found = listed_file(folder, listed);
    if (!found) return tl::unexpected(found.error());
    struct stat status {};
    const bool known = ::stat(found->c_str(), &status) == 0 &&
                       !listed_before.emplace(status.st_dev, status.st_ino).second;
    if (!known) metadata.files.push_back(std::move(*found));
    if (i >= kMaxFiles) {
      return failure(fmt::format("{}: expected at most {} files", file.string(), kMaxFiles));
    }
  }
  if (metadata.files.empty()) {
    return failure(fmt::format("{}: {}relative_file_paths: expected files, found none",
                               file.string(), kGroup));
  }
  return metadata;
}

std::vector<fs::path> rosbag2_files(const fs::path& folder) {
  std::map<std::pair<std::string, int>, fs::path> found;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(folder, code)) {
    if (const auto place = numbered(entry.path())) found.emplace(*place, entry.path());
  }
  std::vector<fs::path> files;
  for (const auto& [place, file] : found) {
    if (place.first != found.begin()->first.first) return {};
    files.push_back(file);
  }
  return files;
}

std::string rosbag2_metadata_text(const std::string& file, std::span<const BagConnection> topics,
                                  Time start, Time end) {
  std::uint64_t messages = 0;
  std::string topics_text;
  for (const BagConnection& each : topics) {
    messages += each.messages;
    topics_text += fmt::format(
        "    - topic_metadata:\n"
        "        name: {}\n"
        "        type: {}\n"
        "        serialization_format: cdr\n"
        "        offered_qos_profiles: {}\n"
        "      message_count: {}\n",
        quoted(each.topic), quoted(ros2_type_name(each.type)),
        quoted(offered_quality(each.latching)), each.messages);
  }
  const auto span = [&](std::string_view indent) {
    return fmt::format(
        "{0}duration:\n{0}  nanoseconds: {1}\n{0}starting_time:\n"
        "{0}  nanoseconds_since_epoch: {2}\n{0}message_count: {3}\n",
        indent, end - start, start, messages);
  };
  return fmt::format(
      "rosbag2_bagfile_information:\n"
      "  version: 5\n"
      "  storage_identifier: sqlite3\n"
      "{}"
      "  topics_with_message_count:{}\n{}"
      "  compression_format: \"\"\n"
      "  compression_mode: \"\"\n"
      "  relative_file_paths:\n"
      "    - {}\n"
      "  files:\n"
      "    - path: {}\n{}",
      span("  "), topics.empty() ? " []" : "", topics_text, quoted(file), quoted(file),
      span("      "));
}

}  // namespace aims
