// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/dataset_profile.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

#include "bench/estimate/python_classes.hpp"
#include "core/files/yaml_config.hpp"
#include "estimator/estimator_spec.hpp"
#include "recordings/frames/configured_extrinsic.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

Spec text(std::string meaning) { return {.unit = "-", .meaning = std::move(meaning)}; }

}  // namespace

void describe(Fields& f, PublishedScore& published) {
  f.text("system", published.system, text("who was scored"));
  f.text("sequence", published.sequence, text("name of the recording, without its ending"));
  f.number("value", published.value,
           {.unit = "of the score", .range = within(1e9), .meaning = "as published"});
}

void describe(Fields& f, DatasetTruth& truth) {
  f.texts("files", truth.files,
          text("paths below the data set or the sequence, with {sequence}, {name} (without its "
               "date) and *"));
  f.text("topic", truth.topic, text("topic of the recording with the truth"));
  f.text("extrinsic", truth.extrinsic, text("'x y z qx qy qz qw': IMU in the body of the truth"));
  f.text("lever_arm", truth.lever_arm, text("'x y z' of the prism in the IMU frame, or estimate"));
  f.texts("lever_arm_files", truth.lever_arm_files,
          text("positions of the measured points in a frame of the body, by stamp"));
  f.text("lever_arm_frame", truth.lever_arm_frame,
         text("'x y z qx qy qz qw' of that frame in the IMU frame"));
  f.text("end_pose", truth.end_pose, text("pose of the end in the frame of the start"));
  f.texts("end_pose_of", truth.end_pose_of,
          text("parts of the names of the sequences that have that end; empty: of all"));
  f.number("time_offset_s", truth.time_offset_s,
           {.unit = "s", .range = within(4e9), .meaning = "added to the estimates' stamps"});
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
  f.text("published_source", profile.published_source, text("where the published scores stand"));
  f.list("published", profile.published, "scores as published");
}

Result<DatasetProfile> load_dataset_profile(const fs::path& file,
                                            std::span<const std::string> overrides) {
  DatasetProfile profile;
  EstimateConfig& read = profile.read;
  const YamlFiles files;
  auto chosen = choose_run(file, overrides, files, read.run, read.estimators);
  if (!chosen) return tl::unexpected(chosen.error());
  read.run = std::move(chosen->of_file);
  if (auto ok = load_config(file, profile, nullptr, files); !ok) return tl::unexpected(ok.error());
  find_calibrations(read.recording, file.parent_path());
  read.run = std::move(chosen->all);
  if (auto ok = apply_overrides(profile, overrides, nullptr, files); !ok)
    return tl::unexpected(ok.error());
  if (read.run.empty()) return failure("run: expected at least one name");
  if (auto specs = check_estimator_specs(read.run); !specs) {
    return failure("run: " + specs.error().message);
  }
  read.recording.topics.truth = "none";  // no estimator is read together with it
  profile.name = file.stem().string();
  return profile;
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
