// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "bench/scoring/score_record.hpp"
#include "core/error.hpp"

namespace aims {

/// Code of NaN in a quantized column.
inline constexpr std::uint16_t kNoCode = 65535;

/// A column as 16-bit codes: value = low + step * code, or exp of that.
struct QuantizedColumn {
  bool logarithmic = false;
  double low = 0.0;
  double step = 0.0;
  std::vector<std::uint16_t> codes;  ///< `kNoCode`: NaN
};

/// How exact a quantized column must be.
struct Precision {
  double least_step = 0.0;  ///< no finer steps than this, in the unit of the values
  /// Half of the values that are not zero must be exact to this fraction; 0: whatever the range is.
  double relative = 1e-3;
};

/// The codes of a column: linear over its range, or logarithmic where all values are positive and
/// span more than three decades. None when that misses the precision, or a value is infinite.
std::optional<QuantizedColumn> quantized(std::span<const double> values,
                                         const Precision& precision = {});

/// Version of the layout of a page's data; see web/src/contract.ts.
inline constexpr std::string_view kPageSchema = "aims.page/2";

/// What a page shows: a JSON document, and the arrays that it refers to as one block of bytes.
class PageData {
 public:
  std::string title;
  Json json = Json::object();

  /// Each appends an array to the block and gives the reference to put into `json`:
  /// {"$": type, "at": offset in bytes, "n": count}. NaN stands for no value. Equal arrays are
  /// stored once.
  Json f32(std::span<const float> values);
  Json f32(std::span<const double> values);
  Json u8(std::span<const std::uint8_t> values);

  /// The values of `components` columns, a row after the other, each column quantized on its own:
  /// "columns" has {"low", "step", "log"} of each, null for one that stays f32 since 16 bits would
  /// miss the precision. In the block each column is whole: differences of the codes from one to
  /// the next, signs folded in (0, -1, 1, -2, ...), the low bytes before the high ones; a f32
  /// column as its four planes of bytes.
  Json q16(std::span<const double> values, std::size_t components = 1,
           const Precision& precision = {});

  /// The block, little-endian; every array begins at a multiple of four.
  const std::string& block() const { return block_; }

 private:
  Json append(const char* type, const void* values, std::size_t bytes, std::size_t count);

  std::string block_;
  std::unordered_map<std::string, std::size_t> places_;  ///< of the arrays in the block
};

/// The payload before compression: length of the JSON text (u32, little-endian), the text in UTF-8
/// (what is not UTF-8 becomes \xNN, numbers that are not finite become null), zeros up to a
/// multiple of eight, the block.
std::string payload_bytes(const PageData& page);

/// The payload as it stands in the page: base64 of a zlib stream of `payload_bytes`.
std::string payload_text(const PageData& page);

/// Bytes as base64 (RFC 4648, with padding).
std::string base64(std::string_view bytes);

/// What a page shows besides its own folder.
struct PageOptions {
  std::filesystem::path against;     ///< results to hold a suite against; empty: none
  std::filesystem::path detectors;   ///< folder of `aims detectors`; empty: the suite's own, if any
  std::filesystem::path out_folder;  ///< where the page will lie: links are relative to it
};

/// A picture that a page shows: its file without ".png", and what it is.
struct PagePicture {
  std::string name;
  std::string title;
};

/// Those of the pictures that `folder` holds, for a page. One beyond `largest` [bytes] is left out;
/// so is one that is no PNG, which becomes a note.
Result<Json> pictures_json(const std::filesystem::path& folder,
                           const std::vector<PagePicture>& pictures, std::uintmax_t largest,
                           Json& notes);

}  // namespace aims
