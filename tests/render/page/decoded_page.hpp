// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace aims::testing {

/// A payload taken apart again by other means than those that made it.
struct DecodedPage {
  nlohmann::json json;
  std::string block;

  /// The array that `reference` refers to.
  template <class Number>
  std::vector<Number> array(const nlohmann::json& reference) const;
  std::vector<float> f32(const nlohmann::json& reference) const;
};

/// Bytes of base64 text.
std::string base64_decoded(std::string_view text);

/// Decodes the text between the marks of a page.
DecodedPage decoded(std::string_view payload);

/// Decodes the payload of a whole HTML file.
DecodedPage decoded_html(std::string_view html);

}  // namespace aims::testing
