// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/dataset_profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "bench/estimate/python_classes.hpp"
#include "bench/estimate/scoring_points.hpp"
#include "bench/scoring/score_record.hpp"
#include "core/files/yaml_config.hpp"
#include "core/text.hpp"
#include "estimator/estimator_spec.hpp"
#include "recordings/frames/configured_extrinsic.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

Spec text(std::string meaning) { return {.unit = "-", .meaning = std::move(meaning)}; }

bool any_holds(const std::vector<std::string>& texts, std::string_view part) {
  return std::ranges::any_of(
      texts, [part](const std::string& each) { return each.find(part) != std::string::npos; });
}

/// Which keys of the truth have no effect beside the others.
void describe_idle(Fields& f, const DatasetTruth& truth) {
  std::vector<std::string> patterns = truth.files;
  for (const TruthCase& each : truth.cases) {
    patterns.insert(patterns.end(), each.files.begin(), each.files.end());
  }
  const bool by_file = !patterns.empty();
  patterns.insert(patterns.end(), truth.lever_arm_files.begin(), truth.lever_arm_files.end());
  f.idle_if(!any_holds(patterns, "{name}"), "no file has {name}", {"name_without"});
  f.idle_if(truth.end_pose.empty(), "end_pose is empty", {"end_pose_of"});
  const bool none = truth.lever_arm_files.empty();
  f.idle_if(none && truth.lever_arm.empty(), "neither lever_arm nor lever_arm_files is given",
            {"lever_arm_frame"});
  f.idle_if(none && truth.lever_arm == "estimate", "the lever arm is estimated in the IMU frame",
            {"lever_arm_frame"});
  f.idle_if(!by_file && truth.topic.empty(), "neither files nor topic is given",
            {"lever_arm", "lever_arm_files", "lever_arm_frame", "time_offset_s"});
  f.idle_if(!by_file && truth.topic.empty() && truth.end_pose.empty(),
            "neither files nor topic nor end_pose is given", {"extrinsic"});
}

/// Dotted keys of the scores that a trajectory can have with these settings.
std::vector<std::string> possible_scores(ScoreConfig scoring) {
  scoring.association = Association::kAtTruth;
  RunRecord record;
  record.scores["estimators"]["it"] = scores_json(undefined_scores(scoring));
  return score_keys(record, "it");
}

/// Error, with the place where it was set, for a score that no trajectory has.
Result<void> check_score_key(const DatasetProfile& profile, std::span<const AssignedKey> assigned) {
  const std::string& key = profile.score;
  if (key.starts_with("m_list_percent.") || key.starts_with("m_list_signed_percent.")) return {};
  const std::vector<std::string> known = possible_scores(profile.read.scoring);
  if (std::ranges::find(known, key) != known.end()) return {};
  std::string place;
  for (const AssignedKey& each : assigned) {
    if (each.key == "score") place = each.place;
  }
  const std::string near = near_match(key, known);
  return failure(fmt::format(
      "{}score: no score '{}'; expected a key of an estimator in scores.json, e.g. ate_se3_m{}",
      place, key, near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
}

/// Error for a case that fits no sequence, or changes nothing.
Result<void> check_cases(const DatasetTruth& truth) {
  for (std::size_t i = 0; i < truth.cases.size(); ++i) {
    const TruthCase& each = truth.cases[i];
    const auto empty = [](const std::string& part) { return part.empty(); };
    if (each.of.empty() || std::ranges::any_of(each.of, empty)) {
      return failure(fmt::format("truth.cases.{}.of: expected parts of names of sequences", i));
    }
    if (each.files.empty() && each.extrinsic.empty() && each.note.empty()) {
      return failure(fmt::format("truth.cases.{}: expected files, extrinsic or note", i));
    }
  }
  return {};
}

/// Error for poses and points of the truth that are not written as such.
Result<void> check_points_of(const DatasetTruth& truth, const fs::path& file) {
  ScoringRequest request;
  request.extrinsic = truth.extrinsic;
  request.lever_arm = truth.lever_arm;
  request.lever_frame = truth.lever_arm_frame;
  request.end_pose = truth.end_pose;
  std::string key = "truth";
  auto right = check_points(request);
  for (std::size_t i = 0; right && i < truth.cases.size(); ++i) {
    key = fmt::format("truth.cases.{}", i);
    request.extrinsic = truth.cases[i].extrinsic;
    right = check_points(request);
  }
  if (!right) return failure(fmt::format("{}: {}: {}", file.string(), key, right.error().message));
  return {};
}

/// Keys that the file itself or a setting has; a base may have some that the file makes idle.
std::vector<AssignedKey> own_keys(std::vector<AssignedKey> assigned, const fs::path& file) {
  std::erase_if(assigned, [&](const AssignedKey& each) {
    return each.from_file && !each.place.starts_with(file.string() + ":");
  });
  return assigned;
}

/// What can be said of a profile before any recording is read.
Result<void> check_profile(DatasetProfile& profile, std::span<const std::string> overrides,
                           const std::vector<AssignedKey>& assigned, const fs::path& file) {
  EstimateConfig& read = profile.read;
  if (read.run.empty()) return failure("run: expected at least one name");
  if (auto specs = check_estimator_specs(read.run); !specs) {
    return failure("run: " + specs.error().message);
  }
  const bool chosen = std::ranges::any_of(overrides, is_run_setting);
  auto right = check_effects(fields_of(profile), own_keys(assigned, file), chosen, read.run,
                             read.estimators);
  if (right) right = check_extrinsics(read.recording, assigned);
  if (right) right = check_score_key(profile, assigned);
  if (right) right = check_cases(profile.truth);
  if (right) right = check_points_of(profile.truth, file);
  return right;
}

}  // namespace

void describe(Fields& f, PublishedScore& published) {
  f.text("system", published.system, text("who was scored"));
  f.text("sequence", published.sequence, text("name of the recording, without its ending"));
  f.number("value", published.value,
           {.unit = "of the score", .range = within(1e9), .meaning = "as published"});
}

void describe(Fields& f, TruthCase& each) {
  f.texts("of", each.of, text("parts of the names of the sequences, in any case"));
  f.texts("files", each.files, text("as truth.files, looked for before them"));
  f.text("extrinsic", each.extrinsic, text("in place of truth.extrinsic"));
  f.text("note", each.note, text("what was assumed"));
}

void describe(Fields& f, DatasetTruth& truth) {
  f.texts("files", truth.files,
          text("paths below the data set or the sequence, with {sequence}, {name} (without its "
               "date and name_without) and *"));
  f.texts("name_without", truth.name_without, text("endings that {name} leaves out"));
  f.text("topic", truth.topic, text("topic of the recording with the truth"));
  f.text("extrinsic", truth.extrinsic, text("'x y z qx qy qz qw': IMU in the body of the truth"));
  f.text("lever_arm", truth.lever_arm,
         text("'x y z' of the prism in lever_arm_frame, or estimate"));
  f.texts("lever_arm_files", truth.lever_arm_files,
          text("positions of the measured points in a frame of the body, by stamp"));
  f.text("lever_arm_frame", truth.lever_arm_frame,
         text("'x y z qx qy qz qw' of that frame in the IMU frame; empty: the IMU frame"));
  f.text("end_pose", truth.end_pose, text("pose of the end in the frame of the start"));
  f.texts("end_pose_of", truth.end_pose_of,
          text("parts of the names of the sequences that have that end; empty: of all"));
  f.number("time_offset_s", truth.time_offset_s,
           {.unit = "s", .range = within(4e9), .meaning = "added to the estimates' stamps"});
  f.list("cases", truth.cases, "what differs for some sequences");
  describe_idle(f, truth);
}

void describe(Fields& f, DatasetProfile& profile) {
  f.text("title", profile.title, text("name of the data set"));
  f.text("citation", profile.citation, text("what to cite"));
  f.text("url", profile.url, text("where to get it"));
  f.text("licence", profile.licence, text("of the data"));
  f.text("tested", profile.tested, text("generated data, or the original"));
  describe(f, profile.read);
  f.group("truth", profile.truth);
  f.text("score", profile.score, text("dotted key of scores.json that the authors report"));
  f.text("unit", profile.unit, text("of the score"));
  f.text("score_text", profile.score_text, text("how the authors compute it"));
  f.texts("notes", profile.notes, text("what was assumed of the data set"));
  f.text("published_source", profile.published_source, text("where the published scores stand"));
  f.list("published", profile.published, "scores as published");
  f.idle_if(profile.published.empty(), "published is empty", {"published_source"});
}

Result<DatasetProfile> load_dataset_profile(const fs::path& file,
                                            std::span<const std::string> overrides) {
  DatasetProfile profile;
  EstimateConfig& read = profile.read;
  const YamlFiles files;
  auto chosen = choose_run(file, overrides, files, read.run, read.estimators);
  if (!chosen) return tl::unexpected(chosen.error());
  read.run = std::move(chosen->of_file);
  std::vector<AssignedKey> assigned;
  if (auto ok = load_config(file, profile, &assigned, files); !ok) {
    return tl::unexpected(ok.error());
  }
  find_calibrations(read.recording, file.parent_path());
  read.run = std::move(chosen->all);
  if (auto ok = apply_overrides(profile, overrides, &assigned, files); !ok)
    return tl::unexpected(ok.error());
  if (auto right = check_profile(profile, overrides, assigned, file); !right) {
    return tl::unexpected(right.error());
  }
  if (profile.unit.empty()) profile.unit = score_at(profile.score).unit;
  read.recording.topics.truth = "none";  // no estimator is read together with it
  profile.name = file.stem().string();
  return profile;
}

bool holds_part(const std::string& sequence, std::span<const std::string> parts) {
  const std::string name = lower_case(sequence);
  return std::ranges::any_of(parts, [&name](const std::string& part) {
    return name.find(lower_case(part)) != std::string::npos;
  });
}

const TruthCase* case_of(const DatasetProfile& profile, const std::string& sequence) {
  for (const TruthCase& each : profile.truth.cases) {
    if (holds_part(sequence, each.of)) return &each;
  }
  return nullptr;
}

DatasetTruth truth_of(const DatasetProfile& profile, const std::string& sequence) {
  DatasetTruth truth = profile.truth;
  truth.cases.clear();
  const TruthCase* own = case_of(profile, sequence);
  if (own == nullptr) return truth;
  truth.files.insert(truth.files.begin(), own->files.begin(), own->files.end());
  if (!own->extrinsic.empty()) truth.extrinsic = own->extrinsic;
  return truth;
}

std::vector<fs::path> dataset_profiles(const fs::path& folder) {
  std::vector<fs::path> files;
  std::error_code ignored;
  for (const auto& each : fs::directory_iterator(folder, ignored)) {
    if (each.path().extension() == ".yaml") files.push_back(each.path());
  }
  std::ranges::sort(files);
  return files;
}

Result<fs::path> find_dataset_profile(const std::string& given, const fs::path& folder) {
  std::error_code ignored;
  if (fs::is_regular_file(given, ignored)) return fs::path(given);
  std::vector<std::string> names;
  for (const fs::path& each : dataset_profiles(folder)) {
    names.push_back(each.stem().string());
    if (names.back() == given) return each;
  }
  const std::string near = near_match(given, names);
  return failure(fmt::format("no profile '{}'; expected a file or one of {}{}", given,
                             names.empty() ? "none" : fmt::format("{}", fmt::join(names, ", ")),
                             near.empty() ? "" : fmt::format("; did you mean '{}'?", near)));
}

}  // namespace aims
