// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/source/split_imu.hpp"

#include <algorithm>
#include <deque>
#include <utility>

#include "recordings/messages/inertial_topics.hpp"
#include "recordings/messages/message_decoder.hpp"
#include "recordings/messages/message_encoding.hpp"
#include "recordings/messages/message_types.hpp"
#include "recordings/source/derived_source.hpp"

namespace aims {
namespace {

constexpr std::string_view kImuType = "sensor_msgs/Imu",
                           kVectorType = "geometry_msgs/Vector3Stamped";
constexpr Duration kLongestGap = kSecond / 10;  ///< between samples of the accelerometer
constexpr std::size_t kMostWaiting = 10'000;    ///< samples of the gyro that wait

struct Sample {
  Time stamp = 0;
  Eigen::Vector3d value = Eigen::Vector3d::Zero();
};

/// A topic with one half.
struct HalfTopic {
  BagConnection connection;
  MessageDecoder decoder;

  std::optional<Sample> read(const BagMessage& message, std::string_view imu_field) const {
    const auto view = decoder.decode(message.data);
    if (!view) return std::nullopt;
    const std::string path(connection.type == kImuType ? imu_field : "vector");
    const auto x = view->number(path + ".x"), y = view->number(path + ".y"),
               z = view->number(path + ".z");
    if (!x || !y || !z) return std::nullopt;
    const Time stamp = header_stamp(*view, message.taken());
    return Sample{stamp > 0 ? stamp : message.taken(), {*x, *y, *z}};
  }

  std::string frame(const BagMessage& message) const {
    const auto view = decoder.decode(message.data);
    return std::string(view ? view->text("header.frame_id").value_or("") : "");
  }
};

class SplitImu final : public DerivedSource {
 public:
  SplitImu(std::unique_ptr<MessageSource> source, HalfTopic gyro, HalfTopic accelerometer)
      : DerivedSource(std::move(source)),
        gyro_(std::move(gyro)),
        accelerometer_(std::move(accelerometer)),
        made_(add_topic(gyro_.connection.topic + "/imu", imu_type(), gyro_.connection.messages,
                        {gyro_.connection.id, accelerometer_.connection.id})) {}

 private:
  void restart() override {
    waiting_.clear();
    before_.reset();
    frame_.clear();
  }

  Result<void> see(const BagMessage& message) override {
    if (message.connection->topic == gyro_.connection.topic) {
      if (frame_.empty()) frame_ = gyro_.frame(message);
      const auto turn = gyro_.read(message, "angular_velocity");
      if (turn && waiting_.size() < kMostWaiting) waiting_.push_back(*turn);
      return {};
    }
    const auto force = accelerometer_.read(message, "linear_acceleration");
    if (!force) return {};
    if (before_ && force->stamp > before_->stamp) give_until(*force, message.record_time);
    before_ = force;
    return {};
  }

  /// The samples of the gyro between the last sample of the accelerometer and `after`.
  void give_until(const Sample& after, Time record_time) {
    const Duration span = after.stamp - before_->stamp;
    while (!waiting_.empty() && waiting_.front().stamp <= after.stamp) {
      const Sample turn = waiting_.front();
      waiting_.pop_front();
      if (turn.stamp < before_->stamp || span > kLongestGap) continue;
      const double part =
          static_cast<double>(turn.stamp - before_->stamp) / static_cast<double>(span);
      ImuSample sample;
      sample.stamp = turn.stamp;
      sample.angular_velocity = turn.value;
      sample.specific_force = before_->value + part * (after.value - before_->value);
      give(made_, record_time, imu_message({0, turn.stamp, frame_}, sample));
    }
  }

  HalfTopic gyro_, accelerometer_;
  std::uint32_t made_;
  std::deque<Sample> waiting_;  ///< of the gyro
  std::optional<Sample> before_;
  std::string frame_;
};

std::optional<HalfTopic> half_topic(const BagConnection& connection) {
  auto decoder = MessageDecoder::create(connection.type, connection.definition, connection.format);
  if (!decoder) return std::nullopt;
  return HalfTopic{connection, std::move(*decoder)};
}

/// The accelerometer of the same sensor: of one type and name but for the word.
const BagConnection* partner_of(const BagConnection& gyro, std::span<const BagConnection> all) {
  const auto named = inertial_half(gyro.topic);
  const auto found = std::ranges::find_if(all, [&](const BagConnection& each) {
    const auto half = inertial_half(each.topic);
    return half && half->half == InertialHalf::kAccelerometer && half->rest == named->rest &&
           each.type == gyro.type && each.messages > 0;
  });
  return found == all.end() ? nullptr : &*found;
}

}  // namespace

void join_split_imu(std::unique_ptr<MessageSource>& source) {
  const std::vector<BagConnection> all = source->connections();
  for (const BagConnection& each : all) {
    const auto half = inertial_half(each.topic);
    if (!half || half->half != InertialHalf::kGyro || each.messages == 0) continue;
    if (each.type != kImuType && each.type != kVectorType) continue;
    const BagConnection* partner = partner_of(each, all);
    if (partner == nullptr) continue;
    auto gyro = half_topic(each), accelerometer = half_topic(*partner);
    if (!gyro || !accelerometer) continue;
    source =
        std::make_unique<SplitImu>(std::move(source), std::move(*gyro), std::move(*accelerometer));
  }
}

}  // namespace aims
