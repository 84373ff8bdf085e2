// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/page_data.hpp"

#include <zlib.h>
#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <limits>
#include <string_view>
#include <utility>
#include <vector>

#include "bench/scoring/json_text.hpp"
#include "core/files/atomic_file.hpp"

namespace aims {

namespace {

constexpr double kLargestCode = kNoCode - 1;
constexpr double kLogarithmicFrom = 1000.0;  ///< ratio of the largest value to the smallest

/// Median of the absolute values that are neither zero nor NaN; infinite without any.
double typical_size(std::span<const double> values) {
  std::vector<double> sizes;
  for (const double value : values) {
    if (std::abs(value) > 0.0) sizes.push_back(std::abs(value));
  }
  if (sizes.empty()) return std::numeric_limits<double>::infinity();
  const auto middle = sizes.begin() + static_cast<std::ptrdiff_t>(sizes.size() / 2);
  std::nth_element(sizes.begin(), middle, sizes.end());
  return *middle;
}

}  // namespace

std::optional<QuantizedColumn> quantized(std::span<const double> values,
                                         const Precision& precision) {
  double min = std::numeric_limits<double>::infinity();
  double max = -min;
  for (const double value : values) {
    if (std::isnan(value)) continue;
    if (std::isinf(value)) return std::nullopt;
    min = std::min(min, value);
    max = std::max(max, value);
  }
  QuantizedColumn column;
  if (!(min <= max)) min = max = 0.0;
  column.logarithmic = precision.relative > 0.0 && min > 0.0 && max / min > kLogarithmicFrom;
  const auto law = [&](double value) { return column.logarithmic ? std::log(value) : value; };
  column.low = law(min);
  column.step = std::max((law(max) - column.low) / kLargestCode, precision.least_step);
  if (precision.relative > 0.0) {
    const double reach = column.logarithmic ? 1.0 : typical_size(values);
    if (column.step / 2.0 > precision.relative * reach) return std::nullopt;
  }
  column.codes.reserve(values.size());
  for (const double value : values) {
    const double code = column.step > 0.0 ? (law(value) - column.low) / column.step : 0.0;
    column.codes.push_back(std::isnan(value) ? kNoCode
                                             : static_cast<std::uint16_t>(std::lround(code)));
  }
  return column;
}

namespace {

static_assert(std::endian::native == std::endian::little, "arrays go out as the memory has them");

constexpr std::size_t kArrayAlignment = 4;
constexpr std::size_t kBlockAlignment = 8;

void pad(std::string& text, std::size_t alignment) {
  text.append((alignment - text.size() % alignment) % alignment, '\0');
}

std::string deflated(const std::string& bytes) {
  uLongf size = compressBound(bytes.size());
  std::string stream(size, '\0');
  const int code =
      compress2(reinterpret_cast<Bytef*>(stream.data()), &size,
                reinterpret_cast<const Bytef*>(bytes.data()), bytes.size(), Z_DEFAULT_COMPRESSION);
  assert(code == Z_OK);  // the stream has room, whatever the bytes are
  static_cast<void>(code);
  stream.resize(size);
  return stream;
}

/// Appends numbers byte by byte: the lowest byte of each, then the next.
template <class Number>
void append_planes(const std::vector<Number>& numbers, std::string& bytes) {
  for (std::size_t plane = 0; plane < sizeof(Number); ++plane) {
    for (const Number number : numbers) bytes += static_cast<char>(number >> 8U * plane & 0xFFU);
  }
}

/// From each code to the next, modulo 2^16; small differences of either sign become small numbers.
std::vector<std::uint16_t> folded_differences(const std::vector<std::uint16_t>& codes) {
  std::vector<std::uint16_t> differences;
  differences.reserve(codes.size());
  std::uint16_t before = 0;
  for (const std::uint16_t code : codes) {
    const auto difference = static_cast<std::int16_t>(code - before);
    differences.push_back(
        static_cast<std::uint16_t>(difference < 0 ? -2 * difference - 1 : 2 * difference));
    before = code;
  }
  return differences;
}

}  // namespace

Json PageData::append(const char* type, const void* values, std::size_t bytes, std::size_t count) {
  pad(block_, kArrayAlignment);
  std::string text;
  if (bytes > 0) text.assign(static_cast<const char*>(values), bytes);
  const auto [place, fresh] = places_.try_emplace(std::move(text), block_.size());
  if (fresh) block_ += place->first;
  return {{"$", type}, {"at", place->second}, {"n", count}};
}

Json PageData::f32(std::span<const float> values) {
  return append("f32", values.data(), values.size_bytes(), values.size());
}

Json PageData::f32(std::span<const double> values) {
  const std::vector<float> single(values.begin(), values.end());
  return f32(std::span<const float>(single));
}

Json PageData::u8(std::span<const std::uint8_t> values) {
  return append("u8", values.data(), values.size_bytes(), values.size());
}

Json PageData::q16(std::span<const double> values, std::size_t components,
                   const Precision& precision) {
  std::string bytes;
  Json columns = Json::array();
  for (std::size_t k = 0; k < components; ++k) {
    std::vector<double> column;
    for (std::size_t i = k; i < values.size(); i += components) column.push_back(values[i]);
    if (const auto codes = quantized(column, precision)) {
      columns.push_back({{"low", codes->low}, {"step", codes->step}, {"log", codes->logarithmic}});
      append_planes(folded_differences(codes->codes), bytes);
    } else {
      std::vector<std::uint32_t> single;
      for (const double value : column) {
        single.push_back(std::bit_cast<std::uint32_t>(static_cast<float>(value)));
      }
      columns.push_back(nullptr);
      append_planes(single, bytes);
    }
  }
  Json reference = append("q16", bytes.data(), bytes.size(), values.size());
  reference["columns"] = std::move(columns);
  return reference;
}

std::string payload_bytes(const PageData& page) {
  const std::string text = json_text(page.json, -1);
  const auto length = static_cast<std::uint32_t>(text.size());
  std::string bytes(sizeof(length), '\0');
  std::memcpy(bytes.data(), &length, sizeof(length));
  bytes += text;
  pad(bytes, kBlockAlignment);
  return bytes + page.block();
}

std::string payload_text(const PageData& page) { return base64(deflated(payload_bytes(page))); }

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      group = group << 8U | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += k <= count ? kDigits[group >> (18U - 6U * k) & 63U] : '=';
    }
  }
  return text;
}

namespace {

namespace fs = std::filesystem;

constexpr std::string_view kPngSignature = "\x89PNG\r\n\x1a\n";

}  // namespace

Result<Json> pictures_json(const fs::path& folder, const std::vector<PagePicture>& pictures,
                           std::uintmax_t largest, Json& notes) {
  Json list = Json::array();
  for (const auto& [name, title] : pictures) {
    const fs::path file = folder / (name + ".png");
    if (!fs::is_regular_file(file) || fs::file_size(file) > largest) continue;
    const auto bytes = read_file(file);
    if (!bytes) return tl::unexpected(bytes.error());
    if (!bytes->starts_with(kPngSignature)) {
      notes.push_back(file.filename().string() + " is no PNG picture and is left out.");
      continue;
    }
    list.push_back({{"name", name}, {"title", title}, {"png", base64(*bytes)}});
  }
  return list;
}

}  // namespace aims
