// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/inflate.hpp"

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

namespace aims {
namespace {

constexpr int kLongestCode = 15;  ///< [bit]

/// Bits of a stream, the lowest of each byte first. Behind its end they are zero, and counted.
class Bits {
 public:
  explicit Bits(std::span<const std::byte> bytes) : bytes_(bytes) {}

  std::uint32_t take(int count) {
    while (held_ < count) {
      const std::uint32_t next =
          at_ < bytes_.size() ? std::to_integer<std::uint32_t>(bytes_[at_]) : 0;
      ++at_;
      bits_ |= next << held_;
      held_ += 8;
    }
    const std::uint32_t value = bits_ & ((1U << count) - 1);
    bits_ >>= count;
    held_ -= count;
    return value;
  }

  void align() { take(held_ % 8); }
  bool ended() const { return at_ > bytes_.size() + 4; }

 private:
  std::span<const std::byte> bytes_;
  std::size_t at_ = 0;
  std::uint32_t bits_ = 0;
  int held_ = 0;
};

/// A Huffman code, by the number of codes of each length and the symbols in order of their codes.
struct Code {
  std::array<int, kLongestCode + 1> counts{};
  std::vector<int> symbols;

  explicit Code(std::span<const std::uint8_t> lengths) {
    for (const std::uint8_t length : lengths) ++counts[length];
    counts[0] = 0;
    for (int length = 1; length <= kLongestCode; ++length) {
      for (std::size_t symbol = 0; symbol < lengths.size(); ++symbol) {
        if (lengths[symbol] == length) symbols.push_back(static_cast<int>(symbol));
      }
    }
  }

  std::optional<int> next(Bits& bits) const {
    int code = 0, first = 0, index = 0;
    for (int length = 1; length <= kLongestCode; ++length) {
      code |= static_cast<int>(bits.take(1));
      const int count = counts[static_cast<std::size_t>(length)];
      if (code < first) return std::nullopt;  // more codes than their lengths allow
      if (code - first < count) return symbols[static_cast<std::size_t>(index + code - first)];
      index += count;
      first = (first + count) << 1;
      code <<= 1;
    }
    return std::nullopt;
  }
};

// Lengths and distances of repetitions (RFC 1951, 3.2.5): the first of each symbol and its bits.
constexpr std::array<int, 29> kLength = {3,  4,  5,  6,   7,   8,   9,   10,  11, 13,
                                         15, 17, 19, 23,  27,  31,  35,  43,  51, 59,
                                         67, 83, 99, 115, 131, 163, 195, 227, 258};
constexpr std::array<int, 29> kLengthBits = {0, 0, 0, 0, 0, 0, 0, 0, 1, 1, 1, 1, 2, 2, 2,
                                             2, 3, 3, 3, 3, 4, 4, 4, 4, 5, 5, 5, 5, 0};

int first_distance(int symbol) {
  return symbol < 4 ? symbol + 1 : ((2 + symbol % 2) << (symbol / 2 - 1)) + 1;
}

int distance_bits(int symbol) { return symbol < 4 ? 0 : symbol / 2 - 1; }

class Inflater {
 public:
  Inflater(std::span<const std::byte> packed, std::size_t limit) : bits_(packed), limit_(limit) {}

  Result<std::vector<std::byte>> run() {
    bool last = false;
    while (!last) {
      last = bits_.take(1) == 1;
      const std::uint32_t kind = bits_.take(2);
      bool good = false;
      if (kind == 0) good = stored();
      if (kind == 1) good = coded(fixed_lengths(), Code(std::vector<std::uint8_t>(30, 5)));
      if (kind == 2) good = dynamic();
      if (!good) return refuse();
    }
    return std::move(out_);
  }

 private:
  tl::unexpected<Error> refuse() const {
    if (too_long_) return failure("unpacks to more than expected");
    return failure(bits_.ended() ? "ends within compressed data" : "no sound compressed data");
  }

  bool put(std::byte byte) {
    too_long_ = out_.size() >= limit_;
    if (!too_long_) out_.push_back(byte);
    return !too_long_;
  }

  bool stored() {
    bits_.align();
    const std::uint32_t length = bits_.take(16), inverse = bits_.take(16);
    if (length != (inverse ^ 0xffff)) return false;
    for (std::uint32_t i = 0; i < length; ++i) {
      if (bits_.ended() || !put(static_cast<std::byte>(bits_.take(8)))) return false;
    }
    return true;
  }

  static Code fixed_lengths() {
    std::vector<std::uint8_t> lengths(288, 8);
    std::fill(lengths.begin() + 144, lengths.begin() + 256, std::uint8_t{9});
    std::fill(lengths.begin() + 256, lengths.begin() + 280, std::uint8_t{7});
    return Code(lengths);
  }

  bool dynamic() {
    constexpr std::array<std::size_t, 19> kOrder = {16, 17, 18, 0, 8,  7, 9,  6, 10, 5,
                                                    11, 4,  12, 3, 13, 2, 14, 1, 15};
    const std::size_t literals = bits_.take(5) + 257, distances = bits_.take(5) + 1;
    const std::size_t codes = bits_.take(4) + 4;
    std::array<std::uint8_t, 19> of_lengths{};
    for (std::size_t i = 0; i < codes; ++i) {
      of_lengths[kOrder[i]] = static_cast<std::uint8_t>(bits_.take(3));
    }
    const Code code(of_lengths);
    std::vector<std::uint8_t> lengths;
    while (lengths.size() < literals + distances) {
      const auto symbol = code.next(bits_);
      if (!symbol || bits_.ended()) return false;
      if (*symbol < 16) {
        lengths.push_back(static_cast<std::uint8_t>(*symbol));
        continue;
      }
      if (*symbol == 16 && lengths.empty()) return false;
      const std::uint8_t value = *symbol == 16 ? lengths.back() : std::uint8_t{0};
      const std::uint32_t times = *symbol == 16   ? 3 + bits_.take(2)
                                  : *symbol == 17 ? 3 + bits_.take(3)
                                                  : 11 + bits_.take(7);
      lengths.insert(lengths.end(), times, value);
    }
    if (lengths.size() != literals + distances) return false;
    const std::span<const std::uint8_t> all(lengths);
    return coded(Code(all.first(literals)), Code(all.subspan(literals)));
  }

  bool coded(const Code& literals, const Code& distances) {
    constexpr int kEnd = 256, kFirstLength = 257;
    while (!bits_.ended()) {
      const auto symbol = literals.next(bits_);
      if (!symbol) return false;
      if (*symbol == kEnd) return true;
      if (*symbol < kEnd) {
        if (!put(static_cast<std::byte>(*symbol))) return false;
        continue;
      }
      const auto at = static_cast<std::size_t>(*symbol - kFirstLength);
      if (at >= kLength.size()) return false;
      const int length = kLength[at] + static_cast<int>(bits_.take(kLengthBits[at]));
      const auto place = distances.next(bits_);
      if (!place || *place >= 30) return false;
      const auto distance =
          static_cast<std::size_t>(first_distance(*place)) + bits_.take(distance_bits(*place));
      if (distance > out_.size()) return false;
      for (int i = 0; i < length; ++i) {
        if (!put(out_[out_.size() - distance])) return false;
      }
    }
    return false;
  }

  Bits bits_;
  std::size_t limit_;
  std::vector<std::byte> out_;
  bool too_long_ = false;
};

int header_byte(std::span<const std::byte> bytes, std::size_t at) {
  return at < bytes.size() ? std::to_integer<int>(bytes[at]) : -1;
}

/// The size of a header of gzip; 0 for none.
std::size_t gzip_header(std::span<const std::byte> bytes) {
  if (header_byte(bytes, 0) != 0x1f || header_byte(bytes, 1) != 0x8b || bytes.size() < 18) return 0;
  constexpr int kExtra = 4, kName = 8, kComment = 16, kCheck = 2;
  const int flags = header_byte(bytes, 3);
  std::size_t at = 10;
  if ((flags & kExtra) != 0) {
    at += 2 + static_cast<std::size_t>(header_byte(bytes, at) + 256 * header_byte(bytes, at + 1));
  }
  for (const int text : {kName, kComment}) {
    if ((flags & text) == 0) continue;
    while (at < bytes.size() && bytes[at] != std::byte{0}) ++at;
    ++at;
  }
  return at + ((flags & kCheck) != 0 ? 2 : 0);
}

}  // namespace

Result<std::vector<std::byte>> inflate(std::span<const std::byte> packed, std::size_t limit) {
  std::size_t header = gzip_header(packed);
  const int first = header_byte(packed, 0), second = header_byte(packed, 1);
  // Deflate in a window of at most 32 kB, without a dictionary; both bytes together divide by 31.
  const bool zlib = header == 0 && first >= 0 && second >= 0 && first % 16 == 8 &&
                    first / 16 <= 7 && (256 * first + second) % 31 == 0 && (second & 0x20) == 0;
  if (zlib) header = 2;
  return Inflater(packed.subspan(std::min(header, packed.size())), limit).run();
}

}  // namespace aims
