// SPDX-License-Identifier: BSD-3-Clause
#include "render/page/detector_curves.hpp"

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "render/page/json_access.hpp"

namespace aims {
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

}  // namespace aims
