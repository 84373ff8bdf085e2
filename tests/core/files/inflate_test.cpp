// SPDX-License-Identifier: BSD-3-Clause
// Streams that Python's zlib packed.
#include "core/files/inflate.hpp"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

namespace aims {
namespace {

/// Letters of a linear congruential generator, with ten dots behind each thirty.
std::string content(int size) {
  std::uint64_t x = 7;
  std::string text;
  for (int i = 0; i < size; ++i) {
    x = (1103515245 * x + 12345) & 0x7fffffff;
    text += i % 40 < 30 ? static_cast<char>((x >> 16) % 6 + 'a') : '.';
  }
  return text;
}

std::vector<std::byte> bytes_of(const std::string& hex) {
  std::vector<std::byte> bytes;
  for (std::size_t i = 0; i < hex.size(); i += 2) {
    bytes.push_back(static_cast<std::byte>(std::stoi(hex.substr(i, 2), nullptr, 16)));
  }
  return bytes;
}

/// Of zlib with levels 0 and 9, of gzip, and without a header.
const std::string kStored = "7801011400ebff6563636166666163666666626363666562636563520707cf";
const std::string kFixed = "78da4b4c4a8443001dbe0493";
const std::string kDynamic =
    "78da5590c991c3300c0433da9c3007f20fc10d3f2c2dab2412670f507b76c7bb2b7b2b17474656ecbfdf"
    "89471d93288582d9692635b7f5e469af2e2648cbcdaaeed016c37df26646788e2278aa16661a1e79f5db"
    "a0252d90290622f62ac7ddbef4ad696884e39e35893e29b843e0a50fc11124310be1fa9ed41421fbe4dd"
    "226ec642bfd9698899fbf8bdb8420dea63a0606f0a5c40d37fdc616f8cc6997c77c1a14e3ac693f701a5"
    "05867f";
const std::string kGzip =
    "1f8b08000000000002033dc8b10100200cc3b08ff82971ebff4f80098d5a8806b5e0967d31291d38df05"
    "39f235dd28000000";
const std::string kBare = "3dc8b10100200cc3b08ff82971ebff4f80098d5a8806b5e0967d31291d38df05";

std::string unpacked(const std::string& hex, std::size_t limit = 1000) {
  const auto out = inflate(bytes_of(hex), limit);
  if (!out) return "error: " + out.error().message;
  return {reinterpret_cast<const char*>(out->data()), out->size()};
}

TEST(Inflate, UnpacksWhatZlibPacked) {
  EXPECT_EQ(unpacked(kStored), content(20));
  EXPECT_EQ(unpacked(kFixed), "abababababab");
  EXPECT_EQ(unpacked(kDynamic), content(400));
  EXPECT_EQ(unpacked(kGzip), content(40));
  EXPECT_EQ(unpacked(kBare), content(40));
}

TEST(Inflate, RefusesWhatIsNoSuchStream) {
  EXPECT_EQ(unpacked(kDynamic, 399), "error: unpacks to more than expected");
  EXPECT_TRUE(unpacked(kDynamic.substr(0, 80)).starts_with("error: "));
  EXPECT_EQ(unpacked(""), "error: ends within compressed data");
  EXPECT_EQ(unpacked("07"), "error: no sound compressed data");
}

TEST(Inflate, SurvivesEveryChangedByte) {
  constexpr unsigned kSeed = 5;
  std::mt19937 random(kSeed);
  const std::vector<std::byte> packed = bytes_of(kDynamic);
  for (std::size_t at = 0; at < packed.size(); ++at) {
    for (int i = 0; i < 20; ++i) {
      std::vector<std::byte> changed = packed;
      changed[at] = static_cast<std::byte>(random());
      const auto out = inflate(changed, 1000);
      if (out) {
        EXPECT_LE(out->size(), 1000U) << "seed " << kSeed;
      }
    }
  }
}

}  // namespace
}  // namespace aims
