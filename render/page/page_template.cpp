// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/page_template.hpp"

#include <fmt/format.h>

#include "core/text.hpp"

namespace aims {
namespace {

constexpr std::string_view kTitleMark = "__AIMS_TITLE__";
constexpr std::string_view kDataMark = "__AIMS_DATA__";

}  // namespace

std::string html_escaped(std::string_view text) {
  std::string escaped;
  for (const char c : utf8_text(text)) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

Result<std::string> filled_template(std::string_view html, const PageData& page) {
  if (html.empty()) {
    return failure(
        "this program was built without the page: build it again where npm is found and "
        "reaches its registry (CMake option AIMS_PAGE)");
  }
  const std::size_t title = html.find(kTitleMark);
  const std::size_t data = html.find(kDataMark);
  if (title == std::string_view::npos || data == std::string_view::npos || data < title) {
    return failure(fmt::format("page template: expected the marks {} and, after it, {}", kTitleMark,
                               kDataMark));
  }
  std::string text(html.substr(0, title));
  text += html_escaped(page.title);
  text += html.substr(title + kTitleMark.size(), data - title - kTitleMark.size());
  text += payload_text(page);
  text += html.substr(data + kDataMark.size());
  return text;
}

Result<std::string> page_html(const PageData& page) {
  const bool run = page.json.value("kind", "") == "run";
  return filled_template(page_template(run ? PageKind::kRun : PageKind::kStudy), page);
}

}  // namespace aims
