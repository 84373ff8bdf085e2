// SPDX-License-Identifier: BSD-3-Clause
#include "render/film/apng.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <array>
#include <cstdio>
#include <fstream>
#include <memory>
#include <sstream>

#include "render/film/color_table.hpp"
#include "tests/render/film/apng_file.hpp"
#include "tests/render/plots/picture_file.hpp"

namespace aims {
namespace {

using test::ApngFile;
using test::PictureFolder;
using test::read_apng;
using test::read_png;

/// A square of changing colour that walks over a striped ground.
Result<Image> walking_square(int frame) {
  Image picture(48, 32);
  for (int row = 0; row < picture.height; ++row) {
    for (int column = 0; column < picture.width; ++column) {
      picture.set(column, row,
                  row % 8 < 4 ? std::array<std::uint8_t, 3>{20, 40, 60}
                              : std::array<std::uint8_t, 3>{200, 180, 160});
    }
  }
  for (int row = 10; row < 18; ++row) {
    for (int column = 4 * frame; column < 4 * frame + 8; ++column) {
      picture.set(column, row, {255, static_cast<std::uint8_t>(20 * frame), 0});
    }
  }
  return picture;
}

Movie walking() { return {48, 32, 10, 8.0, 1.5, walking_square}; }

void write(const std::filesystem::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

/// What a program prints.
std::string output_of(const std::string& command) {
  const std::unique_ptr<FILE, int (*)(FILE*)> pipe(popen(command.c_str(), "r"), pclose);
  std::string output;
  std::array<char, 4096> buffer{};
  for (std::size_t n = 0; pipe && (n = fread(buffer.data(), 1, buffer.size(), pipe.get())) > 0;) {
    output.append(buffer.data(), n);
  }
  return output;
}

bool is_there(const char* program) {
  return system((std::string("command -v ") + program + " >/dev/null 2>&1").c_str()) == 0;
}

TEST(Apng, HoldsTheFramesThatWereDrawn) {
  const auto bytes = apng_bytes(walking());
  ASSERT_TRUE(bytes) << bytes.error().message;
  const ApngFile file = read_apng(*bytes);
  ASSERT_EQ(file.fault, "");
  EXPECT_EQ(file.declared_frames, 10);
  ASSERT_EQ(file.frames.size(), 10U);
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(file.frames[static_cast<std::size_t>(i)].rgb, walking_square(i)->rgb) << i;
  }
}

TEST(Apng, PlaysWithoutEndAndRestsOnTheLastFrame) {
  const ApngFile file = read_apng(*apng_bytes(walking()));
  EXPECT_EQ(file.plays, 0);
  ASSERT_EQ(file.stays_s.size(), 10U);
  EXPECT_DOUBLE_EQ(file.stays_s.front(), 0.125);
  EXPECT_DOUBLE_EQ(file.stays_s.back(), 1.5);
}

TEST(Apng, WritesOnlyWhatChanged) {
  const ApngFile file = read_apng(*apng_bytes(walking()));
  EXPECT_EQ(file.patch_pixels.front(), 48U * 32U);
  for (std::size_t i = 1; i < file.patch_pixels.size(); ++i) {
    EXPECT_EQ(file.patch_pixels[i], 12U * 8U) << i;  // the square before and now
  }
}

TEST(Apng, AFrameThatEqualsTheOneBeforeIsOnePixel) {
  Movie still = walking();
  still.draw = [](int) { return walking_square(3); };
  const ApngFile file = read_apng(*apng_bytes(still));
  ASSERT_EQ(file.fault, "");
  EXPECT_EQ(file.patch_pixels.back(), 1U);
  EXPECT_EQ(file.frames.back().rgb, walking_square(3)->rgb);
}

TEST(Apng, IsTheFirstFrameToAViewerOfPlainPng) {
  const PictureFolder folder;
  write(folder / "walk.png", *apng_bytes(walking()));
  EXPECT_EQ(read_png(folder / "walk.png").rgb, walking_square(0)->rgb);
}

TEST(Apng, SameMovieGivesTheSameBytes) {
  EXPECT_EQ(*apng_bytes(walking()), *apng_bytes(walking()));
}

TEST(Apng, RefusesWhatIsNoMovie) {
  Movie other = walking();
  other.draw = [](int frame) -> Result<Image> {
    return frame < 5 ? *walking_square(0) : Image(3, 2);
  };
  const auto wrong_size = apng_bytes(other);
  ASSERT_FALSE(wrong_size);
  EXPECT_NE(wrong_size.error().message.find("3 x 2"), std::string::npos);
  other.draw = [](int) -> Result<Image> { return failure("no light"); };
  const auto undrawn = apng_bytes(other);
  ASSERT_FALSE(undrawn);
  EXPECT_EQ(undrawn.error().message, "no light");
  other.frames = 0;
  EXPECT_FALSE(apng_bytes(other));
}

TEST(Apng, FfmpegDecodesTheSameFrames) {
  if (!is_there("ffmpeg")) GTEST_SKIP() << "ffmpeg is not on PATH";
  const PictureFolder folder;
  write(folder / "walk.apng", *apng_bytes(walking()));
  const std::string raw =
      output_of("ffmpeg -loglevel error -f apng -i '" + (folder / "walk.apng").string() +
                "' -vsync 0 -f rawvideo -pix_fmt rgb24 - 2>/dev/null");
  ASSERT_GE(raw.size(), 10U * 48U * 32U * 3U);
  for (int i = 0; i < 10; ++i) {
    const auto drawn = walking_square(i)->rgb;
    const std::string frame = raw.substr(static_cast<std::size_t>(i) * drawn.size(), drawn.size());
    EXPECT_TRUE(std::equal(drawn.begin(), drawn.end(), frame.begin(), [](std::uint8_t a, char b) {
      return a == static_cast<std::uint8_t>(b);
    })) << i;
  }
}

/// Decodes every frame and writes pixel values, sum by sum, into the page.
constexpr const char* kDecodingPage = R"(<body><pre id="out">nothing</pre><script>
let done = false;
const wait = () => {  // the page's clock stands still while others decode: spend time on purpose
  for (let i = 0, x = 0; i < 2e7; ++i) x += i * i;
  if (!done) setTimeout(wait, 100);
};
wait();
(async () => {
  const bytes = Uint8Array.from(atob("@"), c => c.charCodeAt(0));
  const decoder = new ImageDecoder({data: bytes, type: "image/png"});
  await decoder.completed; await decoder.tracks.ready;
  const track = decoder.tracks.selectedTrack;
  let text = `frames ${track.frameCount} loops ${track.repetitionCount}`;
  for (let i = 0; i < track.frameCount; ++i) {
    const {image} = await decoder.decode({frameIndex: i});
    const canvas = new OffscreenCanvas(image.displayWidth, image.displayHeight);
    const context = canvas.getContext("2d");
    context.drawImage(image, 0, 0);
    const {data} = context.getImageData(0, 0, canvas.width, canvas.height);
    let sum = 0;
    for (let k = 0; k < data.length; k += 4)
      for (let c = 0; c < 3; ++c) sum = (sum * 31 + data[k + c]) % 1000003;
    text += ` ${sum}`;
  }
  document.getElementById("out").textContent = text;
  done = true;
})();
</script></body>)";

std::string base64(const std::string& bytes) {
  constexpr const char* kDigits =
      "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    std::uint32_t value = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      value = value << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    }
    for (std::size_t k = 0; k < 4; ++k) {
      text += i + k > bytes.size() ? '=' : kDigits[value >> (18 - 6 * k) & 63U];
    }
  }
  return text;
}

TEST(Apng, ChromiumDecodesTheSameFrames) {
  if (!is_there("chromium")) GTEST_SKIP() << "chromium is not on PATH";
  std::string expected = "frames 10 loops Infinity";
  for (int i = 0; i < 10; ++i) {
    int sum = 0;
    const auto frame = walking_square(i);
    for (const std::uint8_t value : frame->rgb) sum = (sum * 31 + value) % 1000003;
    expected += fmt::format(" {}", sum);
  }
  std::string page = kDecodingPage;
  page.replace(page.find('@'), 1, base64(*apng_bytes(walking())));
  const PictureFolder folder;
  write(folder / "page.html", page);
  const std::string shown = output_of(
      "chromium --headless --no-sandbox --disable-gpu --disable-quic --no-first-run "
      "--disable-background-networking --disable-component-update --disable-sync "
      "--user-data-dir='" +
      (folder / "profile").string() + "' --virtual-time-budget=20000 --dump-dom 'file://" +
      (folder / "page.html").string() + "' 2>/dev/null");
  EXPECT_NE(shown.find(expected), std::string::npos) << expected << "\n" << shown.substr(0, 400);
}

TEST(ColorTable, KeepsFewColorsAsTheyAre) {
  ColorCount count;
  const Image picture = *walking_square(2);
  count.add(picture);
  ColorTable table = count.table(255);
  ASSERT_EQ(table.colors().size(), 3U);
  const auto numbers = table.numbers(picture);
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      ASSERT_EQ(table.colors()[numbers[i]][c], picture.rgb[3 * i + c]);
    }
  }
}

TEST(ColorTable, StaysNearWhenThereAreTooMany) {
  Image picture(256, 64);
  for (int row = 0; row < 64; ++row) {
    for (int column = 0; column < 256; ++column) {
      picture.set(column, row,
                  {static_cast<std::uint8_t>(column), static_cast<std::uint8_t>(4 * row),
                   static_cast<std::uint8_t>(255 - column)});
    }
  }
  ColorCount count;
  count.add(picture);
  ColorTable table = count.table(64);
  EXPECT_EQ(table.colors().size(), 64U);
  const auto numbers = table.numbers(picture);
  double sum = 0.0;
  for (std::size_t i = 0; i < numbers.size(); ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      sum += std::abs(table.colors()[numbers[i]][c] - picture.rgb[3 * i + c]);
    }
  }
  // 64 cells over the 256 x 256 colours of a plane: 32 wide, on average 8 off at best.
  EXPECT_LT(sum / static_cast<double>(3 * numbers.size()), 14.0);
}

}  // namespace
}  // namespace aims
