// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/ply.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cstring>
#include <map>
#include <optional>

#include "core/files/atomic_file.hpp"
#include "core/files/number_lines.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

static_assert(std::endian::native == std::endian::little, "PLY is written without byte swapping");

constexpr std::size_t kPointBytes = 3 * sizeof(float);

/// Sizes of the scalar types [bytes], by both of their names.
const std::map<std::string_view, std::size_t> kTypeSizes = {
    {"char", 1},  {"uchar", 1},  {"short", 2},   {"ushort", 2}, {"int", 4},   {"uint", 4},
    {"float", 4}, {"double", 8}, {"int8", 1},    {"uint8", 1},  {"int16", 2}, {"uint16", 2},
    {"int32", 4}, {"uint32", 4}, {"float32", 4}, {"float64", 8}};

/// The vertices of a header.
struct Layout {
  std::size_t count = 0;                 ///< vertices
  std::size_t stride = 0;                ///< of one [bytes]
  std::vector<std::string> coordinates;  ///< "TYPE NAME" of the first three properties
};

/// The next header line, or nothing at the end of the text.
std::optional<std::string_view> take_line(std::string_view& text) {
  const std::size_t end = text.find('\n');
  if (end == std::string_view::npos) return std::nullopt;
  std::string_view line = text.substr(0, end);
  text.remove_prefix(end + 1);
  if (line.ends_with('\r')) line.remove_suffix(1);
  return line;
}

/// Adds a property of a vertex to the layout; false for a list or an unknown type.
bool add_property(const std::vector<std::string_view>& words, Layout& layout) {
  const auto size = words.size() == 3 ? kTypeSizes.find(words[1]) : kTypeSizes.end();
  if (size == kTypeSizes.end()) return false;
  layout.stride += size->second;
  if (layout.coordinates.size() < 3) {
    const bool single = words[1] == "float" || words[1] == "float32";
    layout.coordinates.push_back(fmt::format("{} {}", single ? "float" : words[1], words[2]));
  }
  return true;
}

/// Reads up to `end_header`; returns the error, or nothing.
std::optional<std::string> read_header(std::string_view& text, Layout& layout) {
  if (take_line(text) != "ply") return "expected the first line 'ply'";
  if (take_line(text) != "format binary_little_endian 1.0") {
    return "expected the line 'format binary_little_endian 1.0'";
  }
  int elements = 0;
  while (const auto line = take_line(text)) {
    const auto words = words_of(*line);
    if (words.empty() || words[0] == "comment" || words[0] == "obj_info") continue;
    if (words[0] == "end_header") return std::nullopt;
    if (words[0] == "element" && ++elements == 1) {
      const auto count = words.size() == 3 && words[1] == "vertex"
                             ? number_from<std::size_t>(words[2])
                             : std::nullopt;
      if (!count) return fmt::format("expected 'element vertex COUNT', found '{}'", *line);
      layout.count = *count;
    } else if (words[0] == "property" && elements == 1 && !add_property(words, layout)) {
      return fmt::format("expected 'property TYPE NAME', found '{}'", *line);
    }
  }
  return "expected a header that ends with 'end_header'";
}

}  // namespace

std::string ply_text(std::span<const Eigen::Vector3f> points) {
  std::string text = fmt::format(
      "ply\nformat binary_little_endian 1.0\nelement vertex {}\nproperty float x\n"
      "property float y\nproperty float z\nend_header\n",
      points.size());
  text.reserve(text.size() + points.size() * kPointBytes);
  for (const Eigen::Vector3f& point : points) {
    std::array<char, kPointBytes> bytes;
    std::memcpy(bytes.data(), point.data(), kPointBytes);
    text.append(bytes.data(), kPointBytes);
  }
  return text;
}

Result<std::vector<Eigen::Vector3f>> parse_ply(std::string_view text, const std::string& name) {
  Layout layout;
  if (const auto wrong = read_header(text, layout)) {
    return failure(fmt::format("{}: {}", name, *wrong));
  }
  if (layout.coordinates != std::vector<std::string>{"float x", "float y", "float z"}) {
    return failure(fmt::format("{}: expected vertices of 'float x, float y, float z', found '{}'",
                               name, fmt::join(layout.coordinates, ", ")));
  }
  if (layout.count > text.size() / layout.stride) {
    return failure(fmt::format("{}: expected {} vertices of {} bytes, found {} bytes", name,
                               layout.count, layout.stride, text.size()));
  }
  std::vector<Eigen::Vector3f> points(layout.count);
  for (std::size_t i = 0; i < points.size(); ++i) {
    std::memcpy(points[i].data(), text.data() + i * layout.stride, kPointBytes);
  }
  return points;
}

Result<void> write_ply(const std::filesystem::path& file, std::span<const Eigen::Vector3f> points) {
  return write_file_atomically(file, ply_text(points));
}

Result<std::vector<Eigen::Vector3f>> read_ply(const std::filesystem::path& file) {
  const auto text = read_file(file);
  if (!text) return tl::unexpected(text.error());
  return parse_ply(*text, file.string());
}

}  // namespace aims
