// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/series_styles.hpp"

#include <fmt/format.h>

#include "core/series_style.hpp"

namespace aims {

PageData::Json palette_json() {
  PageData::Json palette = PageData::Json::array();
  for (std::size_t i = 0; i < kSeriesStyles; ++i) {
    const SeriesStyle style = series_style(i);
    const auto dashes = dash_lengths(style.pattern);
    palette.push_back({{"light", fmt::format("#{:06x}", style.light)},
                       {"dark", fmt::format("#{:06x}", style.dark)},
                       {"dash", std::vector<double>(dashes.begin(), dashes.end())}});
  }
  return palette;
}

PageData::Json styles_json(const std::vector<std::string>& labels) {
  PageData::Json styles = PageData::Json::object();
  const std::vector<std::size_t> indices = series_styles(labels);
  for (std::size_t i = 0; i < labels.size(); ++i) styles[labels[i]] = indices[i];
  return styles;
}

}  // namespace aims
