// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <string>

#include "core/files/byte_cursor.hpp"
#include "tests/fuzz/fuzz_targets.hpp"
#include "tests/fuzz/touch.hpp"

namespace aims {
namespace {

void touch_definition_and_message(std::span<const std::uint8_t> input, MessageFormat format) {
  ByteCursor cursor(std::as_bytes(input));
  const auto size = cursor.number<std::uint16_t>();
  if (!size) return;
  const auto definition = cursor.take(std::min<std::size_t>(*size, cursor.left()));
  const auto decoder = MessageDecoder::create("p/T", as_text(*definition), format);
  if (!decoder) return;
  touch_message(*decoder, *cursor.take(cursor.left()));
}

}  // namespace

void fuzz_message(std::span<const std::uint8_t> input) {
  touch_definition_and_message(input, kRos1Format);
}

void fuzz_cdr(std::span<const std::uint8_t> input) {
  touch_definition_and_message(input, kRos2Format);
  touch_definition_and_message(input, {Serialization::kCdr, DefinitionLanguage::kRos2Idl});
}

}  // namespace aims
