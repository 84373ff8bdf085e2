// SPDX-License-Identifier: BSD-3-Clause
#include "tests/render/page/decoded_page.hpp"

#include <zlib.h>

#include <boost/archive/iterators/binary_from_base64.hpp>
#include <boost/archive/iterators/transform_width.hpp>
#include <cmath>
#include <cstring>
#include <limits>
#include <stdexcept>

namespace aims::testing {
namespace {

std::string inflated(const std::string& stream) {
  z_stream state{};
  inflateInit(&state);
  state.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(stream.data()));
  state.avail_in = static_cast<uInt>(stream.size());
  std::string bytes;
  std::vector<char> piece(1 << 16);
  int code = Z_OK;
  while (code == Z_OK) {
    state.next_out = reinterpret_cast<Bytef*>(piece.data());
    state.avail_out = static_cast<uInt>(piece.size());
    code = inflate(&state, Z_NO_FLUSH);
    bytes.append(piece.data(), piece.size() - state.avail_out);
  }
  inflateEnd(&state);
  if (code != Z_STREAM_END) throw std::runtime_error("the zlib stream has no end");
  return bytes;
}

/// Byte of a plane: plane k of a column holds byte k of each of its rows.
std::uint32_t byte_of(const std::string& block, std::size_t at, std::size_t plane, std::size_t rows,
                      std::size_t row) {
  return static_cast<unsigned char>(block.at(at + plane * rows + row));
}

std::vector<float> dequantized(const DecodedPage& page, const nlohmann::json& reference) {
  const auto& columns = reference.at("columns");
  const auto count = reference.at("n").get<std::size_t>();
  const std::size_t rows = count / columns.size();
  auto at = reference.at("at").get<std::size_t>();
  std::vector<float> values(count);
  for (std::size_t k = 0; k < columns.size(); ++k) {
    const auto& column = columns[k];
    int code = 0;
    for (std::size_t i = 0; i < rows; ++i) {
      float& value = values[i * columns.size() + k];
      std::uint32_t bits = 0;
      const std::size_t width = column.is_null() ? 4 : 2;
      for (std::size_t plane = 0; plane < width; ++plane) {
        bits |= byte_of(page.block, at, plane, rows, i) << 8U * plane;
      }
      if (column.is_null()) {
        std::memcpy(&value, &bits, sizeof(value));
        continue;
      }
      const int folded = static_cast<int>(bits);
      code = (code + (folded % 2 == 0 ? folded / 2 : -(folded + 1) / 2) + 65536) % 65536;
      const double place = column.at("low").get<double>() + column.at("step").get<double>() * code;
      value = static_cast<float>(column.at("log").get<bool>() ? std::exp(place) : place);
      if (code == 65535) value = std::numeric_limits<float>::quiet_NaN();
    }
    at += rows * (column.is_null() ? 4 : 2);
  }
  return values;
}

}  // namespace

std::string base64_decoded(std::string_view text) {
  using boost::archive::iterators::binary_from_base64;
  using boost::archive::iterators::transform_width;
  using Bytes = transform_width<binary_from_base64<const char*>, 8, 6>;
  const std::size_t padding = text.size() - text.find_last_not_of('=') - 1;
  std::string digits(text);
  digits.replace(digits.size() - padding, padding, padding, 'A');
  std::string bytes(Bytes(digits.data()), Bytes(digits.data() + digits.size()));
  bytes.resize(bytes.size() - padding);
  return bytes;
}

DecodedPage decoded(std::string_view payload) {
  const std::string bytes = inflated(base64_decoded(payload));
  std::uint32_t length = 0;
  std::memcpy(&length, bytes.data(), sizeof(length));
  const std::size_t end = (sizeof(length) + length + 7) / 8 * 8;
  return {nlohmann::json::parse(bytes.substr(sizeof(length), length)), bytes.substr(end)};
}

DecodedPage decoded_html(std::string_view html) {
  const std::string_view mark = "id=\"aims-data\"";
  const std::size_t element = html.find('>', html.find(mark)) + 1;
  return decoded(html.substr(element, html.find('<', element) - element));
}

template <class Number>
std::vector<Number> DecodedPage::array(const nlohmann::json& reference) const {
  std::vector<Number> values(reference.at("n").get<std::size_t>());
  const auto at = reference.at("at").get<std::size_t>();
  if (at + values.size() * sizeof(Number) > block.size())
    throw std::runtime_error("beyond the block");
  std::memcpy(values.data(), block.data() + at, values.size() * sizeof(Number));
  return values;
}

template std::vector<float> DecodedPage::array<float>(const nlohmann::json&) const;
template std::vector<std::uint16_t> DecodedPage::array<std::uint16_t>(const nlohmann::json&) const;
template std::vector<std::uint8_t> DecodedPage::array<std::uint8_t>(const nlohmann::json&) const;

std::vector<float> DecodedPage::f32(const nlohmann::json& reference) const {
  if (reference.at("$") == "q16") return dequantized(*this, reference);
  if (reference.at("$") != "f32") throw std::runtime_error("expected f32 or q16");
  return array<float>(reference);
}

}  // namespace aims::testing
