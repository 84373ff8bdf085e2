// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/feet_messages.hpp"

#include <algorithm>
#include <array>
#include <map>
#include <string_view>

#include "recordings/legs/leg_names.hpp"
#include "recordings/messages/message_values.hpp"

namespace aims {
namespace {

constexpr std::size_t kFeet = kLegCount;

constexpr auto kFootArrays = std::to_array<std::string_view>(
    {"footposition", "footpositions", "feetposition", "feetpositions", "footpos", "feetpos",
     "footpositionbody", "footpositionsbody", "footpositionbase", "footposition2body"});
/// Where topic and type speak of feet.
constexpr auto kArraysOfFeet =
    std::to_array<std::string_view>({"position", "positions", "points", "poses", "states", "data"});
constexpr auto kFootLoadArrays = std::to_array<std::string_view>(
    {"contact", "contacts", "footcontact", "footcontacts", "contactstate", "contactstates",
     "footforce", "footforces", "incontact", "stance", "contactflags"});
/// Of a field beside the name of a leg.
constexpr auto kRestOfLoads = std::to_array<std::string_view>(
    {"", "/contact", "/in_contact", "/is_contact", "/contact_state", "/state", "/stance", "/force",
     "/load", "/foot", "/foot_contact", "/foot_force", "/contact_force"});
/// Of an entry of an array of messages.
constexpr auto kPlaceOfEntry =
    std::to_array<std::string_view>({"", "position", "point", "pose.position", "foot_position",
                                     "foot_position_body", "place", "position_body"});
constexpr auto kLoadOfEntry = std::to_array<std::string_view>(
    {"contact", "in_contact", "is_contact", "contact_state", "stance", "force", "load"});

/// Whether the field may hold the places of all feet.
bool may_be_places(const BagConnection& connection, const MessageField& field) {
  if (field.kind != FieldKind::kNumbers && field.kind != FieldKind::kMessages) return false;
  const std::string name = last_name(field.path);
  return is_one_of(name, kFootArrays) ||
         (is_of_feet(connection.topic, connection.type) && is_one_of(name, kArraysOfFeet));
}

/// The path of a field of each entry.
std::string of_entries(const std::string& array, std::string_view field) {
  return array + (field.empty() ? "[]" : "[].") + std::string(field);
}

/// The path of four places in the field; empty without.
std::string places_in(const MessageView& message, const MessageField& field) {
  const auto is_whole = [&message](const std::string& path) {
    const auto places = points_at(message, path);
    return places && places->size() == kFeet;
  };
  if (field.kind == FieldKind::kNumbers) return is_whole(field.path) ? field.path : "";
  for (const std::string_view each : kPlaceOfEntry) {
    if (is_whole(of_entries(field.path, each))) return of_entries(field.path, each);
  }
  return {};
}

/// The path of four loads, in the entries that hold the places or beside them; empty without.
std::string loads_beside(const MessageDecoder& decoder, const MessageView& message,
                         const MessageField& places) {
  const auto is_whole = [&message](const std::string& path) {
    const auto loads = numbers_at(message, path);
    return loads && loads->size() == kFeet;
  };
  for (const std::string_view each : kLoadOfEntry) {
    const bool entries = places.kind == FieldKind::kMessages;
    if (entries && is_whole(of_entries(places.path, each))) return of_entries(places.path, each);
  }
  for (const MessageField& field : decoder.fields()) {
    const bool named =
        field.kind == FieldKind::kNumbers && is_one_of(last_name(field.path), kFootLoadArrays);
    if (named && is_whole(field.path)) return field.path;
  }
  return {};
}

}  // namespace

bool may_hold_feet(const BagConnection& connection, const MessageDecoder& decoder) {
  return std::ranges::any_of(decoder.fields(), [&](const MessageField& field) {
    return may_be_places(connection, field);
  });
}

std::optional<FeetPaths> loads_by_name(const MessageDecoder& decoder) {
  std::map<std::string, std::array<std::string, kFeet>> found;  // by the name without the leg
  for (const MessageField& field : decoder.fields()) {
    const auto named = field.kind == FieldKind::kNumber ? named_leg(field.path) : std::nullopt;
    if (!named || !named->leg || !is_one_of(named->rest, kRestOfLoads)) continue;
    found[named->rest][static_cast<std::size_t>(*named->leg)] = field.path;
  }
  for (const auto& [rest, paths] : found) {
    if (std::ranges::any_of(paths, &std::string::empty)) continue;
    return FeetPaths{"", "", {paths.begin(), paths.end()}};
  }
  return std::nullopt;
}

std::optional<FeetPaths> feet_paths(const BagConnection& connection, const MessageDecoder& decoder,
                                    const MessageView& message) {
  for (const MessageField& field : decoder.fields()) {
    if (!may_be_places(connection, field)) continue;
    const std::string places = places_in(message, field);
    if (!places.empty()) return FeetPaths{places, loads_beside(decoder, message, field), {}};
  }
  return std::nullopt;
}

std::vector<LegPartSample> feet_in(const MessageView& message, const FeetPaths& paths, Time time) {
  const auto places = points_at(message, paths.places);
  if (!paths.places.empty() && (!places || places->size() != kFeet)) return {};
  std::vector<double> loads;
  for (const std::string& path : paths.single_loads) {
    const auto load = message.number(path);
    if (!load) return {};
    loads.push_back(*load);
  }
  if (!paths.loads.empty()) {
    loads = numbers_at(message, paths.loads).value_or(std::vector<double>());
    if (loads.size() != kFeet) return {};
  }
  std::vector<LegPartSample> feet(kFeet);
  const Time stamp = recorded_stamp(message).value_or(0);
  for (std::size_t i = 0; i < kFeet; ++i) {
    feet[i].time = stamp > 0 ? stamp : time;
    if (!paths.places.empty()) feet[i].place = (*places)[i];
    if (!loads.empty()) feet[i].load = loads[i];
    feet[i].frame = message.text("header.frame_id").value_or("");
  }
  return feet;
}

}  // namespace aims
