// SPDX-License-Identifier: BSD-3-Clause
#include "cli/json_output.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string_view>

#include "bench/scoring/score_record.hpp"
#include "cli/options.hpp"
#include "cli/terminal.hpp"

namespace aims {
namespace {

Json entries_json(const std::vector<std::string>& entries) {
  Json json = Json::array();
  for (const std::string& entry : entries) {
    Json number = Json::parse(entry, nullptr, false);
    json.push_back(number.is_number() ? std::move(number) : Json(entry));
  }
  return json;
}

/// A number, truth value, text or list of these, by what the parameter expects.
Json value_json(const Parameter& parameter) {
  const std::string text = parameter.text();
  if (is_sequence(parameter))
    return entries_json(sequence_entries(text).value_or(std::vector<std::string>()));
  if (parameter.kind == ParameterKind::kFlag) return text == "true";
  return is_number(parameter) ? Json::parse(text, nullptr, false) : Json(text);
}

Json bound_json(double bound) { return std::isfinite(bound) ? Json(bound) : Json(); }

Json parameter_json(const Parameter& parameter) {
  const Spec& spec = parameter.spec;
  Json json = {{"key", parameter.key},
               {"value", value_json(parameter)},
               {"unit", spec.unit},
               {"expected", parameter.expected},
               {"min", bound_json(spec.range.min)},
               {"max", bound_json(spec.range.max)},
               {"meaning", spec.meaning},
               {"source", spec.source}};
  json["no_effect"] = parameter.idle.empty() ? Json() : Json(parameter.idle);
  return json;
}

Json vector_json(const Eigen::Vector3d& value) { return {value.x(), value.y(), value.z()}; }

Json topic_json(const TopicInfo& topic) {
  return {{"topic", topic.topic},
          {"type", topic.type},
          {"frame", topic.frame},
          {"messages", topic.messages},
          {"stamped", topic.stamped},
          {"first_stamp_s", to_seconds(topic.first_stamp)},
          {"last_stamp_s", to_seconds(topic.last_stamp)},
          {"rate_hz", json_of(topic.rate_hz)},
          {"largest_gap_s", json_of(topic.largest_gap_s)},
          {"loss", json_of(topic.loss)},
          {"repeated_stamps", topic.repeated},
          {"backward_stamps", topic.backwards},
          {"median_delay_s", json_of(topic.median_offset_s)},
          {"clock_offset_s", topic.clock ? Json(topic.clock->seconds) : Json()}};
}

Json cloud_json(const CloudInfo& cloud) {
  Json fields = Json::array();
  for (const PointFieldInfo& each : cloud.fields) {
    fields.push_back({{"name", each.name}, {"type", each.type}, {"offset", each.offset}});
  }
  const PointFieldInfo* time = cloud.time_field();
  const PointFieldInfo* ring = cloud.ring_field();
  return {{"topic", cloud.topic},
          {"driver", cloud.driver},
          {"fields", std::move(fields)},
          {"mean_points", cloud.mean_points},
          {"not_finite_fraction", cloud.not_finite_fraction},
          {"broken", cloud.broken},
          {"time_field", time == nullptr ? Json() : Json(time->name)},
          {"ring_field", ring == nullptr ? Json() : Json(ring->name)}};
}

Json imu_json(const ImuInfo& imu) {
  Json json = {{"topic", imu.topic}, {"in_g", imu.in_g}, {"oriented", imu.oriented}};
  json["static_interval"] = Json();
  if (const auto& still = imu.static_interval) {
    json["static_interval"] = {{"begin_s", still->begin_s},
                               {"length_s", still->length_s},
                               {"gyro_bias_radps", vector_json(still->gyro_bias)},
                               {"gyro_noise", vector_json(still->gyro_noise)},
                               {"force_mps2", vector_json(still->force)},
                               {"force_noise", vector_json(still->force_noise)}};
  }
  return json;
}

Json transform_json(const TransformInfo& transform) {
  const Pose& T = transform.T_parent_child;
  const Eigen::Quaterniond& q = T.rotation;
  return {{"parent", transform.parent},
          {"child", transform.child},
          {"static", transform.fixed},
          {"translation_m", vector_json(T.translation)},
          {"rotation_xyzw", {q.x(), q.y(), q.z(), q.w()}}};
}

const char* name_of(Fulfilment fulfilment) {
  switch (fulfilment) {
    case Fulfilment::kMet:
      return "met";
    case Fulfilment::kPoor:
      return "poor";
    case Fulfilment::kMissing:
      break;
  }
  return "missing";
}

/// Of a file whose head cannot be read, everything but its name is null.
Json scenario_json(const ListedScenario& file) {
  const ScenarioHead* scenario = file.head ? &*file.head : nullptr;
  const bool leveled = scenario != nullptr && !scenario->family.empty();
  Json json = {{"name", file.file.stem().string()}, {"file", file.file.string()}};
  json["description"] = scenario != nullptr ? Json(scenario->description) : Json();
  json["tags"] = scenario != nullptr ? Json(scenario->tags) : Json();
  json["family"] = leveled ? Json(scenario->family) : Json();
  json["level"] = leveled ? Json(scenario->level) : Json();
  json["error"] = scenario != nullptr ? Json() : Json(file.head.error().message);
  return json;
}

/// While it lives, what is written to standard output goes to standard error.
class TextToStandardError {
 public:
  TextToStandardError() {
    std::fflush(stdout);
    saved_ = ::dup(STDOUT_FILENO);
    if (saved_ >= 0) ::dup2(STDERR_FILENO, STDOUT_FILENO);
  }
  ~TextToStandardError() {
    std::fflush(stdout);
    if (saved_ < 0) return;
    ::dup2(saved_, STDOUT_FILENO);
    ::close(saved_);
  }
  TextToStandardError(const TextToStandardError&) = delete;
  TextToStandardError& operator=(const TextToStandardError&) = delete;

 private:
  int saved_ = -1;
};

}  // namespace

void add_json(Command& command, bool& json) {
  command.flag("--json", json, "One JSON document on standard output, nothing else");
}

void print_json(const Json& json) { print_out("{}\n", json_text(json, 2)); }

int refuse(const char* command, const Error& error, bool json) {
  if (json) print_json({{"error", error.message}});
  return bad_input(command, error);
}

int answer(const char* command, bool json, const std::function<Result<Answer>()>& run) {
  Result<Answer> result;
  {
    std::optional<TextToStandardError> text;
    if (json) text.emplace();
    result = run();
  }
  if (!result) return refuse(command, result.error(), json);
  if (json) print_json(result->document);
  return result->exit_code;
}

bool wants_json(std::span<char* const> words) {
  return std::any_of(words.begin(), words.end(),
                     [](const char* word) { return std::string_view(word) == "--json"; });
}

Json list_json(const std::filesystem::path& folder, std::span<const ListedScenario> files) {
  Json json = {{"schema", "aims.list/1"},    {"folder", folder.string()},
               {"scenarios", Json::array()}, {"families", Json::array()},
               {"robots", Json::array()},    {"lidars", Json::array()},
               {"estimators", Json::array()}};
  for (const ListedScenario& each : files) json["scenarios"].push_back(scenario_json(each));
  for (const Family& each : families_of(files)) {
    json["families"].push_back(
        {{"name", each.name}, {"level_unit", each.level_unit}, {"scenarios", each.cases}});
  }
  for (const CatalogueEntry& each : robot_catalogue()) {
    json["robots"].push_back({{"name", each.name}, {"description", each.description}});
  }
  for (const CatalogueEntry& each : lidar_catalogue()) {
    json["lidars"].push_back({{"name", each.name}, {"description", each.description}});
  }
  for (const CatalogueEntry& each : estimator_catalogue()) {
    json["estimators"].push_back({{"name", each.name}, {"description", each.description}});
  }
  return json;
}

Json config_json(const std::string& name, const Fields& fields) {
  Json json = {{"schema", "aims.config/1"}, {"name", name}, {"parameters", Json::array()}};
  for (const Parameter& each : fields.parameters()) {
    json["parameters"].push_back(parameter_json(each));
  }
  json["lists"] = Json::array();
  for (const ListField& each : fields.lists()) {
    json["lists"].push_back(
        {{"key", each.key}, {"entries", each.size()}, {"meaning", each.meaning}});
  }
  return json;
}

Json info_json(const BagInfo& info) {
  const BagSummary& summary = info.summary;
  Json json = {{"schema", "aims.info/1"},
               {"bag", info.file.string()},
               {"bytes", summary.file_size},
               {"messages", summary.messages},
               {"start_s", to_seconds(summary.start)},
               {"end_s", to_seconds(summary.end)},
               {"compression", summary.compression},
               {"lost_bytes", summary.lost_bytes},
               {"undecodable", info.undecodable},
               {"topics", Json::array()},
               {"clouds", Json::array()},
               {"imus", Json::array()},
               {"transforms", Json::array()}};
  for (const TopicInfo& each : info.topics) json["topics"].push_back(topic_json(each));
  for (const CloudInfo& each : info.clouds) json["clouds"].push_back(cloud_json(each));
  for (const ImuInfo& each : info.imus) json["imus"].push_back(imu_json(each));
  for (const TransformInfo& each : info.transforms) {
    json["transforms"].push_back(transform_json(each));
  }
  const TopicsConfig& used = info.used;
  json["used"] = {{"lidar", used.lidar},
                  {"imu", used.imu},
                  {"leg_odometry", used.leg_odometry},
                  {"joint_states", used.joint_states},
                  {"contacts", used.contacts},
                  {"truth", used.truth}};
  json["notes"] = info.notes;
  json["warnings"] = info.warnings;
  json["refusal"] = info.refusal ? Json(*info.refusal) : Json();
  return json;
}

Json check_json(const std::filesystem::path& bag, const std::vector<RequirementCheck>& checks) {
  Json json = {{"schema", "aims.check/1"}, {"bag", bag.string()}, {"requirements", Json::array()}};
  for (const RequirementCheck& each : checks) {
    json["requirements"].push_back({{"system", each.system},
                                    {"requirement", each.requirement},
                                    {"fulfilment", name_of(each.fulfilment)},
                                    {"found", each.found},
                                    {"remedy", each.remedy}});
  }
  return json;
}

}  // namespace aims
