// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/record.hpp"

#include <fmt/format.h>

#include <utility>
#include <variant>
#include <vector>

#include "bench/estimate/new_recording.hpp"
#include "bench/estimate/stream.hpp"
#include "bench/run/code_version.hpp"
#include "bench/run/sequence.hpp"
#include "bench/scoring/tables.hpp"
#include "core/attitude_filter.hpp"
#include "core/files/tum.hpp"
#include "core/stopwatch.hpp"
#include "recordings/stream/recording_writer.hpp"
#include "sim/sensors/scan_pattern.hpp"
#include "sim/simulation.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr int kThreads = 2;  ///< the recording does not depend on it

/// Puts the simulation's three outputs into one bag, in order of time within a batch.
class Recorder {
 public:
  explicit Recorder(RecordingWriter writer) : writer_(std::move(writer)) {}

  Result<void> write(const std::vector<Delivery>& deliveries, const std::vector<ImuSample>& fast,
                     const Truth& truth) {
    auto fast_next = fast.begin();
    for (const Delivery& delivery : deliveries) {
      if (auto ok = write_truth_until(delivery.arrival, truth); !ok) return ok;
      for (; fast_next != fast.end() && fast_next->stamp <= delivery.arrival; ++fast_next) {
        if (auto ok = write_fast(*fast_next); !ok) return ok;
      }
      if (auto ok = write_delivery(delivery); !ok) return ok;
    }
    for (; fast_next != fast.end(); ++fast_next) {
      if (auto ok = write_fast(*fast_next); !ok) return ok;
    }
    return write_truth_until(truth.samples.back().stamp, truth);
  }

  RecordingWriter& writer() { return writer_; }

 private:
  Result<void> write_fast(ImuSample sample) {
    sample.orientation = fast_attitude_.update(sample);
    return writer_.write_imu(ImuOutput::kFast, sample.stamp, sample);
  }

  Result<void> write_delivery(const Delivery& delivery) {
    if (const auto* imu = std::get_if<ImuSample>(&delivery.measurement)) {
      ImuSample sample = *imu;
      sample.orientation = attitude_.update(sample);
      return writer_.write_imu(ImuOutput::kMain, delivery.arrival, sample);
    }
    if (const auto* legs = std::get_if<LegOdometrySample>(&delivery.measurement)) {
      return writer_.write_legs(delivery.arrival, *legs);
    }
    return writer_.write_scan(delivery.arrival, *std::get<LidarScanPtr>(delivery.measurement));
  }

  Result<void> write_truth_until(Time until, const Truth& truth) {
    for (; truth_next_ < truth.samples.size(); ++truth_next_) {
      const TruthSample& each = truth.samples[truth_next_];
      if (each.stamp > until) return {};
      if (each.stamp < truth_due_) continue;
      truth_due_ = each.stamp + kTruthSpacing;
      const BodyMotion motion = {each.stamp, each.T_world_body, each.velocity,
                                 each.angular_velocity};
      if (auto ok = writer_.write_truth(motion); !ok) return ok;
    }
    return {};
  }

  RecordingWriter writer_;
  AttitudeFilter attitude_;
  AttitudeFilter fast_attitude_;
  std::size_t truth_next_ = 0;
  Time truth_due_ = 0;
};

/// What the bag holds of its origin: the configuration that repeats it.
std::string origin_text(const Scenario& scenario, std::uint64_t seed) {
  return fmt::format("# aims {}, code {}, scenario {}, seed {}\n{}", AIMS_VERSION, code_version(),
                     scenario.name, seed, effective_config(scenario, seed));
}

/// `recording` with another extension: walk.bag or walk/ -> walk.truth.tum.
fs::path beside(const fs::path& recording, const char* extension) {
  if (!recording.has_filename()) return path_of_new(recording) += extension;
  fs::path file = recording;
  return file.replace_extension(extension);
}

/// What went wrong, and where the recording up to then is.
tl::unexpected<Error> kept(const fs::path& partial, const Error& error) {
  return failure(
      fmt::format("{}; what was recorded until then is in {}", error.message, partial.string()));
}

/// Simulates to the end or until the observer stops it, and closes the bag.
Result<void> fill(Simulation& simulation, Recorder& recorder, const Observer& observer,
                  const Stopwatch& stopwatch, RecordOutcome& outcome) {
  outcome.complete = true;
  std::vector<Delivery> deliveries;
  const double expected_s = to_seconds(simulation.expected_duration());
  for (bool moving = true; moving && outcome.complete;) {
    deliveries.clear();
    moving = simulation.advance(kStreamBatch, deliveries);
    auto ok = recorder.write(deliveries, simulation.take_fast_imu(), simulation.truth());
    if (!ok) return ok;
    outcome.complete = observer({to_seconds(simulation.now()), expected_s, stopwatch.seconds()});
  }
  const CsvTable waypoint_times = waypoint_times_table(simulation.truth().waypoint_times);
  auto ok = recorder.writer().write_waypoint_times(simulation.now(), waypoint_times.text());
  if (ok) ok = recorder.writer().close();
  return ok;
}

}  // namespace

Result<RecordOutcome> record(const Scenario& given, const RecordOptions& options,
                             const Observer& observer) {
  const Stopwatch stopwatch;
  const auto format = format_of_new(options.bag);
  if (!format) return tl::unexpected(format.error());
  const Scenario scenario = scenario_of_seed(given, options.seed);
  auto simulation = Simulation::create(scenario.simulation, options.seed, kThreads);
  if (!simulation) return tl::unexpected(located(scenario, simulation.error()));
  const auto partial = begin_recording(path_of_new(options.bag), options.overwrite);
  if (!partial) return tl::unexpected(partial.error());
  auto file = create_recording(*partial, *format, {.compression = options.compression});
  if (!file) return tl::unexpected(file.error());
  auto writer = RecordingWriter::create(std::move(*file), simulation->rig(),
                                        origin_text(scenario, options.seed));
  if (!writer) return tl::unexpected(writer.error());

  writer->set_cloud_format(cloud_format(scenario.simulation.lidar));
  Recorder recorder(std::move(*writer));
  RecordOutcome outcome;
  auto ok = fill(*simulation, recorder, observer, stopwatch, outcome);
  if (ok) ok = publish_recording(*partial, path_of_new(options.bag));
  if (!ok) return kept(*partial, ok.error());
  const Truth& truth = simulation->truth();
  outcome.truth = beside(options.bag, ".truth.tum");
  outcome.waypoint_times = beside(options.bag, ".waypoint_times.csv");
  ok = write_tum(outcome.truth, thinned(body_trajectory(truth), kTruthSpacing));
  if (ok) ok = write_csv(outcome.waypoint_times, waypoint_times_table(truth.waypoint_times));
  if (!ok) return tl::unexpected(ok.error());
  outcome.simulated_s = to_seconds(simulation->now());
  outcome.walk = truth.walk;
  outcome.left_out = recorder.writer().dropped();
  outcome.bag_bytes = recording_size(options.bag);
  outcome.wall_s = stopwatch.seconds();
  return outcome;
}

}  // namespace aims
