// SPDX-License-Identifier: BSD-3-Clause
#include "render/plots/canvas.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <fstream>
#include <string>
#include <utility>

#include "tests/render/plots/picture_file.hpp"

namespace aims {
namespace {

using test::count_pixels;
using test::PictureFolder;
using test::read_png;

TEST(Canvas, FillsTheAreaWithTheColour) {
  const PictureFolder folder;
  auto canvas = Canvas::create(folder / "a.png", 60, 40);
  ASSERT_TRUE(canvas);
  canvas->fill(Rect{10.0, 5.0, 20.0, 30.0}, {1.0, 0.0, 0.0});
  ASSERT_TRUE(canvas->finish());
  const Image image = read_png(folder / "a.png");
  EXPECT_EQ(image.width, 60);
  EXPECT_EQ(image.height, 40);
  EXPECT_EQ(count_pixels(image, {255, 0, 0}, 0), 20 * 30);
  EXPECT_EQ(count_pixels(image, {255, 255, 255}, 0), 60 * 40 - 20 * 30);
}

TEST(Canvas, DrawsNothingOutsideItsClip) {
  const PictureFolder folder;
  auto canvas = Canvas::create(folder / "a.png", 60, 40);
  ASSERT_TRUE(canvas);
  canvas->clip({10.0, 10.0, 10.0, 10.0});
  canvas->fill(Rect{0.0, 0.0, 60.0, 40.0}, {0.0, 0.0, 1.0});
  canvas->unclip();
  ASSERT_TRUE(canvas->finish());
  EXPECT_EQ(count_pixels(read_png(folder / "a.png"), {0, 0, 255}, 0), 100);
}

TEST(Canvas, KeepsThePixelsOfAnImage) {
  const PictureFolder folder;
  Image image(2, 1);
  image.set(0, 0, {10, 20, 30});
  image.set(1, 0, {200, 100, 50});
  auto canvas = Canvas::create(folder / "a.png", 20, 10);
  ASSERT_TRUE(canvas);
  canvas->image(image, {0.0, 0.0, 20.0, 10.0});
  ASSERT_TRUE(canvas->finish());
  const Image read = read_png(folder / "a.png");
  EXPECT_EQ(count_pixels(read, {10, 20, 30}, 0), 100);
  EXPECT_EQ(count_pixels(read, {200, 100, 50}, 0), 100);
}

TEST(Canvas, InterruptsALineAtAPointThatIsNotFinite) {
  const PictureFolder folder;
  auto canvas = Canvas::create(folder / "a.png", 100, 20);
  ASSERT_TRUE(canvas);
  const double nan = std::nan("");
  canvas->line({{0.0, 10.0}, {30.0, 10.0}, {nan, 10.0}, {70.0, 10.0}, {100.0, 10.0}},
               {{0.0, 0.0, 0.0}, 4.0});
  ASSERT_TRUE(canvas->finish());
  const Image image = read_png(folder / "a.png");
  EXPECT_EQ(image.pixel(20, 10)[0], 0);
  EXPECT_EQ(image.pixel(50, 10)[0], 255);
  EXPECT_EQ(image.pixel(80, 10)[0], 0);
}

TEST(Canvas, ChoosesTheFormatByTheEndingOfTheName) {
  const PictureFolder folder;
  const std::array<std::pair<std::string, std::string>, 3> starts = {
      {{"a.png", "\x89PNG"}, {"a.svg", "<?xml"}, {"a.pdf", "%PDF"}}};
  for (const auto& [name, start] : starts) {
    auto canvas = Canvas::create(folder / name, 50, 50);
    ASSERT_TRUE(canvas);
    canvas->text({5.0, 25.0}, "text", {});
    ASSERT_TRUE(canvas->finish());
    std::ifstream file(folder / name, std::ios::binary);
    std::string head(start.size(), ' ');
    file.read(head.data(), static_cast<std::streamsize>(head.size()));
    EXPECT_EQ(head, start);
  }
}

TEST(Canvas, RefusesAnUnknownEnding) {
  const PictureFolder folder;
  const auto canvas = Canvas::create(folder / "a.bmp", 50, 50);
  ASSERT_FALSE(canvas);
  EXPECT_NE(canvas.error().message.find(".png, .svg or .pdf"), std::string::npos);
}

TEST(Canvas, NamesThePathThatCannotBeWritten) {
  const PictureFolder folder;
  for (const char* name : {"missing/a.png", "missing/a.svg", "missing/a.pdf"}) {
    auto canvas = Canvas::create(folder / name, 50, 50);
    const auto written = canvas ? canvas->finish() : Result<void>(failure(canvas.error().message));
    ASSERT_FALSE(written) << name;
    EXPECT_NE(written.error().message.find((folder / name).string()), std::string::npos);
  }
}

TEST(Canvas, LeavesNothingBehindWithoutFinish) {
  const PictureFolder folder;
  for (const char* name : {"a.png", "a.svg", "a.pdf"}) {
    ASSERT_TRUE(Canvas::create(folder / name, 50, 50));
  }
  EXPECT_EQ(folder.files(), 0U);
}

TEST(Canvas, OverAPictureKeepsItAndDrawsOnIt) {
  Image picture(8, 6);
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 8; ++column) {
      picture.set(column, row,
                  {static_cast<std::uint8_t>(30 * column), 7, static_cast<std::uint8_t>(40 * row)});
    }
  }
  Canvas canvas = Canvas::over(picture);
  EXPECT_EQ(canvas.pixels().rgb, picture.rgb);
  canvas.squares({{2.0, 2.0}, {6.0, 4.0}}, 2.0, {1.0, 1.0, 1.0});
  const Image drawn = canvas.pixels();
  EXPECT_EQ(drawn.pixel(1, 1)[1], 255);
  EXPECT_EQ(drawn.pixel(6, 4)[1], 255);
  EXPECT_EQ(drawn.pixel(4, 2), picture.pixel(4, 2));
}

TEST(Canvas, PdfHoldsNoTimeOfDay) {
  const PictureFolder folder;
  auto canvas = Canvas::create(folder / "a.pdf", 50, 50);
  ASSERT_TRUE(canvas && canvas->finish());
  std::ifstream file(folder / "a.pdf", std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  EXPECT_EQ(text.rfind("%PDF-", 0), 0U);
  EXPECT_EQ(text.find("(D:20"), std::string::npos) << "an identical picture would differ";
}

TEST(Canvas, HasNoPixelsOfAVectorPicture) {
  const PictureFolder folder;
  const auto canvas = Canvas::create(folder / "a.svg", 50, 50);
  ASSERT_TRUE(canvas);
  EXPECT_EQ(canvas->pixels().width, 0);
}

}  // namespace
}  // namespace aims
