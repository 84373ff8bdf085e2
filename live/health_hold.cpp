// SPDX-License-Identifier: BSD-3-Clause
#include "live/health_hold.hpp"

#include <algorithm>
#include <cctype>
#include <ranges>
#include <set>
#include <string>

namespace aims {
namespace {

std::string without_figures(std::string reason) {
  std::erase_if(reason, [](unsigned char each) { return std::isdigit(each) != 0; });
  return reason;
}

std::set<std::string> words_of(const HealthRow& row) {
  std::set<std::string> words;
  for (const std::string& each : row.reasons) words.insert(without_figures(each));
  return words;
}

}  // namespace

bool alike(const HealthRow& a, const HealthRow& b) {
  return a.state == b.state && words_of(a) == words_of(b);
}

HealthRow HealthHold::held(const HealthRow& row) {
  if (row.state == HealthState::kStarting) return row;
  std::erase_if(recent_, [&](const HealthRow& each) { return row.stamp - each.stamp > kHold; });
  HealthRow held = row;
  std::set<std::string> words = words_of(row);
  for (const HealthRow& each : recent_ | std::views::reverse) {
    held.state = std::max(held.state, each.state);
    for (const std::string& reason : each.reasons) {
      if (words.insert(without_figures(reason)).second) held.reasons.push_back(reason);
    }
  }
  recent_.push_back(row);
  return held;
}

}  // namespace aims
