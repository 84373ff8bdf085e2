// SPDX-License-Identifier: BSD-3-Clause
#include "render/film/webp.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <vector>

#include "tests/render/film/webp_file.hpp"

namespace aims {
namespace {

using test::read_webp;
using test::WebpFile;

/// A bright square that moves over a striped ground.
Result<Image> moving_square(int frame) {
  Image picture(96, 64);
  for (int row = 0; row < picture.height; ++row) {
    for (int column = 0; column < picture.width; ++column) {
      picture.set(column, row,
                  row % 16 < 8 ? std::array<std::uint8_t, 3>{20, 40, 60}
                               : std::array<std::uint8_t, 3>{60, 80, 100});
    }
  }
  for (int row = 20; row < 36; ++row) {
    for (int column = 8 * frame; column < 8 * frame + 16; ++column) {
      picture.set(column, row, {255, static_cast<std::uint8_t>(20 * frame), 0});
    }
  }
  return picture;
}

Movie moving() { return {96, 64, 10, 8.0, 1.5, moving_square}; }

double mean_difference(const Image& a, const Image& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.rgb.size(); ++i) sum += std::abs(a.rgb[i] - b.rgb[i]);
  return sum / static_cast<double>(a.rgb.size());
}

TEST(Webp, HoldsTheFramesInTheirOrder) {
  const auto bytes = webp_bytes(moving());
  ASSERT_TRUE(bytes) << bytes.error().message;
  const WebpFile file = read_webp(*bytes);
  ASSERT_EQ(file.frames.size(), 10U);
  for (int i = 0; i < 10; ++i) {
    const Image& frame = file.frames[static_cast<std::size_t>(i)];
    ASSERT_EQ(frame.width, 96);
    ASSERT_EQ(frame.height, 64);
    const double own = mean_difference(frame, *moving_square(i));
    EXPECT_LT(own, 3.0) << i;
    EXPECT_LT(2.0 * own, mean_difference(frame, *moving_square(i == 9 ? 8 : i + 1))) << i;
  }
}

TEST(Webp, LoopsWithoutEndAndHoldsTheLastFrame) {
  const WebpFile file = read_webp(*webp_bytes(moving()));
  EXPECT_EQ(file.loops, 0);
  ASSERT_EQ(file.durations_ms.size(), 10U);
  EXPECT_EQ(file.durations_ms.front(), 125);
  EXPECT_EQ(file.durations_ms.back(), 1500);
}

TEST(Webp, ARateThatDividesNoMillisecondKeepsTheLength) {
  Movie movie = moving();
  movie.frame_rate = 12.0;
  int sum_ms = 0;
  for (const int duration : read_webp(*webp_bytes(movie)).durations_ms) sum_ms += duration;
  EXPECT_EQ(sum_ms, 750 + 1500);
}

TEST(Webp, EqualFramesBecomeOneLongerFrame) {
  Movie movie = moving();
  movie.draw = [](int frame) { return moving_square(frame < 6 ? 3 : 7); };
  EXPECT_EQ(read_webp(*webp_bytes(movie)).durations_ms,
            (std::vector<int>{6 * 125, 3 * 125 + 1500}));
}

TEST(Webp, SameMovieGivesTheSameBytes) { EXPECT_EQ(*webp_bytes(moving()), *webp_bytes(moving())); }

TEST(Webp, RefusesAMovieThatCannotBeEncoded) {
  Movie other = moving();
  other.draw = [](int frame) -> Result<Image> {
    return frame < 5 ? *moving_square(0) : Image(3, 2);
  };
  const auto wrong_size = webp_bytes(other);
  ASSERT_FALSE(wrong_size);
  EXPECT_NE(wrong_size.error().message.find("3 x 2"), std::string::npos);
  other.draw = [](int) -> Result<Image> { return failure("no light"); };
  const auto undrawn = webp_bytes(other);
  ASSERT_FALSE(undrawn);
  EXPECT_EQ(undrawn.error().message, "no light");
  other.frames = 0;
  EXPECT_FALSE(webp_bytes(other));
}

}  // namespace
}  // namespace aims
