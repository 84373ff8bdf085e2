// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/page_data.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "render/page/page_template.hpp"
#include "tests/render/page/decoded_page.hpp"

namespace aims {
namespace {

using testing::base64_decoded;
using testing::decoded;

constexpr std::string_view kTemplate =
    "<html><title>__AIMS_TITLE__</title><script id=\"aims-data\" type=\"text/plain\">"
    "__AIMS_DATA__</script></html>";

TEST(Base64, IsThatOfTheStandard) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foo"), "Zm9v");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("fooba"), "Zm9vYmE=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  std::string bytes;
  for (int i = 0; i < 256; ++i) bytes += static_cast<char>(i);
  EXPECT_EQ(base64_decoded(base64(bytes)), bytes);
}

TEST(Payload, GivesBackEveryArrayAndTheDocument) {
  PageData page;
  const std::vector<float> singles = {1.5F, -2.25F, std::numeric_limits<float>::quiet_NaN()};
  const std::vector<double> doubles = {0.1, 1e30, -7.0, 3.0, 4.0};
  const std::vector<std::uint8_t> bytes = {0, 1, 255};
  page.json["bytes"] = page.u8(bytes);
  page.json["singles"] = page.f32(singles);
  page.json["doubles"] = page.f32(doubles);
  page.json["none"] = page.f32(std::vector<float>());
  page.json["name"] = "K\u00f6rper </script> \"quoted\"";
  page.json["nan"] = std::nan("");
  const auto back = decoded(payload_text(page));
  EXPECT_EQ(back.array<std::uint8_t>(back.json["bytes"]), bytes);
  const auto floats = back.f32(back.json["singles"]);
  EXPECT_EQ(floats[0], 1.5F);
  EXPECT_EQ(floats[1], -2.25F);
  EXPECT_TRUE(std::isnan(floats[2]));
  EXPECT_EQ(back.f32(back.json["doubles"]), (std::vector<float>{0.1F, 1e30F, -7.0F, 3.0F, 4.0F}));
  EXPECT_EQ(back.json["none"]["n"], 0);
  EXPECT_EQ(back.json["name"], "K\u00f6rper </script> \"quoted\"");
  EXPECT_TRUE(back.json["nan"].is_null());
  for (const char* key : {"bytes", "singles", "doubles"}) {
    EXPECT_EQ(back.json[key]["at"].get<int>() % 4, 0) << key;
  }
}

TEST(Payload, BlockBeginsAtAMultipleOfEightWhateverTheDocumentsLength) {
  for (int length = 0; length < 9; ++length) {
    PageData page;
    page.json["text"] = std::string(static_cast<std::size_t>(length), 'x');
    page.json["one"] = page.f32(std::vector<float>{42.0F});
    const auto back = decoded(payload_text(page));
    ASSERT_EQ(back.block.size(), 4U) << length;
    EXPECT_EQ(back.f32(back.json["one"]), std::vector<float>{42.0F}) << length;
  }
}

TEST(Payload, TakesTextThatIsNotUtf8) {
  PageData page;
  page.json["name"] = "a\xff\xfe";
  EXPECT_EQ(decoded(payload_text(page)).json["name"], "a\\xff\\xfe");
}

TEST(PageTemplate, TitleCannotLeaveItsElementNorPassForTheData) {
  PageData page;
  page.title = "</title><script>alert(1)</script> & \"__AIMS_DATA__\" '";
  const auto html = filled_template(kTemplate, page);
  ASSERT_TRUE(html) << html.error().message;
  EXPECT_NE(html->find("<title>&lt;/title&gt;&lt;script&gt;alert(1)&lt;/script&gt; &amp; "
                       "&quot;__AIMS_DATA__&quot; &#39;</title>"),
            std::string::npos);
  EXPECT_TRUE(testing::decoded_html(*html).json.is_object());
}

TEST(PageTemplate, RefusesOneThatLacksAMarkAndSaysWhenThereIsNone) {
  const auto lacking = filled_template("<html>__AIMS_TITLE__</html>", {});
  ASSERT_FALSE(lacking);
  EXPECT_NE(lacking.error().message.find("__AIMS_DATA__"), std::string::npos);
  const auto none = filled_template("", {});
  ASSERT_FALSE(none);
  EXPECT_NE(none.error().message.find("AIMS_PAGE"), std::string::npos);
}

TEST(PageTemplate, ThatIsEmbeddedHasEachMarkOnceAndLoadsNothing) {
  for (const PageKind kind : {PageKind::kRun, PageKind::kStudy}) {
    const std::string_view html = page_template(kind);
    if (html.empty()) GTEST_SKIP() << "built without the page: npm was not found or not reachable";
    for (const std::string_view mark : {"__AIMS_TITLE__", "__AIMS_DATA__"}) {
      const std::size_t first = html.find(mark);
      ASSERT_NE(first, std::string_view::npos) << mark;
      EXPECT_EQ(html.find(mark, first + 1), std::string_view::npos) << mark;
    }
    for (const std::string_view link :
         {"rel=\"stylesheet\"", "src=\"http", "href=\"http", "@import"}) {
      EXPECT_EQ(html.find(link), std::string_view::npos) << link;
    }
  }
}

TEST(PageTemplate, OfEachKindHasTheLibrariesThatItDrawsWith) {
  const std::string_view run = page_template(PageKind::kRun);
  const std::string_view study = page_template(PageKind::kStudy);
  if (run.empty()) GTEST_SKIP() << "built without the page: npm was not found or not reachable";
  EXPECT_NE(run.find("/* aims page; three.js"), std::string_view::npos);
  EXPECT_NE(study.find("/* aims page; Observable Plot"), std::string_view::npos);
  EXPECT_LT(study.size(), 450U * 1024U) << "no three.js";
  EXPECT_LT(run.size(), 800U * 1024U) << "no Observable Plot";
}

}  // namespace
}  // namespace aims
