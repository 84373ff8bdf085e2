// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "bench/run/score_record.hpp"
#include "core/error.hpp"

namespace aims {

/// A picture that a page shows: its file without ".png", and what it is.
struct PagePicture {
  std::string name;
  std::string title;
};

/// Those of the pictures that `folder` holds, for a page. One beyond `largest` [bytes] is left out;
/// so is one that is no PNG, which becomes a note.
Result<Json> pictures_json(const std::filesystem::path& folder,
                           const std::vector<PagePicture>& pictures, std::uintmax_t largest,
                           Json& notes);

}  // namespace aims
