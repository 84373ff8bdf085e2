// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

#include "render/page/page_data.hpp"

namespace aims {

/// The styles of core/series_style.hpp: a list of {"light", "dark", "dash"}, colours as "#rrggbb",
/// dashes as lengths of line and gap in turn [px].
PageData::Json palette_json();

/// Index of the style of each label.
PageData::Json styles_json(const std::vector<std::string>& labels);

}  // namespace aims
