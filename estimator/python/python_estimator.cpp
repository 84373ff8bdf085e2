// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/python/python_estimator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

#include "estimator/python/python_process.hpp"

namespace aims {
namespace {

/// Measurements that wait for the next scan, at most: bounds what a gap between scans collects.
constexpr std::size_t kMaxWaiting = 2'000;
/// Deviation of R^T R from identity up to which a matrix is taken for a rotation, as in files.
constexpr double kRotationTolerance = 1e-3;
/// A pose may be stamped so much before or after all measurements [ns].
constexpr double kStampMargin = 10e9;
constexpr std::string_view kCallTimeoutKey = "call_timeout";

enum class Event : std::uint8_t { kImu = 1, kLegs = 2, kScan = 3 };

/// "module" and "Class" of "python:module.Class".
std::pair<std::string, std::string> parts_of(std::string_view name) {
  const std::string_view path = name.substr(kPythonPrefix.size());
  const std::size_t dot = path.rfind('.');
  if (dot == std::string_view::npos) return {std::string(path), ""};
  return {std::string(path.substr(0, dot)), std::string(path.substr(dot + 1))};
}

/// Starts a process and imports the class; yields what it says of it.
Result<std::vector<std::byte>> greet(PythonProcess& process, std::string_view name,
                                     double limit_s) {
  if (auto started = process.start(); !started) return tl::unexpected(started.error());
  const auto [module, kind] = parts_of(name);
  PipeMessage hello;
  for (const std::string& text : {std::to_string(kPythonProtocol), module, kind}) {
    hello.add_text(text);
  }
  return process.ask(PythonRequest::kHello, hello.bytes(), limit_s);
}

/// Measurements on their way to the process, sorted by kind, and their order.
class Batch {
 public:
  void add(Time arrival, const ImuSample& sample) {
    order_.push_back(Event::kImu);
    imu_.add(arrival);
    imu_.add(sample.stamp);
    add_vector(imu_, sample.specific_force);
    add_vector(imu_, sample.angular_velocity);
    imu_.add(sample.orientation ? 1.0 : 0.0);
    const Eigen::Quaterniond q = sample.orientation.value_or(Eigen::Quaterniond::Identity());
    for (const double value : {q.x(), q.y(), q.z(), q.w()}) imu_.add(value);
  }

  void add(Time arrival, const LegOdometrySample& sample) {
    order_.push_back(Event::kLegs);
    legs_.add(arrival);
    legs_.add(sample.stamp);
    legs_.add_pose(sample.T_odom_base);
    add_vector(legs_, sample.linear_velocity);
    add_vector(legs_, sample.angular_velocity);
    for (const double value : sample.joint_position) legs_.add(value);
    for (const double value : sample.joint_velocity) legs_.add(value);
    for (const bool value : sample.contact) legs_.add(value ? 1.0 : 0.0);
  }

  void add(Time arrival, const LidarScan& scan, const SharedMemory::Part& part) {
    order_.push_back(Event::kScan);
    for (const Time time : {arrival, scan.stamp, scan.end}) scans_.add(time);
    scans_.add(std::uint64_t{scan.points.size()});
    scans_.add(part.offset);
    scans_.add(part.capacity);
  }

  std::size_t size() const { return order_.size(); }

  /// The message of what was added; then empty.
  PipeMessage take() {
    PipeMessage message;
    for (const Event kind : {Event::kImu, Event::kLegs, Event::kScan}) {
      message.add(static_cast<std::uint64_t>(std::ranges::count(order_, kind)));
    }
    message.add(std::uint64_t{order_.size()});
    for (const Event each : order_) message.add(each);
    message.pad_to_eight();
    for (PipeMessage* part : {&imu_, &legs_, &scans_}) {
      message.append(part->bytes());
      part->clear();
    }
    order_.clear();
    return message;
  }

 private:
  static void add_vector(PipeMessage& bytes, const Eigen::Vector3d& vector) {
    for (int axis = 0; axis < 3; ++axis) bytes.add(vector[axis]);
  }

  std::vector<Event> order_;
  PipeMessage imu_;
  PipeMessage legs_;
  PipeMessage scans_;
};

/// A pose of the process; none when its matrix is no rigid transform.
std::optional<Pose> pose_in(MessageCursor& cursor) {
  Eigen::Matrix4d matrix;
  for (int row = 0; row < 4; ++row) {
    for (int at = 0; at < 4; ++at) matrix(row, at) = cursor.take<double>();
  }
  const Eigen::Matrix3d R = matrix.topLeftCorner<3, 3>();
  const bool rigid = matrix.allFinite() && R.determinant() > 0.0 &&
                     (R.transpose() * R - Eigen::Matrix3d::Identity()).norm() < kRotationTolerance;
  if (!rigid) return std::nullopt;
  return Pose{Eigen::Quaterniond(R).normalized(), matrix.topRightCorner<3, 1>()};
}

/// While a whole number has no value.
constexpr int kNoInteger = std::numeric_limits<int>::min();

/// The parameter of a value.
void describe_value(Fields& fields, std::string_view key, PythonValue& value, Spec spec) {
  if (auto* text = std::get_if<std::string>(&value)) fields.text(key, *text, std::move(spec));
  if (auto* flag = std::get_if<bool>(&value)) fields.flag(key, *flag, std::move(spec));
  if (auto* integer = std::get_if<int>(&value)) fields.integer(key, *integer, std::move(spec));
  if (auto* number = std::get_if<double>(&value)) fields.number(key, *number, std::move(spec));
}

/// Whether the value is one.
bool is_given(const PythonValue& value) {
  if (const auto* text = std::get_if<std::string>(&value)) return !text->empty();
  if (const auto* number = std::get_if<double>(&value)) return !std::isnan(*number);
  return value != PythonValue(kNoInteger);
}

/// The text of which worker.py makes the value.
std::string text_of(const PythonValue& value) {
  return std::visit([](const auto& each) { return fmt::format("{}", each); }, value);
}

/// The value that worker.py describes by type and text. Error for a text that is none of that type.
Result<PythonValue> value_of(const std::string& type, const std::string& text, bool is_given) {
  PythonValue value;
  if (type == "float") value = std::nan("");
  if (type == "int") value = kNoInteger;
  if (type == "bool") value = false;
  if (!is_given) return value;
  Fields fields;
  describe_value(fields, "value", value, {});
  if (auto done = assign(fields, "value", text); !done) return tl::unexpected(done.error());
  return value;
}

/// The keyword that a message describes next.
Result<PythonSetting> setting_in(MessageCursor& cursor) {
  PythonSetting setting;
  setting.key = cursor.take_text();
  const std::string type = cursor.take_text();
  const std::string text = cursor.take_text();
  const bool has_default = cursor.take_text() == "1";
  auto value = value_of(type, text, has_default);
  if (!value) return failure(fmt::format("{}: {}", setting.key, value.error().message));
  setting.value = std::move(*value);
  if (has_default) setting.standard = setting.value;
  return setting;
}

class PythonEstimator final : public Estimator {
 public:
  PythonEstimator(const PythonConfig& config, const SensorRig& rig)
      : name_(config.name()),
        limit_s_(config.call_timeout()),
        takes_imu_(config.has("add_imu")),
        takes_legs_(config.has("add_legs")),
        takes_scans_(config.has("add_scan")) {
    auto ready = greet(process_, name_, limit_s_);
    if (ready) ready = ask(PythonRequest::kCreate, creation(config, rig).bytes());
    if (!ready) fail(ready.error());
  }

  void consume(const Delivery& delivery) override {
    if (result_.failure) return;
    note_times(delivery);
    std::visit([&](const auto& measurement) { add(delivery.arrival, measurement); },
               delivery.measurement);
    if (batch_.size() >= kMaxWaiting) flush();
  }

  void finish() override {
    if (!result_.failure && batch_.size() > 0) flush();
    if (result_.failure) return;
    const auto answer = ask(PythonRequest::kFinish, {});
    if (!answer) return fail_after_poses(answer.error());
    MessageCursor cursor(*answer);
    take_poses(cursor);
    const auto count = cursor.take<std::uint64_t>();
    if (count * sizeof(Eigen::Vector3f) != cursor.left()) return fail({"answered with no map"});
    map_.resize(count);
    for (Eigen::Vector3f& point : map_) {
      for (int axis = 0; axis < 3; ++axis) point[axis] = cursor.take<float>();
    }
  }

  const EstimatorResult& result() const override { return result_; }
  std::vector<Eigen::Vector3f> map_points() const override { return map_; }

 private:
  static PipeMessage creation(const PythonConfig& config, const SensorRig& rig) {
    PipeMessage bytes;
    bytes.add_pose(rig.T_body_lidar);
    bytes.add_pose(rig.T_body_base);
    bytes.add(rig.imu_rate_hz);
    bytes.add(rig.leg_rate_hz);
    for (const PythonSetting& each : config.settings()) {
      if (each.standard == each.value) continue;
      bytes.add_text(each.key);
      bytes.add_text(text_of(each.value));
    }
    return bytes;
  }

  void note_times(const Delivery& delivery) {
    const Time stamp = stamp_of(delivery.measurement);
    first_ = std::min({first_, stamp, delivery.arrival});
    last_ = std::max({last_, stamp, delivery.arrival});
  }

  /// Whether a pose of this stamp can be one of the measurements so far. Others, as of an
  /// estimator that counts in another unit, would spoil what is written and drawn of all.
  bool is_measured(Time stamp) const {
    const auto ns = static_cast<double>(stamp);  // whose differences cannot overflow
    return ns >= static_cast<double>(first_) - kStampMargin &&
           ns <= static_cast<double>(last_) + kStampMargin;
  }

  void add(Time arrival, const ImuSample& sample) {
    if (takes_imu_) batch_.add(arrival, sample);
  }
  void add(Time arrival, const LegOdometrySample& sample) {
    if (takes_legs_) batch_.add(arrival, sample);
  }
  void add(Time arrival, const LidarScanPtr& scan) {
    if (!takes_scans_) return flush();
    const auto part = process_.memory().put(scan->points);
    if (!part) return fail(part.error());
    batch_.add(arrival, *scan, *part);
    flush();
  }

  /// Hands what waits to the process, and takes its poses.
  void flush() {
    if (batch_.size() == 0) return;
    const auto answer = ask(PythonRequest::kMeasure, batch_.take().bytes());
    if (!answer) return fail_after_poses(answer.error());
    MessageCursor cursor(*answer);
    take_poses(cursor);
    if (cursor.is_short()) fail({"answered with too few bytes"});
  }

  void take_poses(MessageCursor& cursor) {
    result_.external_cpu_s += to_seconds(cursor.take<Duration>());
    const auto poses = cursor.take<std::uint64_t>();
    const auto retained = cursor.take<std::uint64_t>();
    for (std::uint64_t i = 0; i < poses && !cursor.at_end(); ++i) {
      const auto stamp = cursor.take<Time>();
      keep(stamp, pose_in(cursor));
    }
    std::vector<std::uint64_t> offsets;
    for (std::uint64_t i = 0; i < retained && !cursor.at_end(); ++i) {
      offsets.push_back(cursor.take<std::uint64_t>());
    }
    process_.memory().keep(offsets);
  }

  void keep(Time stamp, const std::optional<Pose>& pose) {
    Trajectory& trajectory = result_.trajectory;
    if (!pose) {
      ++result_.counts["pose_not_rigid"];
    } else if (!is_measured(stamp)) {
      ++result_.counts["pose_stamp_not_measured"];
    } else if (!trajectory.empty() && stamp <= trajectory.back().stamp) {
      ++result_.counts["pose_stamp_not_increasing"];
    } else {
      trajectory.push_back({stamp, *pose});
    }
  }

  Result<std::vector<std::byte>> ask(PythonRequest request, std::span<const std::byte> content) {
    return process_.ask(request, content, limit_s_);
  }

  /// Keeps the poses of the calls before the one that failed.
  void fail_after_poses(const Error& error) {
    MessageCursor cursor(process_.yielded());
    take_poses(cursor);
    fail(error);
  }

  void fail(const Error& error) {
    result_.failure = Error{fmt::format("{}: {}", name_, error.message)};
  }

  std::string name_;
  double limit_s_;
  bool takes_imu_;
  bool takes_legs_;
  bool takes_scans_;
  PythonProcess process_;
  Batch batch_;
  Time first_ = std::numeric_limits<Time>::max();  ///< of stamps and arrivals so far
  Time last_ = std::numeric_limits<Time>::min();
  EstimatorResult result_;
  std::vector<Eigen::Vector3f> map_;
};

}  // namespace

Result<void> check_python_name(std::string_view name) {
  const auto [module, kind] = parts_of(name);
  const auto is_word = [](std::string_view text, std::string_view also) {
    return !text.empty() && std::ranges::all_of(text, [&](char c) {
      return std::isalnum(static_cast<unsigned char>(c)) != 0 || also.find(c) != also.npos;
    });
  };
  if (is_word(module, "_.") && is_word(kind, "_")) return {};
  return failure(
      fmt::format("'{}': expected python:module.Class, e.g. python:my_package.Mine", name));
}

Result<PythonConfig> PythonConfig::load(std::string_view name, double limit_s) {
  if (auto right = check_python_name(name); !right) return tl::unexpected(right.error());
  PythonProcess process;
  const auto described = greet(process, name, limit_s);
  if (!described) return failure(fmt::format("{}: {}", name, described.error().message));
  MessageCursor cursor(*described);
  PythonConfig config;
  config.name_ = name;
  config.found_hash_ = config.code_hash_ = cursor.take_text();
  const std::string methods = cursor.take_text();
  for (std::size_t begin = 0; begin <= methods.size();) {
    const std::size_t end = std::min(methods.find(',', begin), methods.size());
    config.methods_.push_back(methods.substr(begin, end - begin));
    begin = end + 1;
  }
  while (!cursor.at_end()) {
    auto setting = setting_in(cursor);
    if (!setting) return failure(fmt::format("{}: {}", name, setting.error().message));
    config.settings_.push_back(std::move(*setting));
  }
  if (cursor.is_short()) return failure(fmt::format("{}: answered with too few bytes", name));
  for (const PythonSetting& each : config.settings_) {
    if (each.key != kCallTimeoutKey && each.key != kPythonCodeHash) continue;
    return failure(
        fmt::format("{}: the keyword '{}' of the constructor is the name of another "
                    "parameter; expected another name",
                    name, each.key));
  }
  return config;
}

void PythonConfig::describe(Fields& fields) {
  for (PythonSetting& each : settings_) {
    describe_value(fields, each.key, each.value,
                   {.unit = "-", .meaning = "keyword of the constructor of " + name_});
  }
  fields.number(kCallTimeoutKey, call_timeout_,
                {.unit = "s",
                 .range = up_to(1e6),
                 .meaning = "wall time that one call of the class is given; 0: any"});
  fields.text(kPythonCodeHash, code_hash_,
              {.unit = "-", .meaning = "hash of the files that the class is made of"});
}

std::unique_ptr<Estimator> PythonConfig::create(const SensorRig& rig) const {
  return std::make_unique<PythonEstimator>(*this, rig);
}

std::unique_ptr<EstimatorConfig> PythonConfig::clone() const {
  return std::make_unique<PythonConfig>(*this);
}

bool PythonConfig::has(std::string_view method) const {
  return std::ranges::find(methods_, method) != methods_.end();
}

Result<void> PythonConfig::check() const {
  for (const PythonSetting& each : settings_) {
    if (each.standard || is_given(each.value)) continue;
    return failure(
        fmt::format("{}: {}: expected a value, as the constructor has no default; give "
                    "+{}=VALUE",
                    name_, each.key, each.key));
  }
  if (code_hash_ == found_hash_) return {};
  return failure(fmt::format("{}: code_hash: expected {}, as set; the files have {}", name_,
                             code_hash_, found_hash_));
}

}  // namespace aims
