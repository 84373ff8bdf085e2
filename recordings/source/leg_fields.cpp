// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/leg_fields.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <string_view>

#include "core/text.hpp"
#include "recordings/legs/leg_names.hpp"
#include "recordings/messages/message_values.hpp"

namespace aims {
namespace {

constexpr auto kAngles = std::to_array<std::string_view>(
    {"position", "positions", "q", "qpos", "pos", "angle", "angles", "jointposition",
     "jointpositions", "jointangle", "jointangles", "jointpos", "processvalue"});
constexpr auto kRates = std::to_array<std::string_view>(
    {"velocity", "velocities", "dq", "qd", "qvel", "vel", "rate", "rates", "speed", "speeds",
     "jointvelocity", "jointvelocities", "jointvel", "processvaluedot"});
constexpr auto kEfforts = std::to_array<std::string_view>(
    {"effort", "efforts", "tau", "torque", "torques", "tauest", "jointtorque", "jointtorques"});
constexpr auto kLoads = std::to_array<std::string_view>(
    {"contact", "incontact", "iscontact", "contactstate", "contactflag", "stance", "isstance",
     "touch", "touchdown", "force", "load", "footforce", "contactforce", "normalforce", "grf",
     "pressure", "footload", "footcontact"});
constexpr auto kPlaces = std::to_array<std::string_view>(
    {"footposition", "footpos", "footpositionbody", "footpositionbase", "footpositioninbody",
     "footpositionrtbody", "footposition2body", "footpoint"});
/// Of the foot, where topic and type speak of one.
constexpr auto kPlacesOfFeet = std::to_array<std::string_view>(
    {"position", "pos", "point", "place", "translation", "positionbody"});
constexpr auto kLegs = std::to_array<std::string_view>(
    {"leg", "legid", "legindex", "legname", "legnumber", "foot", "footid", "footindex", "footname",
     "footnumber", "limb", "limbid", "limbname"});

/// The path of the vector that "a.force.x" is a coordinate of; empty for others.
std::string vector_of(std::string_view path) {
  if (!path.ends_with(".x")) return {};
  return std::string(path.substr(0, path.size() - 2));
}

}  // namespace

std::string last_name(std::string_view path) {
  std::string name = lower_case(path.substr(path.rfind('.') + 1));
  std::erase(name, '_');
  return name;
}

bool is_of_feet(std::string_view topic, std::string_view type) {
  const std::string both = lower_case(fmt::format("{} {}", topic, type));
  const auto holds = [&both](std::string_view part) { return both.find(part) != both.npos; };
  return (holds("foot") || holds("feet") || holds("toe")) && !holds("joint") && !holds("motor");
}

LegFields::LegFields(std::string_view topic, const std::string& type, const MessageDecoder& decoder)
    : joint_state_(type == "sensor_msgs/JointState"),
      plain_(type.starts_with("std_msgs/")),
      of_feet_(is_of_feet(topic, type)) {
  for (const MessageField& field : decoder.fields()) take(field);
}

void LegFields::take(const MessageField& field) {
  const std::string name = last_name(field.path);
  const bool number = field.kind == FieldKind::kNumber, numbers = field.kind == FieldKind::kNumbers;
  take_place(field, name);
  if ((number || numbers) && place_ != field.path) {
    if (angles_.empty() && is_one_of(name, kAngles)) {
      angles_ = field.path;
      one_joint_ = number;
    }
    if (rates_.empty() && is_one_of(name, kRates)) rates_ = field.path;
    if (efforts_.empty() && is_one_of(name, kEfforts)) efforts_ = field.path;
  }
  const std::string vector = vector_of(field.path);
  const bool is_load = number && (is_one_of(name, kLoads) || (plain_ && name == "data"));
  if (load_.empty() && is_load) {
    load_ = field.path;
  } else if (load_.empty() && number && is_one_of(last_name(vector), kLoads)) {
    load_ = vector;
    load_kind_ = LoadKind::kVector;
  } else if (load_.empty() && numbers && is_one_of(name, kLoads)) {
    load_ = field.path;
    load_kind_ = LoadKind::kNumbers;
  } else if (load_.empty() && field.kind == FieldKind::kMessages && name == "states") {
    load_ = field.path;
    load_kind_ = LoadKind::kEntries;
  }
  const bool names = number || field.kind == FieldKind::kText;
  if (leg_.empty() && names && is_one_of(name, kLegs)) leg_ = field.path;
}

void LegFields::take_place(const MessageField& field, const std::string& name) {
  if (!place_.empty()) return;
  const auto fits = [&](const std::string& each) {
    return is_one_of(each, kPlaces) || (of_feet_ && is_one_of(each, kPlacesOfFeet));
  };
  const std::string vector = vector_of(field.path);
  if (field.kind == FieldKind::kNumber && !vector.empty() && fits(last_name(vector))) {
    place_ = vector;
  } else if (field.kind == FieldKind::kNumbers && fits(name)) {
    place_ = field.path;
  }
}

std::vector<double> LegFields::joints_of(const MessageView& message,
                                         const std::string& path) const {
  if (path.empty()) return {};
  if (const auto numbers = numbers_at(message, path)) return *numbers;
  const auto number = message.number(path);
  return number ? std::vector<double>{*number} : std::vector<double>();
}

std::optional<double> LegFields::load_of(const MessageView& message) const {
  if (load_.empty()) return std::nullopt;
  if (load_kind_ == LoadKind::kNumber) return message.number(load_);
  if (load_kind_ == LoadKind::kVector) {
    const auto vector = vector_at(message, load_);
    return vector ? std::optional(vector->norm()) : std::nullopt;
  }
  if (load_kind_ == LoadKind::kEntries) {
    const auto entries = message.size(load_);
    return entries ? std::optional(*entries > 0 ? 1.0 : 0.0) : std::nullopt;
  }
  const auto numbers = numbers_at(message, load_);
  if (!numbers || numbers->empty()) return std::nullopt;
  double squares = 0.0;
  for (const double each : *numbers) squares += each * each;
  return numbers->size() == 1 ? numbers->front() : std::sqrt(squares);
}

/// The leg by its own field, else the one of all joints, else by the frame.
std::string LegFields::leg_of(const MessageView& message, const LegPartSample& sample) const {
  if (!leg_.empty()) {
    if (const auto text = message.text(leg_)) return std::string(*text);
    const auto number = message.number(leg_);
    return number && std::isfinite(*number) ? fmt::format("{:g}", *number) : "";
  }
  if (!sample.names.empty()) {
    const auto leg = leg_of_name(sample.names.front());
    const bool one = leg && std::ranges::all_of(sample.names, [&](const std::string& name) {
                       return leg_of_name(name) == leg;
                     });
    return one ? sample.names.front() : "";
  }
  return std::string(message.text("header.frame_id").value_or(""));
}

std::optional<LegPartSample> LegFields::read(const MessageView& message, Time time) const {
  LegPartSample sample;
  const Time stamp = recorded_stamp(message).value_or(0);
  sample.time = stamp > 0 ? stamp : time;
  sample.angles = joints_of(message, angles_);
  sample.rates = joints_of(message, rates_);
  sample.efforts = joints_of(message, efforts_);
  sample.load = load_of(message);
  if (!place_.empty()) sample.place = vector_at(message, place_);
  if (const auto points = points_at(message, place_); points && points->size() == 1) {
    sample.place = points->front();
  }
  sample.frame = message.text("header.frame_id").value_or("");
  if (joint_state_) {
    for (const auto& name : message.texts("name").value_or(std::vector<std::string_view>())) {
      sample.names.emplace_back(name);
    }
    if (sample.names.size() != sample.angles.size()) sample.names.clear();
  }
  if (sample.angles.empty() && !sample.load && !sample.place) return std::nullopt;
  sample.leg = leg_of(message, sample);
  return sample;
}

}  // namespace aims
