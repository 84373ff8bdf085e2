// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/series.hpp"

#include <fmt/format.h>
#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "bench/scoring/json_text.hpp"
#include "bench/scoring/score_list.hpp"
#include "bench/studies/consistency_study.hpp"
#include "core/series_style.hpp"

namespace aims {

namespace {

bool has_number(const Numbers& values) {
  return std::any_of(values.begin(), values.end(), [](double v) { return !std::isnan(v); });
}

}  // namespace

std::vector<std::size_t> shown(std::size_t count) {
  const std::size_t stride = (count + kLongestSeries - 1) / kLongestSeries;
  std::vector<std::size_t> indices;
  for (std::size_t i = 0; i < count; i += stride) indices.push_back(i);
  if (count > 0) indices.back() = count - 1;
  return indices;
}

Json column(const Numbers& values, PageData& page, std::size_t components) {
  return has_number(values) ? page.q16(values, components) : Json();
}

Json stamp_column(const Numbers& values, PageData& page) {
  return has_number(values) ? page.f32(values) : Json();
}

Result<Numbers> numbers_at(const CsvColumns& table, const std::string& name,
                           const std::vector<std::ptrdiff_t>& rows) {
  const auto numbers = table.numbers(name);
  if (!numbers) return tl::unexpected(numbers.error());
  Numbers values(rows.size(), std::numeric_limits<double>::quiet_NaN());
  if (numbers->empty()) return values;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (rows[i] >= 0) values[i] = (*numbers)[static_cast<std::size_t>(rows[i])];
  }
  return values;
}

Result<void> add_columns(const CsvColumns& table, const ColumnNames& names,
                         const std::vector<std::ptrdiff_t>& rows, PageData& page, Json& json) {
  for (const auto& [key, name] : names) {
    const auto values = numbers_at(table, name, rows);
    if (!values) return tl::unexpected(values.error());
    json[key] = column(*values, page);
  }
  return {};
}

void append(const Eigen::Vector3d& v, Numbers& values) {
  values.insert(values.end(), {v.x(), v.y(), v.z()});
}

Json poses_json(const Trajectory& poses, double start, PageData& page) {
  Numbers t;
  Numbers p;
  Numbers q;
  for (const StampedPose& each : poses) {
    t.push_back(to_seconds(each.stamp) - start);
    append(each.pose.translation, p);
    const Eigen::Quaterniond& rotation = each.pose.rotation;
    q.insert(q.end(), {rotation.x(), rotation.y(), rotation.z(), rotation.w()});
  }
  return {{"t", stamp_column(t, page)}, {"p", column(p, page, 3)}, {"q", column(q, page, 4)}};
}

Json palette_json() {
  Json palette = Json::array();
  for (std::size_t i = 0; i < kSeriesStyles; ++i) {
    const SeriesStyle style = series_style(i);
    const auto dashes = dash_lengths(style.pattern);
    palette.push_back({{"light", fmt::format("#{:06x}", style.light)},
                       {"dark", fmt::format("#{:06x}", style.dark)},
                       {"dash", std::vector<double>(dashes.begin(), dashes.end())}});
  }
  return palette;
}

Json score_list_json(const std::string& lead, const std::string& lead_unit) {
  Json list = Json::array();
  const auto add = [&list](const std::string& key, std::string_view title, std::string_view unit) {
    list.push_back(
        {{"key", key}, {"title", title}, {"unit", unit}, {"better", name_of(better_of(key))}});
  };
  const auto scores = score_list();
  if (!lead.empty()) {
    const auto listed = std::ranges::find(scores, lead, &Score::key);
    const bool titled = listed != scores.end() && !listed->title.empty();
    add(lead, titled ? listed->title : lead, lead_unit);
  }
  for (const Score& each : scores) add(each.key, each.title, unit_of(each.key));
  return list;
}

Json styles_json(const std::vector<std::string>& labels) {
  Json styles = Json::object();
  const std::vector<std::size_t> indices = series_styles(labels);
  for (std::size_t i = 0; i < labels.size(); ++i) styles[labels[i]] = indices[i];
  return styles;
}

namespace {

constexpr std::string_view kDetectorsSchema = "aims.detectors/2";
constexpr std::size_t kMostPooled = 400;
constexpr std::size_t kMostOfScenario = 60;

float rate_of(const Json& point, std::size_t i) {
  const bool is_rate = point.is_array() && point.size() == 2 && point[i].is_number();
  return is_rate ? point[i].get<float>() : std::numeric_limits<float>::quiet_NaN();
}

/// Both rates of at most `most` points, alternating.
std::vector<float> thinned(const Json& curve, std::size_t most) {
  std::vector<float> rates;
  if (!curve.is_array() || curve.empty()) return rates;
  const std::size_t count = std::min(most, curve.size());
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t at = count == 1 ? 0 : i * (curve.size() - 1) / (count - 1);
    rates.push_back(rate_of(curve[at], 0));
    rates.push_back(rate_of(curve[at], 1));
  }
  return rates;
}

}  // namespace

Result<Json> detector_curves(const std::filesystem::path& file, PageData& page) {
  auto json = read_json_of(file, kDetectorsSchema);
  if (!json) return json;
  if (!member(*json, "scores").is_array()) {
    return failure(file.string() + ": scores: expected a list");
  }
  for (Json& score : (*json)["scores"]) {
    if (!score.is_object()) return failure(file.string() + ": scores: expected objects");
    const bool pooled = !member(score, "scenario").is_string();
    score["curve"] =
        page.f32(thinned(member(score, "curve"), pooled ? kMostPooled : kMostOfScenario));
  }
  return json;
}

namespace {

/// Lists of numbers as arrays of the page; what is no number is NaN there.
void make_arrays(Json& series, PageData& page) {
  if (!series.is_object()) return;
  for (const auto& [name, values] : series.items()) {
    std::vector<float> numbers;
    for (const Json& value : values) {
      numbers.push_back(value.is_number() ? value.get<float>()
                                          : std::numeric_limits<float>::quiet_NaN());
    }
    series[name] = page.f32(numbers);
  }
}

}  // namespace

Result<Json> consistency_series(const std::filesystem::path& file, PageData& page) {
  auto json = read_json_of(file, kConsistencySchema);
  if (!json) return json;
  if (!member(*json, "cases").is_array()) {
    return failure(file.string() + ": cases: expected a list");
  }
  for (Json& each : (*json)["cases"]) {
    if (!each.is_object()) return failure(file.string() + ": cases: expected objects");
    make_arrays(each["series"], page);
    if (member(each, "example").is_object()) make_arrays(each["example"]["series"], page);
  }
  return json;
}

}  // namespace aims
