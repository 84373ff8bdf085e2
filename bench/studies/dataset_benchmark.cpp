// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/dataset_benchmark.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <utility>

#include "bench/estimate/estimate_summary.hpp"
#include "bench/jobs/job_id.hpp"
#include "bench/jobs/job_runner.hpp"
#include "bench/run/code_version.hpp"
#include "bench/scoring/report.hpp"
#include "bench/scoring/score_list.hpp"
#include "bench/studies/suite_summary.hpp"
#include "core/files/config_dump.hpp"
#include "core/text.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// Everything that decides the result, in words.
std::string id_of(DatasetProfile profile, const DatasetSequence& sequence,
                  const EstimatorSpec& estimator) {
  profile.published.clear();
  profile.read.run = {text_of(estimator)};
  return text_hash(fmt::format("benchmark/1\n{}\n{}\n{}\n{}", code_version(), fingerprint(sequence),
                               text_of(estimator), dump_config(fields_of(profile))));
}

/// Of what is stored of a sequence: the notes of one estimator, which others may not have.
std::string notes_key(const std::string& label) { return "notes of " + label; }

/// Where a mount is from.
std::string mount_note(const ExtrinsicConfig& stated, const Pose& pose, std::string_view sensor,
                       bool assumed) {
  const Eigen::Vector3d& p = pose.translation;
  const Eigen::Quaterniond& q = pose.rotation;
  return fmt::format("{} in the IMU frame: [{}, {}, {}] m, quaternion xyzw [{}, {}, {}, {}], {}",
                     sensor, decimal_text(p.x(), 4), decimal_text(p.y(), 4), decimal_text(p.z(), 4),
                     decimal_text(q.x(), 4), decimal_text(q.y(), 4), decimal_text(q.z(), 4),
                     decimal_text(q.w(), 4),
                     stated.is_given() ? "as the profile states"
                     : assumed         ? "assumed"
                                       : "from the tf of the recording");
}

std::vector<std::string> mount_notes(const RecordingConfig& config, const RecordingSetup& setup) {
  const auto assumed = [&setup](WarnedSensor sensor) {
    return std::ranges::any_of(setup.warnings, [sensor](const ReadingWarning& each) {
      return each.kind == WarningKind::kMountAssumed && each.sensor == sensor;
    });
  };
  std::vector<std::string> notes;
  if (!setup.topics.lidar.empty() && setup.topics.lidar != "none") {
    notes.push_back(mount_note(config.T_imu_lidar, setup.rig.T_body_lidar, "LiDAR",
                               assumed(WarnedSensor::kLidar)));
  }
  if (setup.has_legs) {
    notes.push_back(
        mount_note(config.T_imu_base, setup.rig.T_body_base, "base", assumed(WarnedSensor::kLegs)));
  }
  return notes;
}

JobResult result_of(const DatasetProfile& profile, const DatasetSequence& sequence,
                    const EstimatorSpec& estimator, const fs::path& folder,
                    std::atomic<double>& part) {
  std::error_code ignored;
  fs::create_directories(folder, ignored);
  const auto observed = [&part](const Progress& progress) {
    if (progress.expected_s > 0.0) part = progress.simulated_s / progress.expected_s;
    return true;
  };
  JobResult job;
  const auto result = estimate_sequence(profile, sequence, text_of(estimator), folder, observed);
  if (!result) {
    job.outcome = JobOutcome::kFailed;
    job.message = result.error().message;
    return job;
  }
  std::vector<std::string> notes = mount_notes(profile.read.recording, result->setup);
  notes.insert(notes.end(), result->setup.notes.begin(), result->setup.notes.end());
  for (const ReadingWarning& each : result->setup.warnings) notes.push_back(each.text);
  job.sequence = {{"recorded_s", result->recorded_s}, {"segments", Json::array()}};
  job.scores = {{"success", nullptr}};
  if (result->scores) {
    const RunRecord record = estimate_record(*result);
    job.scores = record.scores["estimators"].front();
    job.sequence["truth"] = record.scores["truth"];
    notes.insert(notes.end(), result->scores->notes.begin(), result->scores->notes.end());
  }
  job.sequence[notes_key(estimator.label)] = notes;
  return job;
}

std::vector<std::string> systems_of(const DatasetProfile& profile) {
  std::vector<std::string> systems;
  for (const PublishedScore& each : profile.published) {
    if (std::ranges::find(systems, each.system) == systems.end()) systems.push_back(each.system);
  }
  return systems;
}

std::optional<double> published_in(const DatasetProfile& profile, const std::string& system,
                                   const std::string& sequence) {
  const auto found = std::ranges::find_if(profile.published, [&](const PublishedScore& each) {
    return each.system == system && each.sequence == sequence;
  });
  if (found != profile.published.end()) return found->value;
  // Recordings have the sensor before the sequence and the date behind it.
  for (const PublishedScore& each : profile.published) {
    if (each.system == system && sequence.find(each.sequence) != std::string::npos) {
      return each.value;
    }
  }
  return std::nullopt;
}

std::optional<double> ours_in(const SuiteCase& each, const std::string& label,
                              const std::string& score) {
  return each.runs.empty() ? std::nullopt : find_score(each.runs.front(), label, score);
}

Json sequence_json(const DatasetBenchmark& benchmark, const DatasetSequence& sequence,
                   const SuiteCase& each) {
  const DatasetProfile& profile = benchmark.profile;
  Json json = {{"name", sequence.name},
               {"recording", sequence.recording.string()},
               {"truth", sequence.truth},
               {"truth_text", sequence.truth.empty() ? "" : truth_text(profile, sequence)},
               {"lack", sequence.lack},
               {"notes", scoring_notes(profile, sequence)},
               {"ours", Json::object()},
               {"published", Json::object()}};
  for (const std::string& label : labels_of(profile.read.run)) {
    json["ours"][label] = json_of(ours_in(each, label, profile.score));
  }
  for (const std::string& system : systems_of(profile)) {
    const auto value = published_in(profile, system, sequence.name);
    if (value) json["published"][system] = *value;
  }
  return json;
}

/// The names, or how many there are.
std::string names_text(const std::vector<std::string>& names, std::size_t all) {
  constexpr std::size_t kMost = 4;
  if (names.size() <= kMost) return fmt::format("{}", fmt::join(names, ", "));
  if (names.size() == all) return fmt::format("all {} sequences", all);
  const std::vector<std::string> first(names.begin(), names.begin() + kMost);
  return fmt::format("{} and {} more", fmt::join(first, ", "), names.size() - kMost);
}

/// What was assumed of each sequence; equal notes once, with all of whom they are.
std::vector<std::string> sequence_notes(const DatasetBenchmark& benchmark) {
  std::vector<std::pair<std::string, std::vector<std::string>>> notes;
  const auto add = [&notes](const std::string& note, const std::string& sequence) {
    const auto known =
        std::ranges::find_if(notes, [&](const auto& each) { return each.first == note; });
    if (known == notes.end()) {
      notes.push_back({note, {sequence}});
    } else if (known->second.back() != sequence) {
      known->second.push_back(sequence);
    }
  };
  for (std::size_t i = 0; i < benchmark.sequences.size(); ++i) {
    const DatasetSequence& sequence = benchmark.sequences[i];
    for (const std::string& note : scoring_notes(benchmark.profile, sequence)) {
      add(note, sequence.name);
    }
    const SuiteCase& each = benchmark.suite.cases[i];
    if (each.runs.empty()) continue;
    for (const std::string& label : labels_of(benchmark.profile.read.run)) {
      for (const Json& note : member(each.runs.front().scores, notes_key(label))) {
        if (note.is_string()) add(note.get<std::string>(), sequence.name);
      }
    }
  }
  std::vector<std::string> lines;
  for (const auto& [note, names] : notes) {
    lines.push_back(fmt::format("{}: {}", names_text(names, benchmark.sequences.size()), note));
  }
  return lines;
}

std::vector<std::string> benchmark_notes(const DatasetBenchmark& benchmark) {
  const DatasetProfile& profile = benchmark.profile;
  std::vector<std::string> notes = {
      benchmark_score_text(profile),
      profile.published_source.empty()
          ? std::string("published: no figures were read in a source that could be checked")
          : fmt::format("published: {}", profile.published_source),
      fmt::format("cite: {}", profile.citation),
      fmt::format("data: {}; licence: {}", profile.url, profile.licence),
      fmt::format("this profile is tested on {}", profile.tested)};
  notes.insert(notes.end(), profile.notes.begin(), profile.notes.end());
  for (std::string& each : sequence_notes(benchmark)) notes.push_back(std::move(each));
  return notes;
}

std::string markdown(const DatasetBenchmark& benchmark) {
  std::string text =
      fmt::format("# {}\n\n{}\n", benchmark.profile.title, to_markdown(benchmark_table(benchmark)));
  for (const std::string& note : benchmark.notes) text += fmt::format("- {}\n", note);
  return text;
}

}  // namespace

Result<DatasetBenchmark> run_dataset_benchmark(DatasetProfile profile,
                                               std::vector<DatasetSequence> sequences,
                                               JobOptions options, const JobObserver& observer) {
  DatasetBenchmark benchmark{std::move(profile), std::move(sequences), {}, {}};
  const JobStore store(options.out);
  std::vector<Job> jobs;
  for (const DatasetSequence& sequence : benchmark.sequences) {
    auto scenario = std::make_shared<Scenario>();
    scenario->name = sequence.name;
    scenario->run = benchmark.profile.read.run;
    benchmark.suite.cases.push_back({*scenario, {}, {}});
    for (const std::string& text : scenario->run) {
      auto spec = parse_estimator_spec(text);
      if (!spec) return tl::unexpected(spec.error());
      const std::string id = id_of(benchmark.profile, sequence, *spec);
      benchmark.suite.jobs.push_back({scenario, 0, *spec, id});
      jobs.push_back(benchmark.suite.jobs.back());
      jobs.back().recorded = [&benchmark, &sequence, spec = *spec,
                              folder = store.outputs_of(id)](std::atomic<double>& part) {
        return result_of(benchmark.profile, sequence, spec, folder, part);
      };
    }
  }
  const auto claim = claim_store(options.out);
  if (!claim) return tl::unexpected(claim.error());
  const auto entered = store.enter(jobs, "", false);
  if (!entered) return tl::unexpected(entered.error());
  options.cache_limit = 0;  // the cache of simulated sequences stays as it is
  const auto run = JobRunner(std::move(options)).run(jobs, observer);
  if (!run) return tl::unexpected(run.error());
  benchmark.suite.run = *run;
  collect_suite(store, benchmark.suite);
  benchmark.suite.lead_score = benchmark.profile.score;
  benchmark.suite.lead_unit = benchmark.profile.unit;
  benchmark.notes = benchmark_notes(benchmark);
  return benchmark;
}

TextTable benchmark_table(const DatasetBenchmark& benchmark) {
  const DatasetProfile& profile = benchmark.profile;
  const std::vector<std::string> systems = systems_of(profile);
  const std::vector<std::string> labels = labels_of(profile.read.run);
  TextTable table;
  table.header = {"sequence"};
  table.header.insert(table.header.end(), labels.begin(), labels.end());
  for (const std::string& each : systems) table.header.push_back(each + " (published)");
  for (std::size_t i = 0; i < benchmark.sequences.size(); ++i) {
    const std::string& name = benchmark.sequences[i].name;
    table.rows.push_back({name});
    for (const std::string& label : labels) {
      table.rows.back().push_back(
          number_text(ours_in(benchmark.suite.cases[i], label, profile.score), "{:.3f}"));
    }
    for (const std::string& each : systems) {
      table.rows.back().push_back(number_text(published_in(profile, each, name), "{:.3f}"));
    }
  }
  return table;
}

std::string benchmark_score_text(const DatasetProfile& profile) {
  return fmt::format("{} [{}]: {}", profile.score, profile.unit, profile.score_text);
}

Json benchmark_json(const DatasetBenchmark& benchmark) {
  const DatasetProfile& profile = benchmark.profile;
  Json json = {{"schema", kBenchmarkSchema},
               {"version", AIMS_VERSION},
               {"profile", profile.name},
               {"title", profile.title},
               {"citation", profile.citation},
               {"url", profile.url},
               {"licence", profile.licence},
               {"tested", profile.tested},
               {"score", profile.score},
               {"unit", profile.unit},
               {"score_text", profile.score_text},
               {"better", better_of(profile.score) == Better::kLarger ? "larger" : "smaller"},
               {"published_source", profile.published_source},
               {"complete", benchmark.suite.complete},
               {"notes", benchmark.notes},
               {"sequences", Json::array()},
               {"failures", failures_json(benchmark.suite.failures)}};
  for (std::size_t i = 0; i < benchmark.sequences.size(); ++i) {
    json["sequences"].push_back(
        sequence_json(benchmark, benchmark.sequences[i], benchmark.suite.cases[i]));
  }
  return json;
}

Result<void> write_benchmark(const DatasetBenchmark& benchmark, const fs::path& folder) {
  if (auto written = write_suite(benchmark.suite, folder); !written) return written;
  return write_report(
      {.name = "benchmark", .markdown = markdown(benchmark), .json = benchmark_json(benchmark)},
      folder);
}

}  // namespace aims
