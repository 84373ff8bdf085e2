// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/ply.hpp"

#include <gtest/gtest.h>

#include <cstring>
#include <limits>

namespace aims {
namespace {

using Eigen::Vector3f;

std::string bytes_of(const std::vector<float>& numbers) {
  std::string bytes(numbers.size() * sizeof(float), '\0');
  std::memcpy(bytes.data(), numbers.data(), bytes.size());
  return bytes;
}

void expect_refused(const std::string& text, const std::string& expected) {
  const auto points = parse_ply(text, "map.ply");
  ASSERT_FALSE(points);
  EXPECT_NE(points.error().message.find("map.ply"), std::string::npos);
  EXPECT_NE(points.error().message.find(expected), std::string::npos) << points.error().message;
}

TEST(Ply, GivesBackThePointsBitForBit) {
  const std::vector<Vector3f> points = {{0.1F, -2.5F, 1e-30F},
                                        {std::numeric_limits<float>::max(), 0.0F, -0.0F}};
  const auto back = parse_ply(ply_text(points), "map.ply");
  ASSERT_TRUE(back) << back.error().message;
  EXPECT_EQ(*back, points);
  EXPECT_TRUE(parse_ply(ply_text({}), "map.ply")->empty());
}

TEST(Ply, IsTheFormatThatOthersRead) {
  const std::vector<Vector3f> points = {{1.0F, 2.0F, 3.0F}};
  EXPECT_EQ(ply_text(points),
            "ply\nformat binary_little_endian 1.0\nelement vertex 1\nproperty float x\n"
            "property float y\nproperty float z\nend_header\n" +
                bytes_of({1.0F, 2.0F, 3.0F}));
}

TEST(Ply, SkipsOtherProperties) {
  const std::string text =
      "ply\r\nformat binary_little_endian 1.0\r\ncomment by hand\r\nelement vertex 2\r\n"
      "property float32 x\r\nproperty float32 y\r\nproperty float32 z\r\nproperty uchar red\r\n"
      "element face 1\r\nproperty list uchar int vertex_indices\r\nend_header\r\n" +
      bytes_of({1.0F, 2.0F, 3.0F}) + "\x07" + bytes_of({4.0F, 5.0F, 6.0F}) + "\x09rest";
  const auto points = parse_ply(text, "map.ply");
  ASSERT_TRUE(points) << points.error().message;
  EXPECT_EQ(*points, (std::vector<Vector3f>{{1.0F, 2.0F, 3.0F}, {4.0F, 5.0F, 6.0F}}));
}

TEST(Ply, NamesWhatWasExpected) {
  const std::string head = "ply\nformat binary_little_endian 1.0\n";
  const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
  expect_refused("", "'ply'");
  expect_refused("ply\nformat ascii 1.0\n", "binary_little_endian");
  expect_refused(head + "element vertex 1\n" + xyz, "end_header");
  expect_refused(head + "element face 1\nend_header\n", "element vertex COUNT");
  expect_refused(head + "element vertex -1\n" + xyz + "end_header\n", "element vertex COUNT");
  expect_refused(head + "element vertex 1\nproperty double x\nend_header\n", "float x, float y");
  expect_refused(head + "end_header\n", "float x, float y");
  expect_refused(head + "element vertex 2\n" + xyz + "end_header\n" + bytes_of({1, 2, 3, 4, 5}),
                 "2 vertices of 12 bytes, found 20");
  expect_refused(head + "element vertex 99999999999999999\n" + xyz + "end_header\n", "vertices");
}

}  // namespace
}  // namespace aims
