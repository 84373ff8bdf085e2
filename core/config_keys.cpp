// SPDX-License-Identifier: BSD-3-Clause
// Keys of a field list: finding, assigning, proposing, and whether they have an effect.
#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

#include "core/config.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

constexpr std::size_t kMostProposals = 3;  ///< for an unknown key

std::size_t edit_distance(std::string_view a, std::string_view b) {
  std::vector<std::size_t> row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    std::size_t diagonal = std::exchange(row[0], i);
    for (std::size_t j = 1; j <= b.size(); ++j) {
      const std::size_t replaced = diagonal + (a[i - 1] == b[j - 1] ? 0 : 1);
      diagonal = std::exchange(row[j], std::min({row[j] + 1, row[j - 1] + 1, replaced}));
    }
  }
  return row.back();
}

/// The reasons why parameters are idle, each once.
std::string reasons_of(const std::vector<const Parameter*>& parameters) {
  std::vector<std::string> reasons;
  for (const Parameter* parameter : parameters) {
    if (std::find(reasons.begin(), reasons.end(), parameter->idle) == reasons.end()) {
      reasons.push_back(parameter->idle);
    }
  }
  return fmt::format("{}", fmt::join(reasons, "; "));
}

/// The key with the first group that its first segment `*` can stand for, or the key itself, and
/// where that segment begins.
std::pair<std::string, std::size_t> without_star(const Fields& fields, std::string_view key) {
  const std::size_t star = key.starts_with("*.") ? 0 : key.find(".*.") + 1;
  if (star == 0 && !key.starts_with("*.")) return {std::string(key), std::string::npos};
  const std::string_view before = key.substr(0, star);
  for (const Parameter& parameter : fields.parameters()) {
    if (!parameter.key.starts_with(before)) continue;
    const std::string_view rest = std::string_view(parameter.key).substr(star);
    return {fmt::format("{}{}{}", before, rest.substr(0, rest.find('.')), key.substr(star + 1)),
            star};
  }
  return {std::string(key), std::string::npos};
}

std::vector<std::string> keys_of(const Fields& fields) {
  std::vector<std::string> keys;
  for (const Parameter& parameter : fields.parameters()) keys.push_back(parameter.key);
  for (const ListField& list : fields.lists()) keys.push_back(list.key);
  return keys;
}

/// Names in the group `prefix` ("lidar."), each once, in the order of description.
std::vector<std::string> names_in(const std::vector<std::string>& keys, std::string_view prefix) {
  std::vector<std::string> names;
  for (const std::string& each : keys) {
    if (!each.starts_with(prefix)) continue;
    const std::string rest = each.substr(prefix.size());
    std::string name = rest.substr(0, rest.find('.'));
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      names.push_back(std::move(name));
    }
  }
  return names;
}

/// The known key most similar to the unknown `key`, with a similar name, or empty.
std::string proposal_for(const std::vector<std::string>& keys, std::string_view key,
                         std::size_t name_start) {
  const std::string prefix(key.substr(0, name_start));
  const std::string name(key.substr(name_start));
  const std::string sibling = near_match(name, names_in(keys, prefix));
  if (!sibling.empty()) return prefix + sibling;
  std::vector<std::string> same_name;
  for (const std::string& each : keys) {
    if (each == name || each.ends_with("." + name)) same_name.push_back(each);
  }
  std::vector<std::string> similar = same_name;
  for (const std::string& each : keys) {
    if (!same_name.empty()) break;
    const std::string last = each.substr(each.rfind('.') + 1);
    const bool exchanged = std::ranges::is_permutation(name, last);  // "eat" for "eta"
    if (exchanged || !near_match(name, {last}).empty()) similar.push_back(each);
  }
  const std::string nearest = near_match(key, similar);
  return nearest.empty() && !same_name.empty() ? same_name.front() : nearest;
}

/// What may be meant by the unknown `key`: keys of its group that begin with its name, then the
/// most similar key.
std::vector<std::string> proposals_for(const Fields& fields, std::string_view key) {
  const std::vector<std::string> keys = keys_of(fields);
  const std::size_t name_start = key.rfind('.') + 1;  // npos + 1 = 0
  const std::string_view prefix = key.substr(0, name_start);
  const std::string_view name = key.substr(name_start);
  const std::string nearest = proposal_for(keys, key, name_start);
  std::vector<std::string> proposals;
  for (const std::string& each : names_in(keys, prefix)) {
    if (name.size() < 2 || !each.starts_with(name)) continue;
    proposals.push_back(std::string(prefix) + each);
  }
  const bool known = std::find(proposals.begin(), proposals.end(), nearest) != proposals.end();
  if (!nearest.empty() && !known) {
    proposals.resize(std::min(proposals.size(), kMostProposals - 1));
    proposals.push_back(nearest);
  }
  proposals.resize(std::min(proposals.size(), kMostProposals));
  return proposals;
}

/// "'a'", "'a' or 'b'", "'a', 'b' or 'c'".
std::string alternatives(const std::vector<std::string>& keys) {
  std::string text;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (i > 0) text += i + 1 < keys.size() ? ", " : " or ";
    text += fmt::format("'{}'", keys[i]);
  }
  return text;
}

/// An entry that the list of `key` does not have, e.g. "route.points.7.x" of three points; empty
/// when the key names no entry of a list.
std::string missing_entry_message(const Fields& fields, std::string_view key) {
  for (const ListField& list : fields.lists()) {
    if (!key.starts_with(list.key + ".")) continue;
    const std::string_view rest = key.substr(list.key.size() + 1);
    const std::string_view index = rest.substr(0, rest.find('.'));
    if (index.empty() || index.find_first_not_of("0123456789") != std::string_view::npos) continue;
    const auto entry = number_from<std::size_t>(index);
    if (entry && *entry < list.size()) continue;
    return fmt::format("{}: no entry {}; {} has {}, counted from 0", key, index, list.key,
                       list.size());
  }
  return "";
}

}  // namespace

std::vector<const Parameter*> Fields::matching(std::string_view key) const {
  std::vector<const Parameter*> found;
  for (const Parameter& parameter : parameters_) {
    if (key_matches(key, parameter.key)) found.push_back(&parameter);
  }
  return found;
}

bool key_matches(std::string_view pattern, std::string_view key, bool prefix) {
  while (true) {
    const std::size_t end = std::min(pattern.find('.'), pattern.size());
    const std::size_t key_end = std::min(key.find('.'), key.size());
    const std::string_view name = pattern.substr(0, end);
    if (name != "*" && name != key.substr(0, key_end)) return false;
    if (end == pattern.size()) return (key_end < key.size()) == prefix;
    if (key_end == key.size()) return false;
    pattern.remove_prefix(end + 1);
    key.remove_prefix(key_end + 1);
  }
}

Result<void> assign(const Fields& fields, std::string_view key, std::string_view value) {
  const std::vector<const Parameter*> parameters = fields.matching(key);
  if (parameters.empty()) return failure(unknown_key_message(fields, key));
  for (const Parameter* parameter : parameters) {
    if (parameter->assign(value)) continue;
    return failure(fmt::format("{}: '{}' is not {}{}", key, value, parameter->expected,
                               option_proposal(*parameter, value)));
  }
  return {};
}

Result<void> check_effect(const Fields& fields, std::span<const AssignedKey> assigned) {
  for (const AssignedKey& each : assigned) {
    const std::vector<const Parameter*> parameters = fields.matching(each.key);
    const auto acts = [](const Parameter* parameter) { return parameter->idle.empty(); };
    if (parameters.empty() || std::any_of(parameters.begin(), parameters.end(), acts)) continue;
    const bool pattern = parameters.size() > 1 || parameters.front()->key != each.key;
    return failure(fmt::format("{}{}: has no effect: {}", each.place, each.key,
                               pattern ? reasons_of(parameters) : parameters.front()->idle));
  }
  return {};
}

std::string near_match(std::string_view word, const std::vector<std::string>& candidates) {
  const std::size_t tolerance = word.size() < 4 ? 1 : std::max<std::size_t>(2, word.size() / 3);
  std::string nearest;
  std::size_t nearest_distance = tolerance + 1;
  for (const std::string& candidate : candidates) {
    // No less than the difference in length, which is cheap to know of a long word.
    const auto [shorter, longer] = std::minmax({word.size(), candidate.size()});
    if (longer - shorter >= nearest_distance) continue;
    const std::size_t distance = edit_distance(word, candidate);
    if (distance < nearest_distance) {
      nearest_distance = distance;
      nearest = candidate;
    }
  }
  return nearest;
}

std::string unknown_key_message(const Fields& fields, std::string_view key) {
  if (std::string missing = missing_entry_message(fields, key); !missing.empty()) return missing;
  const auto [concrete, star] = without_star(fields, key);
  std::vector<std::string> near = proposals_for(fields, concrete);
  for (std::string& each : near) {
    if (star < each.size()) {
      each.replace(star, std::min(each.find('.', star), each.size()) - star, "*");
    }
  }
  if (std::find(near.begin(), near.end(), key) != near.end()) {
    return fmt::format("{}: a group of settings; expected one of its keys", key);
  }
  if (near.empty()) return fmt::format("unknown key '{}'", key);
  return fmt::format("unknown key '{}'; did you mean {}?", key, alternatives(near));
}

}  // namespace aims
