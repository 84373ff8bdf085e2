// SPDX-License-Identifier: BSD-3-Clause
#include "live/watch/watch_state.hpp"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "live/transport.hpp"
#include "recordings/clouds/point_table.hpp"
#include "recordings/messages/message_values.hpp"

namespace aims {
namespace {

using Json = nlohmann::ordered_json;

constexpr double kStep = 0.05;             ///< between points of the path [m]
constexpr std::size_t kMaxPath = 20'000;   ///< then every other point is removed
constexpr std::size_t kScanPoints = 3000;  ///< shown

}  // namespace

void WatchState::take(const LiveMessage& message) {
  const BagConnection& from = *message.connection;
  const std::string& type = from.type;
  const auto [place, added] = decoders_.try_emplace(type);
  if (added) place->second = MessageDecoder::create(type, from.definition, from.format);
  if (!place->second) return;
  const auto view = place->second->decode(message.data);
  const std::lock_guard lock(mutex_);
  bool taken = view.has_value();
  if (taken && type == "nav_msgs/Odometry") taken = take_odometry(*view, message.arrival);
  if (taken && type == "sensor_msgs/PointCloud2") taken = take_cloud(*view);
  if (taken && type == "diagnostic_msgs/DiagnosticArray") taken = take_diagnostics(*view);
  if (!taken) ++malformed_;
}

bool WatchState::take_odometry(const MessageView& view, std::int64_t arrival) {
  EventCounts counts;
  const auto pose = message_pose(view, "pose.pose", counts);
  if (!pose || !pose->translation.allFinite()) return false;
  pose_ = *pose;
  last_ = arrival;
  const std::array<double, 2> place = {pose->translation.x(), pose->translation.y()};
  const bool near =
      !path_.empty() && std::hypot(place[0] - path_.back()[0], place[1] - path_.back()[1]) < kStep;
  if (!near) path_.push_back(place);
  if (path_.size() > kMaxPath) {
    std::size_t index = 0;
    std::erase_if(path_, [&](const auto&) { return index++ % 2 == 1; });
    ++epoch_;
  }
  return true;
}

bool WatchState::take_cloud(const MessageView& view) {
  const auto table = point_table(view);
  if (!table) return false;
  const PointField x(*table, *table->find("x"));
  const PointField y(*table, *table->find("y"));
  const PointField z(*table, *table->find("z"));
  const std::size_t step = std::max<std::size_t>(1, table->size() / kScanPoints);
  scan_.clear();
  for (std::size_t i = 0; i < table->size(); i += step) {
    const std::byte* point = table->point(i);
    const Eigen::Vector3d p(x.at(point), y.at(point), z.at(point));
    if (!p.allFinite() || p.norm() > 1e6) continue;
    for (const double each : p) scan_.push_back(static_cast<int>(std::lround(each * 100.0)));
  }
  return true;
}

/// Of several nodes that publish on /diagnostics, that of the odometry.
bool WatchState::take_diagnostics(const MessageView& view) {
  const auto all = view.messages("status");
  if (!all) return false;
  for (const MessageView& status : *all) {
    if (status.text("name").value_or("") != diagnostics_name(node_)) continue;
    level_ = static_cast<int>(status.number("level").value_or(3.0));
    health_ = status.text("message").value_or("");
    values_.clear();
    for (const MessageView& each : status.messages("values").value_or(std::vector<MessageView>())) {
      values_.emplace_back(each.text("key").value_or(""), each.text("value").value_or(""));
    }
  }
  return true;
}

std::string WatchState::json(std::uint64_t epoch, std::size_t from) const {
  const std::lock_guard lock(mutex_);
  const std::size_t begin = epoch == epoch_ ? std::min(from, path_.size()) : 0;
  const std::vector<std::array<double, 2>> path(path_.begin() + static_cast<std::ptrdiff_t>(begin),
                                                path_.end());
  Json json = {{"node", node_},
               {"silent_s", last_ > 0 ? Json(to_seconds(wall_time() - last_)) : Json()},
               {"pose", Json()},
               {"path", {{"epoch", epoch_}, {"from", begin}, {"xy", path}}},
               {"scan", scan_},
               {"health", {{"level", level_}, {"text", health_}, {"values", values_}}},
               {"malformed", malformed_}};
  if (pose_) {
    const Eigen::Matrix3d R = pose_->R();
    const Eigen::Vector3d& p = pose_->translation;
    json["pose"] = {p.x(), p.y(), p.z(), std::atan2(R(1, 0), R(0, 0))};
  }
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

}  // namespace aims
