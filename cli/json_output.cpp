// SPDX-License-Identifier: BSD-3-Clause
#include "cli/json_output.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <optional>
#include <string_view>

#include "bench/estimate/estimate_summary.hpp"
#include "bench/scoring/score_record.hpp"
#include "cli/options.hpp"
#include "cli/terminal.hpp"

namespace aims {
namespace {

Json entries_json(const std::vector<std::string>& entries) {
  return json_array(entries, [](const std::string& entry) {
    Json number = Json::parse(entry, nullptr, false);
    return number.is_number() ? number : Json(entry);
  });
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
  Json fields = json_array(cloud.fields, [](const PointFieldInfo& each) {
    return Json{{"name", each.name}, {"type", each.type}, {"offset", each.offset}};
  });
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
  const auto family_json = [](const Family& each) {
    return Json{{"name", each.name}, {"level_unit", each.level_unit}, {"scenarios", each.cases}};
  };
  const auto entry_json = [](const CatalogueEntry& each) {
    return Json{{"name", each.name}, {"description", each.description}};
  };
  return {{"schema", "aims.list/1"},
          {"folder", folder.string()},
          {"scenarios", json_array(files, scenario_json)},
          {"families", json_array(families_of(files), family_json)},
          {"robots", json_array(robot_catalogue(), entry_json)},
          {"lidars", json_array(lidar_catalogue(), entry_json)},
          {"estimators", json_array(estimator_catalogue(), entry_json)}};
}

Json config_json(const std::string& name, const Fields& fields) {
  const auto list_json = [](const ListField& each) {
    return Json{{"key", each.key}, {"entries", each.size()}, {"meaning", each.meaning}};
  };
  return {{"schema", "aims.config/1"},
          {"name", name},
          {"parameters", json_array(fields.parameters(), parameter_json)},
          {"lists", json_array(fields.lists(), list_json)}};
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
               {"topics", json_array(info.topics, topic_json)},
               {"clouds", json_array(info.clouds, cloud_json)},
               {"imus", json_array(info.imus, imu_json)},
               {"transforms", json_array(info.transforms, transform_json)}};
  json["used"] = topics_json(info.used);
  json["notes"] = info.notes;
  json["warnings"] = info.warnings;
  json["refusal"] = info.refusal ? Json(*info.refusal) : Json();
  return json;
}

Json check_json(const std::filesystem::path& bag, const std::vector<RequirementCheck>& checks) {
  const auto requirement_json = [](const RequirementCheck& each) {
    return Json{{"system", each.system},
                {"requirement", each.requirement},
                {"fulfilment", name_of(each.fulfilment)},
                {"found", each.found},
                {"remedy", each.remedy}};
  };
  return {{"schema", "aims.check/1"},
          {"bag", bag.string()},
          {"requirements", json_array(checks, requirement_json)}};
}

}  // namespace aims
