// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <span>
#include <string>
#include <vector>

#include "bench/estimate/estimate.hpp"
#include "core/config.hpp"
#include "core/error.hpp"

namespace aims {

/// What the authors of a data set, or of a system, report of one sequence.
struct PublishedScore {
  std::string system;
  std::string sequence;
  double value = 0.0;  ///< in the unit of the profile's score
};

/// What differs for some sequences.
struct TruthCase {
  std::vector<std::string> of;     ///< parts of the names of those sequences, in any case
  std::vector<std::string> files;  ///< looked for before those of all
  std::string extrinsic;           ///< in place of that of all; empty: that of all
  std::string note;                ///< what was assumed of them
};

/// Where the truth of a sequence is, and how estimates meet it.
struct DatasetTruth {
  /// Files below the folder of the data set or of the sequence, with {sequence}, {name} (without
  /// the date around it and without `name_without`) and *; the first that is there counts.
  std::vector<std::string> files;
  std::vector<std::string> name_without;  ///< endings that {name} leaves out, in any case
  std::string topic;      ///< of the recording, where no file is found; "/tf:PARENT,CHILD"
  std::string extrinsic;  ///< as --extrinsic of aims score
  std::string lever_arm;  ///< as --lever-arm
  /// Files as `files`: where the measured points were in a frame of the body, by stamp.
  std::vector<std::string> lever_arm_files;
  /// The pose of the frame of `lever_arm` or `lever_arm_files` in the IMU frame,
  /// "x y z qx qy qz qw"; empty: it is the IMU frame.
  std::string lever_arm_frame;
  std::string end_pose;  ///< as --end-pose; with `files` of those sequences that have none
  std::vector<std::string> end_pose_of;  ///< parts of the names of those sequences; empty: of all
  double time_offset_s = 0.0;            ///< added to the stamps of the estimates [s]
  std::vector<TruthCase> cases;          ///< the first whose `of` fits counts
};

/// A public data set: how it is read, scored as its authors score it, and what they report.
struct DatasetProfile {
  std::string name;  ///< of the file
  std::string title, citation, url, licence;
  std::string tested;   ///< "generated data" or "the original"
  EstimateConfig read;  ///< topics, calibration, scoring, who runs
  DatasetTruth truth;
  std::string score = "ate_se3_m";  ///< dotted key of scores.json that the authors report
  std::string unit;                 ///< empty: as the list of scores has it
  std::string score_text;           ///< how the authors compute it
  std::vector<std::string> notes;   ///< what was assumed of the data set, a sentence each
  std::string published_source;     ///< of all that follow; empty: none was read in a source
  std::vector<PublishedScore> published;
};

void describe(Fields& fields, DatasetProfile& profile);

/// Reads a profile with settings "key=value" on top. Errors as of `load_estimate_config`.
Result<DatasetProfile> load_dataset_profile(const std::filesystem::path& file,
                                            std::span<const std::string> overrides);

/// Whether the name of the sequence holds one of the parts, in any case.
bool holds_part(const std::string& sequence, std::span<const std::string> parts);

/// The case of that sequence; null: none fits.
const TruthCase* case_of(const DatasetProfile& profile, const std::string& sequence);

/// The truth as it is for that sequence: what its case has goes first.
DatasetTruth truth_of(const DatasetProfile& profile, const std::string& sequence);

/// The profiles in a folder, sorted.
std::vector<std::filesystem::path> dataset_profiles(const std::filesystem::path& folder);

/// A file, or NAME.yaml in the folder. Error: the names there, and the nearest.
Result<std::filesystem::path> find_dataset_profile(const std::string& given,
                                                   const std::filesystem::path& folder);

}  // namespace aims
