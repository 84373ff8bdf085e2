// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>

#include "core/files/atomic_file.hpp"

namespace aims {
namespace {

using namespace std::string_view_literals;

void append_utf8(std::uint32_t point, std::string& text) {
  const auto put = [&text](std::uint32_t byte) { text += static_cast<char>(byte); };
  if (point < 0x80) return put(point);
  if (point < 0x800) {
    put(0xc0 | point >> 6);
  } else if (point < 0x10000) {
    put(0xe0 | point >> 12);
    put(0x80 | (point >> 6 & 0x3f));
  } else {
    put(0xf0 | point >> 18);
    put(0x80 | (point >> 12 & 0x3f));
    put(0x80 | (point >> 6 & 0x3f));
  }
  put(0x80 | (point & 0x3f));
}

/// Nothing for a lone surrogate or an odd number of bytes.
std::optional<std::string> text_of_utf16(std::string_view bytes, bool little) {
  const auto unit = [&](std::size_t at) {
    const auto first = static_cast<unsigned char>(bytes[at]);
    const auto second = static_cast<unsigned char>(bytes[at + 1]);
    return static_cast<std::uint32_t>(little ? second << 8 | first : first << 8 | second);
  };
  if (bytes.size() % 2 != 0) return std::nullopt;
  std::string text;
  text.reserve(bytes.size() / 2);
  for (std::size_t at = 0; at < bytes.size(); at += 2) {
    std::uint32_t point = unit(at);
    if (point >= 0xdc00 && point < 0xe000) return std::nullopt;
    if (point >= 0xd800 && point < 0xdc00) {
      at += 2;
      const std::uint32_t low = at < bytes.size() ? unit(at) : 0;
      if (low < 0xdc00 || low >= 0xe000) return std::nullopt;
      point = 0x10000 + ((point - 0xd800) << 10) + (low - 0xdc00);
    }
    append_utf8(point, text);
  }
  return text;
}

/// Whether every second of the first bytes is zero, as of Latin text in UTF-16.
bool looks_like_utf16(std::string_view bytes) {
  constexpr std::size_t kLooked = 64;
  const std::string_view head = bytes.substr(0, kLooked);
  std::size_t even = 0, odd = 0;
  for (std::size_t i = 0; i < head.size(); ++i) (i % 2 == 0 ? even : odd) += head[i] == '\0';
  return head.size() >= 4 && std::max(even, odd) >= head.size() / 2 - 1 && std::min(even, odd) == 0;
}

}  // namespace

Result<std::string> utf8_of(std::string bytes, const std::string& name) {
  const std::string_view all = bytes;
  const bool little = all.starts_with("\xff\xfe"), big = all.starts_with("\xfe\xff");
  if (all.starts_with("\xff\xfe\0\0"sv) || all.starts_with("\0\0\xfe\xff"sv)) {
    return failure(name + ": expected text in UTF-8 or UTF-16, found UTF-32: save it as UTF-8");
  }
  if (little || big) {
    auto text = text_of_utf16(all.substr(2), little);
    if (text) return std::move(*text);
    return failure(name + ": damaged UTF-16 (a lone surrogate or half a character)");
  }
  if (looks_like_utf16(all)) {
    return failure(name +
                   ": expected text in UTF-8, found every second byte zero, as of UTF-16 "
                   "without a byte order mark: save it as UTF-8");
  }
  return bytes;
}

Result<std::string> read_text_file(const std::filesystem::path& file, std::size_t most) {
  auto bytes = read_file(file, most);
  if (!bytes) return bytes;
  return utf8_of(std::move(*bytes), file.string());
}

}  // namespace aims
