// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/clouds/scan_period.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include "core/median.hpp"

namespace aims {
namespace {

/// The period of the nearest integer rate [Hz], if within 3 % of `period`.
Duration integer_rate(Duration period) {
  const double rate = std::max(1.0, std::round(1.0 / to_seconds(period)));
  const Duration rounded = from_seconds(1.0 / rate);
  return std::abs(rounded - period) <= period * 3 / 100 ? rounded : period;
}

/// How many scans of that period are as long as `spacing`.
Duration scans_in(Duration spacing, Duration period) {
  return std::max<Duration>(1, (spacing + period / 2) / period);
}

/// The time of a turn of which the part `seen` takes `span`.
Duration whole_turn(Duration span, double seen) {
  return seen > 0.0 ? std::llround(static_cast<double>(span) / seen) : kLongestScan;
}

}  // namespace

std::vector<Duration> spacings(std::vector<Time> stamps) {
  std::sort(stamps.begin(), stamps.end());
  std::vector<Duration> between;
  for (std::size_t i = 1; i < stamps.size(); ++i) {
    if (stamps[i] > stamps[i - 1]) between.push_back(stamps[i] - stamps[i - 1]);
  }
  return between;
}

std::optional<Duration> scan_period(std::vector<Time> stamps, std::optional<Duration> span,
                                    double seen) {
  std::vector<Duration> between = spacings(std::move(stamps));
  std::erase_if(between, [&](Duration each) { return span && each < *span - *span / 10; });
  if (between.empty()) {
    if (!span || *span <= 0) return std::nullopt;
    // The last firing is slightly before the end of the scan.
    return integer_rate(*span);
  }
  const Duration shortest = *std::min_element(between.begin(), between.end());
  const Duration whole = whole_turn(span.value_or(shortest), seen);
  // A turn is no longer than what is between clouds: else nothing turns, as in a Livox.
  const Duration usual = *upper_median(between);
  const Duration turn = whole <= usual + usual / 10 ? whole : span.value_or(shortest);
  const Duration base = shortest > turn + turn / 2 ? turn : shortest;
  std::map<Duration, std::size_t> periods;
  for (const Duration each : between) {
    const Duration scans = scans_in(each, base);
    ++periods[(each + scans / 2) / scans];
  }
  const auto mode = std::max_element(periods.begin(), periods.end(),
                                     [](auto& a, auto& b) { return a.second < b.second; });
  if (2 * mode->second >= between.size()) return mode->first;
  std::vector<Duration> each;
  for (const auto& [period, times] : periods) each.insert(each.end(), times, period);
  // Jittering stamps: the firing span measures the period better, if it is close.
  const Duration typical = *upper_median(each);
  const auto off = [typical](Duration period) { return std::abs(period - typical); };
  const Duration turned = integer_rate(span ? turn : typical);
  const Duration seen_only = integer_rate(span.value_or(typical));
  const Duration fired = off(turned) < off(seen_only) ? turned : seen_only;
  return off(fired) <= typical / 4 ? fired : integer_rate(typical);
}

Duration usual_spacing(std::vector<Time> stamps, Duration period) {
  std::map<Duration, std::size_t> times;
  for (const Duration each : spacings(std::move(stamps))) ++times[scans_in(each, period)];
  const auto mode = std::max_element(times.begin(), times.end(),
                                     [](auto& a, auto& b) { return a.second < b.second; });
  return mode == times.end() ? period : mode->first * period;
}

std::optional<double> time_unit(double span, Duration about) {
  std::optional<double> best;
  double best_ratio = 20.0;
  for (const double ns : {1e9, 1e6, 1e3, 1.0}) {
    const double length = span * ns / static_cast<double>(about);
    if (!(length > 0.0)) continue;
    const double ratio = std::max(length, 1.0 / length);
    if (ratio >= best_ratio) continue;
    best_ratio = ratio;
    best = ns;
  }
  return best;
}

std::optional<double> batched_rate(std::vector<Time> times) {
  constexpr Duration kPause = 5;       // times the usual spacing
  constexpr std::size_t kFewest = 5;   // pauses
  constexpr double kMostOfTime = 0.6;  // that the pauses take
  if (times.size() < 2) return std::nullopt;
  std::sort(times.begin(), times.end());
  std::vector<Duration> between;
  for (std::size_t i = 1; i < times.size(); ++i) between.push_back(times[i] - times[i - 1]);
  const Duration usual = *upper_median(between);
  std::size_t pauses = 0;
  Duration paused = 0;
  for (const Duration each : between) {
    if (each <= kPause * usual) continue;
    ++pauses;
    paused += each;
  }
  const Duration whole = times.back() - times.front();
  const bool batched = pauses >= kFewest && 2 * pauses < between.size() &&
                       static_cast<double>(paused) > kMostOfTime * static_cast<double>(whole);
  if (!batched) return std::nullopt;
  return static_cast<double>(times.size() - 1) / to_seconds(whole);
}

std::optional<double> sample_rate(std::vector<Time> stamps) {
  std::sort(stamps.begin(), stamps.end());
  const std::vector<Duration> between = spacings(stamps);
  if (between.empty()) return std::nullopt;
  std::map<Duration, std::size_t> times;
  for (const Duration each : between) ++times[each];
  const auto mode = std::max_element(times.begin(), times.end(),
                                     [](auto& a, auto& b) { return a.second < b.second; });
  if (3 * mode->second >= between.size()) return 1.0 / to_seconds(mode->first);
  const Duration typical = *upper_median(between);
  const auto near = std::count_if(between.begin(), between.end(), [&](Duration each) {
    return std::abs(each - typical) < typical / 10;
  });
  if (2 * static_cast<std::size_t>(near) >= between.size()) return 1.0 / to_seconds(typical);
  return static_cast<double>(between.size()) / to_seconds(stamps.back() - stamps.front());
}

}  // namespace aims
