// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <string_view>

#include "core/error.hpp"
#include "render/page/page_data.hpp"

namespace aims {

/// What a page shows: a run, or a suite, sweep or tuning. Each has the libraries that it draws
/// with.
enum class PageKind { kRun, kStudy };

/// The page that render/page/web is built into, with the marks `__AIMS_TITLE__` and `__AIMS_DATA__`
/// once each; empty when this program was built without it (CMake option AIMS_PAGE).
std::string_view page_template(PageKind kind);

/// Text that is safe inside an HTML element; bytes that are not UTF-8 become \xNN.
std::string html_escaped(std::string_view text);

/// `html`, a page's template, with title and data in place of its marks. Error when the template is
/// empty or lacks a mark.
Result<std::string> filled_template(std::string_view html, const PageData& page);

/// The whole page, one HTML file. Error when this program was built without the page.
Result<std::string> page_html(const PageData& page);

}  // namespace aims
