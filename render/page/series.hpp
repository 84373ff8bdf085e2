// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "bench/scoring/score_record.hpp"
#include "core/error.hpp"
#include "core/files/csv_columns.hpp"
#include "core/trajectory.hpp"
#include "render/page/page_data.hpp"

namespace aims {

/// A series of more samples is thinned evenly to no more than this, its last sample kept.
inline constexpr std::size_t kLongestSeries = 6000;

/// Samples of a series; NaN for none.
using Numbers = std::vector<double>;

/// Indices of the samples that are shown of `count`: evenly spaced, with the last one.
std::vector<std::size_t> shown(std::size_t count);

/// Reference to the values of `components` quantized columns, a row after the other; null when none
/// of them is a number.
Json column(const Numbers& values, PageData& page, std::size_t components = 1);

/// Reference to stamps, which are not quantized; null when none of them is a number.
Json stamp_column(const Numbers& values, PageData& page);

/// The numbers of a table's column at those rows: NaN at row -1, and everywhere when the table has
/// no such column.
Result<Numbers> numbers_at(const CsvColumns& table, const std::string& name,
                           const std::vector<std::ptrdiff_t>& rows);

/// Keys in JSON and the columns of a table that they show.
using ColumnNames = std::vector<std::pair<std::string, std::string>>;

/// Adds those columns at those rows to `json`.
Result<void> add_columns(const CsvColumns& table, const ColumnNames& names,
                         const std::vector<std::ptrdiff_t>& rows, PageData& page, Json& json);

void append(const Eigen::Vector3d& v, Numbers& values);

/// "t" [s] after `start`, "p" and "q" (x y z w) of the poses.
Json poses_json(const Trajectory& poses, double start, PageData& page);

/// The styles of core/series_style.hpp: a list of {"light", "dark", "dash"}, colours as "#rrggbb",
/// dashes as lengths of line and gap in turn [px].
Json palette_json();

/// The list of scores: key, title, unit, which is "better" (smaller, larger or neither); before it
/// `lead`, the score of a data set, if there is one, in the unit of its authors.
Json score_list_json(const std::string& lead = "", const std::string& lead_unit = "");

/// Index of the style of each label.
Json styles_json(const std::vector<std::string>& labels);

/// Results of a detector study for a page: detectors.json with each score's curve
/// as an array of the page (false-alarm rate and detection rate, alternating). Pooled curves
/// keep at most 400 points, those of one scenario 60, evenly chosen with both ends. Error when the
/// file is no detectors.json.
Result<Json> detector_curves(const std::filesystem::path& file, PageData& page);

/// Results of a consistency study for a page: consistency.json with each case's series, and those
/// of its example, as arrays of the page. Error when the file is no consistency.json.
Result<Json> consistency_series(const std::filesystem::path& file, PageData& page);

}  // namespace aims
