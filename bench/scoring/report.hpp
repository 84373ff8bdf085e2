// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "bench/scoring/json_text.hpp"
#include "core/error.hpp"
#include "core/files/csv.hpp"

namespace aims {

/// What a study, a suite or a scoring came to, in the forms in which results are read; an absent
/// one is not written.
struct Report {
  std::string name;  ///< of the files, without ending
  std::optional<std::string> markdown = {};
  std::optional<CsvTable> csv = {};
  std::optional<Json> json = {};
  std::optional<std::string> latex = {};
};

/// Writes NAME.md, NAME.csv, NAME.json and NAME.tex into `folder`, which is made when it is
/// missing.
Result<void> write_report(const Report& report, const std::filesystem::path& folder);

}  // namespace aims
