// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include "lab/fidelity/fidelity.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/csv.hpp"

namespace aims {
namespace {

const char* name_of(FootModel model) { return model == FootModel::kPoint ? "point" : "rolling"; }

}  // namespace

TextTable allan_table(const std::vector<StandingDeviation>& allan) {
  TextTable table;
  table.header = {"averaging time [s]", "gyro [rad/s]", "accelerometer [m/s^2]"};
  for (const StandingDeviation& each : allan) {
    table.rows.push_back({fmt::format("{:g}", each.tau), fmt::format("{:.2e}", each.gyro),
                          fmt::format("{:.2e}", each.accelerometer)});
  }
  return table;
}

TextTable range_table(const std::vector<ResidualBin>& bins) {
  TextTable table;
  table.header = {"range [m]", "incidence [deg]",         "returns",
                  "mean [mm]", "standard deviation [mm]", "beyond 10 cm [%]"};
  for (const ResidualBin& each : bins) {
    table.rows.push_back(
        {fmt::format("{:g}-{:g}", each.range_begin, each.range_end),
         fmt::format("{:g}-{:g}", each.incidence_begin_deg, each.incidence_end_deg),
         fmt::format("{}", each.returns), fmt::format("{:.1f}", 1e3 * each.mean),
         fmt::format("{:.1f}", 1e3 * each.std), fmt::format("{:.2f}", 100.0 * each.share_beyond)});
  }
  return table;
}

TextTable leg_drift_table(const std::vector<LegDrift>& legs) {
  TextTable table;
  table.header = {"foot model", "contact from [N]", "segment", "distance [%]", "heading [deg]"};
  for (const LegDrift& each : legs) {
    table.rows.push_back({name_of(each.foot_model), fmt::format("{:g}", each.contact_on),
                          each.segment, fmt::format("{:+.2f}", each.signed_percent),
                          fmt::format("{:+.2f}", each.heading_deg)});
  }
  return table;
}

namespace {

/// The report in Markdown.
std::string report_of(const Fidelity& fidelity) {
  return fmt::format(
      "# Sensors of {}, seed {}\n\n"
      "## IMU while trotting\n\nPoint samples at 400 Hz; real: the body IMU of a Unitree "
      "Go1.\n\n{}\n"
      "## IMU while standing\n\n{}\n"
      "## Allan deviation of the standing IMU\n\nRoot mean square over the axes.\n\n{}\n"
      "## LiDAR\n\nMeasured range minus the range to the true surface.\n\n{}\n"
      "## Leg odometry\n\nBelow zero: reads short. Heading: change of its error.\n\n{}\n"
      "## Stance\n\nReal: a Unitree Go1 under motion capture; the simulated robot has its "
      "gait.\n\n{}\n{}",
      fidelity.scenario, fidelity.seed, to_markdown(imu_statistics_table(fidelity.trot)),
      to_markdown(imu_statistics_table(fidelity.standing)),
      to_markdown(allan_table(fidelity.allan)), to_markdown(range_table(fidelity.ranges)),
      to_markdown(leg_drift_table(fidelity.legs)),
      to_markdown(stance_profile_table(fidelity.stance)),
      to_markdown(stance_agreement_table(stance_agreement(fidelity.stance))));
}

CsvTable stance_csv(const std::vector<StanceBin>& profile) {
  CsvTable table({"event", "time_s", "slip_mps", "real_slip_mps", "height_m", "real_height_m",
                  "load", "real_load", "slip_over_tolerance", "height_over_tolerance",
                  "load_over_tolerance"});
  for (const StanceBin& bin : profile) {
    table.add(bin.event == StanceEvent::kTouchdown ? "touchdown" : "lift_off").add(bin.time);
    table.add(bin.simulated.slip).add(bin.real.slip);
    table.add(bin.simulated.height).add(bin.real.height);
    table.add(bin.simulated.load).add(bin.real.load);
    for (const double each : stance_deviation(bin)) table.add(each);
    table.end_row();
  }
  return table;
}

}  // namespace

Result<void> write_fidelity(const Fidelity& fidelity, const std::filesystem::path& folder) {
  CsvTable imu({"state", "quantity", "axis", "unit", "simulated", "real_low", "real_high"});
  const auto add = [&imu](const char* state, const std::vector<ImuStatistic>& statistics) {
    for (const ImuStatistic& each : statistics) {
      imu.add(state).add(each.quantity).add(std::string(1, each.axis)).add(each.unit);
      imu.add(each.simulated).add(each.real_low).add(each.real_high).end_row();
    }
  };
  add("trot", fidelity.trot);
  add("standing", fidelity.standing);
  CsvTable allan({"tau_s", "gyro_radps", "accelerometer_mps2"});
  for (const StandingDeviation& each : fidelity.allan) {
    allan.add(each.tau).add(each.gyro).add(each.accelerometer).end_row();
  }
  CsvTable ranges({"range_begin_m", "range_end_m", "incidence_begin_deg", "incidence_end_deg",
                   "returns", "mean_m", "std_m", "share_beyond"});
  for (const ResidualBin& each : fidelity.ranges) {
    ranges.add(each.range_begin).add(each.range_end);
    ranges.add(each.incidence_begin_deg).add(each.incidence_end_deg).add(each.returns);
    ranges.add(each.mean).add(each.std).add(each.share_beyond).end_row();
  }
  CsvTable legs({"foot_model", "contact_on_n", "segment", "distance_percent", "heading_deg"});
  for (const LegDrift& each : fidelity.legs) {
    legs.add(name_of(each.foot_model)).add(each.contact_on).add(each.segment);
    legs.add(each.signed_percent).add(each.heading_deg).end_row();
  }
  if (auto ok = write_csv(folder / "imu.csv", imu); !ok) return ok;
  if (auto ok = write_csv(folder / "allan.csv", allan); !ok) return ok;
  if (auto ok = write_csv(folder / "leg_drift.csv", legs); !ok) return ok;
  if (auto ok = write_csv(folder / "ranges.csv", ranges); !ok) return ok;
  if (auto ok = write_csv(folder / "stance.csv", stance_csv(fidelity.stance)); !ok) return ok;
  return write_file_atomically(folder / "fidelity.md", report_of(fidelity));
}

}  // namespace aims
