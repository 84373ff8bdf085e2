// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <span>
#include <string>
#include <string_view>

namespace aims {

/// Version of the layout of a page's data; see web/src/contract.ts.
inline constexpr std::string_view kPageSchema = "aims.page/1";

/// What a page shows: a JSON document, and the arrays that it refers to as one block of bytes.
class PageData {
 public:
  using Json = nlohmann::ordered_json;

  std::string title;
  Json json = Json::object();

  /// Each appends an array to the block and gives the reference to put into `json`:
  /// {"$": type, "at": offset in bytes, "n": count}. NaN stands for no value.
  Json f32(std::span<const float> values);
  Json f32(std::span<const double> values);
  Json u16(std::span<const std::uint16_t> values);
  Json u8(std::span<const std::uint8_t> values);

  /// The block, little-endian; every array begins at a multiple of four.
  const std::string& block() const { return block_; }

 private:
  Json append(const char* type, const void* values, std::size_t bytes, std::size_t count);

  std::string block_;
};

/// The payload before compression: length of the JSON text (u32, little-endian), the text in UTF-8
/// (what is not UTF-8 becomes \xNN, numbers that are not finite become null), zeros up to a
/// multiple of eight, the block.
std::string payload_bytes(const PageData& page);

/// The payload as it stands in the page: base64 of a zlib stream of `payload_bytes`.
std::string payload_text(const PageData& page);

/// Bytes as base64 (RFC 4648, with padding).
std::string base64(std::string_view bytes);

}  // namespace aims
