// SPDX-License-Identifier: BSD-3-Clause
#include "bench/studies/stream_faults.hpp"

#include <fmt/format.h>

#include <limits>
#include <memory>
#include <optional>
#include <utility>

#include "core/random.hpp"

namespace aims {
namespace {

constexpr double kGravity = 9.81;  ///< [m/s^2]
constexpr const char* kSensorNames[] = {"imu", "legs", "lidar"};

/// Changes a measurement that the fault hits; false: it is lost.
using Change = std::function<bool(Delivery&)>;

int sensor_of(const Delivery& delivery) { return static_cast<int>(delivery.measurement.index()); }

/// Scans are shared with other streams: a changed one is a copy.
void change_scan(Delivery& delivery, const std::function<void(LidarScan&)>& change) {
  auto scan = std::make_shared<LidarScan>(*std::get<LidarScanPtr>(delivery.measurement));
  change(*scan);
  delivery.measurement = LidarScanPtr(std::move(scan));
}

void shift_stamp(Delivery& delivery, Duration shift) {
  if (auto* imu = std::get_if<ImuSample>(&delivery.measurement)) imu->stamp += shift;
  if (auto* legs = std::get_if<LegOdometrySample>(&delivery.measurement)) legs->stamp += shift;
  if (sensor_of(delivery) != 2) return;
  change_scan(delivery, [shift](LidarScan& scan) {
    scan.stamp += shift;
    scan.end += shift;
  });
}

/// A fault that changes the measurements of one sensor within the window, or from its begin on.
StreamFault changing(std::string name, std::string meaning, int sensor, bool permanent,
                     Change change) {
  auto make = [sensor, permanent, change = std::move(change)](const FaultWindow& window,
                                                              std::uint64_t /*seed*/) {
    return [=](const Delivery& delivery, std::vector<Delivery>& out) {
      const bool hit = sensor_of(delivery) == sensor && delivery.arrival >= window.begin &&
                       (permanent || delivery.arrival < window.end);
      Delivery changed = delivery;
      if (!hit || change(changed)) out.push_back(std::move(changed));
    };
  };
  return {std::move(name), std::move(meaning), false, std::move(make)};
}

/// The same over the whole stream.
StreamFault calibration(std::string name, std::string meaning, int sensor, Change change) {
  StreamFault fault =
      changing(std::move(name), std::move(meaning), sensor, true, std::move(change));
  fault.always = true;
  return fault;
}

void add_losses(std::vector<StreamFault>& faults) {
  for (int sensor = 0; sensor < 3; ++sensor) {
    for (const int percent : {5, 20, 50}) {
      auto make = [=](const FaultWindow& window, std::uint64_t seed) -> FaultTransform {
        auto random = std::make_shared<RandomStream>(seed, fmt::format("fault.loss.{}", sensor));
        return [=](const Delivery& delivery, std::vector<Delivery>& out) {
          const bool lost = sensor_of(delivery) == sensor && delivery.arrival >= window.begin &&
                            random->uniform() < 0.01 * percent;
          if (!lost) out.push_back(delivery);
        };
      };
      faults.push_back({fmt::format("{}.loss_{}", kSensorNames[sensor], percent),
                        fmt::format("{} % of the packets lost at random", percent), false, make});
    }
  }
}

/// Packets of the sensor wait up to that long; they overtake each other.
void add_delays(std::vector<StreamFault>& faults) {
  for (int sensor = 0; sensor < 3; ++sensor) {
    for (const int ms : {20, 100, 300}) {
      auto make = [=](const FaultWindow& window, std::uint64_t seed) -> FaultTransform {
        auto random = std::make_shared<RandomStream>(seed, fmt::format("fault.delay.{}", sensor));
        auto waiting = std::make_shared<std::vector<Delivery>>();
        return [=](const Delivery& delivery, std::vector<Delivery>& out) {
          std::erase_if(*waiting, [&](Delivery& each) {
            if (each.arrival > delivery.arrival) return false;
            out.push_back(std::move(each));
            return true;
          });
          if (sensor_of(delivery) != sensor || delivery.arrival < window.begin) {
            out.push_back(delivery);
            return;
          }
          waiting->push_back(delivery);
          waiting->back().arrival += static_cast<Duration>(random->uniform() * ms * kMillisecond);
        };
      };
      faults.push_back({fmt::format("{}.delay_{}ms", kSensorNames[sensor], ms),
                        fmt::format("packets delayed by up to {} ms, out of order", ms), false,
                        make});
    }
  }
}

void add_deaths(std::vector<StreamFault>& faults) {
  const Change lose = [](Delivery&) { return false; };
  for (int sensor = 0; sensor < 3; ++sensor) {
    const std::string name = kSensorNames[sensor];
    faults.push_back(changing(name + ".dead_10s", "silent for 10 s", sensor, false, lose));
    faults.push_back(changing(name + ".dead", "silent from then on", sensor, true, lose));
  }
}

void add_clock_jumps(std::vector<StreamFault>& faults) {
  for (int sensor = 0; sensor < 3; ++sensor) {
    for (const double jump : {-10.0, -1.0, -0.1, 0.1, 1.0, 10.0}) {
      faults.push_back(changing(fmt::format("{}.clock_{:+g}s", kSensorNames[sensor], jump),
                                "its stamps jump by that from then on", sensor, true,
                                [jump](Delivery& delivery) {
                                  shift_stamp(delivery, from_seconds(jump));
                                  return true;
                                }));
    }
    auto make = [=](const FaultWindow& window, std::uint64_t /*seed*/) -> FaultTransform {
      auto done = std::make_shared<bool>(false);
      return [=](const Delivery& delivery, std::vector<Delivery>& out) {
        out.push_back(delivery);
        if (*done || sensor_of(delivery) != sensor || delivery.arrival < window.begin) return;
        *done = true;
        shift_stamp(out.back(), 3 * kSecond);
      };
    };
    faults.push_back({fmt::format("{}.stamp_+3s", kSensorNames[sensor]), "a single stamp 3 s ahead",
                      false, make});
  }
}

void add_order(std::vector<StreamFault>& faults) {
  faults.push_back({"all.twice", "each message arrives twice", false,
                    [](const FaultWindow& window, std::uint64_t /*seed*/) -> FaultTransform {
                      return [=](const Delivery& delivery, std::vector<Delivery>& out) {
                        out.push_back(delivery);
                        if (delivery.arrival >= window.begin) out.push_back(delivery);
                      };
                    }});
  faults.push_back({"all.swapped", "neighbouring messages change places", false,
                    [](const FaultWindow& window, std::uint64_t /*seed*/) -> FaultTransform {
                      auto first = std::make_shared<std::optional<Delivery>>();
                      return [=](const Delivery& delivery, std::vector<Delivery>& out) {
                        if (delivery.arrival < window.begin) return out.push_back(delivery);
                        if (!*first) {
                          *first = delivery;
                          return;
                        }
                        const Time arrival = delivery.arrival;
                        out.push_back(delivery);
                        out.push_back(**first);
                        out.back().arrival = arrival;
                        first->reset();
                      };
                    }});
}

/// A value that replaces every component of one field.
void add_values(std::vector<StreamFault>& faults) {
  const std::pair<const char*, double> values[] = {
      {"nan", std::numeric_limits<double>::quiet_NaN()},
      {"inf", std::numeric_limits<double>::infinity()},
      {"huge", 1e6}};
  using Set = std::function<void(Delivery&, double)>;
  const auto imu = [](Delivery& d) -> ImuSample& { return std::get<ImuSample>(d.measurement); };
  const auto legs = [](Delivery& d) -> LegOdometrySample& {
    return std::get<LegOdometrySample>(d.measurement);
  };
  const std::tuple<int, const char*, Set> fields[] = {
      {0, "angular_velocity",
       [=](Delivery& d, double v) { imu(d).angular_velocity.setConstant(v); }},
      {0, "specific_force", [=](Delivery& d, double v) { imu(d).specific_force.setConstant(v); }},
      {1, "linear_velocity",
       [=](Delivery& d, double v) { legs(d).linear_velocity.setConstant(v); }},
      {1, "angular_velocity",
       [=](Delivery& d, double v) { legs(d).angular_velocity.setConstant(v); }},
      {1, "pose", [=](Delivery& d, double v) { legs(d).T_odom_base.translation.setConstant(v); }},
      {1, "joints", [=](Delivery& d, double v) { legs(d).joint_position.fill(v); }},
      {2, "points", [](Delivery& d, double v) {
         change_scan(d, [v](LidarScan& scan) {
           for (LidarPoint& point : scan.points) point.position.setConstant(static_cast<float>(v));
         });
       }}};
  for (const auto& [sensor, field, set] : fields) {
    for (const auto& [name, value] : values) {
      faults.push_back(changing(fmt::format("{}.{}_{}", kSensorNames[sensor], field, name),
                                "that value in the field for 10 s", sensor, false,
                                [set = set, value = value](Delivery& delivery) {
                                  set(delivery, value);
                                  return true;
                                }));
    }
  }
}

void add_scans(std::vector<StreamFault>& faults) {
  const Change empty = [](Delivery& delivery) {
    change_scan(delivery, [](LidarScan& scan) { scan.points.clear(); });
    return true;
  };
  faults.push_back(changing("lidar.empty_10s", "scans without points for 10 s", 2, false, empty));
  faults.push_back(changing("lidar.empty", "scans without points from then on", 2, true, empty));
}

Change moved_by(const Pose& T) {
  return [T](Delivery& delivery) {
    change_scan(delivery, [&T](LidarScan& scan) {
      for (LidarPoint& point : scan.points) {
        point.position = (T * point.position.cast<double>().eval()).cast<float>();
      }
    });
    return true;
  };
}

Pose turned(double degrees, const Eigen::Vector3d& axis) {
  const double angle = degrees * M_PI / 180.0;
  return {Eigen::Quaterniond(Eigen::AngleAxisd(angle, axis)), Eigen::Vector3d::Zero()};
}

void add_calibration(std::vector<StreamFault>& faults) {
  using Eigen::Vector3d;
  faults.push_back(calibration("lidar.yaw_180", "LiDAR mounted backwards", 2,
                               moved_by(turned(180.0, Vector3d::UnitZ()))));
  faults.push_back(calibration("lidar.yaw_5", "extrinsic wrong by 5 degrees of yaw", 2,
                               moved_by(turned(5.0, Vector3d::UnitZ()))));
  faults.push_back(calibration("lidar.pitch_5", "extrinsic wrong by 5 degrees of pitch", 2,
                               moved_by(turned(5.0, Vector3d::UnitY()))));
  faults.push_back(
      calibration("lidar.lever_10cm", "extrinsic wrong by 10 cm forward", 2,
                  moved_by({Eigen::Quaterniond::Identity(), Vector3d(0.1, 0.0, 0.0)})));
  const auto change_imu = [](const std::function<void(ImuSample&)>& change) -> Change {
    return [change](Delivery& delivery) {
      change(std::get<ImuSample>(delivery.measurement));
      return true;
    };
  };
  faults.push_back(calibration("imu.force_in_g", "specific force in g", 0,
                               change_imu([](ImuSample& s) { s.specific_force /= kGravity; })));
  faults.push_back(
      calibration("imu.rate_in_degrees", "angular velocity in degrees per second", 0,
                  change_imu([](ImuSample& s) { s.angular_velocity *= 180.0 / M_PI; })));
  faults.push_back(calibration("imu.no_gravity", "gravity removed from the specific force", 0,
                               change_imu([](ImuSample& s) { s.specific_force.z() -= kGravity; })));
}

}  // namespace

std::vector<StreamFault> stream_faults() {
  std::vector<StreamFault> faults;
  faults.push_back({"none", "the stream as it is", false,
                    [](const FaultWindow&, std::uint64_t) -> FaultTransform {
                      return [](const Delivery& delivery, std::vector<Delivery>& out) {
                        out.push_back(delivery);
                      };
                    }});
  add_losses(faults);
  add_delays(faults);
  add_deaths(faults);
  add_clock_jumps(faults);
  add_order(faults);
  add_values(faults);
  add_scans(faults);
  add_calibration(faults);
  return faults;
}

}  // namespace aims
