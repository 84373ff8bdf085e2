// SPDX-License-Identifier: BSD-3-Clause
#include "live/watch/watch_state.hpp"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <string>

#include "recordings/messages/message_encoding.hpp"
#include "recordings/messages/message_types.hpp"

namespace aims {
namespace {

using Json = nlohmann::json;

class WatchStateTest : public testing::Test {
 protected:
  void take(const std::string& type, const MessageBytes& bytes) {
    auto connection = std::make_shared<BagConnection>();
    connection->type = type;
    connection->format = kRos2Format;
    complete_definition(type, connection->definition, connection->format);
    const auto view = bytes.view();
    state_.take({connection, 1, {view.begin(), view.end()}});
  }
  void walk_to(double x, double y, double heading = 0.0) {
    OdometryContent content;
    content.pose.translation = {x, y, 0.5};
    content.pose.rotation = so3_exp(Eigen::Vector3d(0.0, 0.0, heading));
    take("nav_msgs/Odometry", odometry_message({}, "imu", content, Serialization::kCdr));
  }
  Json state(std::uint64_t epoch = 0, std::size_t from = 0) const {
    return Json::parse(state_.json(epoch, from));
  }
  WatchState state_{"/aims/odometry"};
};

TEST_F(WatchStateTest, IsEmptyBeforeTheFirstMessage) {
  EXPECT_TRUE(state()["silent_s"].is_null());
  EXPECT_TRUE(state()["pose"].is_null());
  EXPECT_TRUE(state()["path"]["xy"].empty());
}

TEST_F(WatchStateTest, GivesPoseAndThePartOfThePathThatIsNew) {
  walk_to(1.0, 0.0);
  walk_to(1.01, 0.0);  // too near for a point of its own
  walk_to(2.0, 1.0, 0.7);
  EXPECT_NEAR(state()["pose"][3].get<double>(), 0.7, 1e-9);
  EXPECT_EQ(state()["path"]["xy"], Json::parse("[[1.0, 0.0], [2.0, 1.0]]"));
  EXPECT_EQ(state(0, 1)["path"]["xy"], Json::parse("[[2.0, 1.0]]"));
  EXPECT_EQ(state(7, 1)["path"]["from"], 0) << "another epoch: all of it";
}

TEST_F(WatchStateTest, ALongPathIsThinned) {
  for (int i = 0; i <= 20'000; ++i) walk_to(0.1 * i, 0.0);
  EXPECT_EQ(state()["path"]["epoch"], 1);
  EXPECT_EQ(state()["path"]["xy"].size(), 10'001U);
  EXPECT_NEAR(state()["path"]["xy"].back()[0].get<double>(), 2000.0, 1e-9);
}

TEST_F(WatchStateTest, ThinsTheScanAndKeepsThePlaces) {
  std::vector<Eigen::Vector3f> points(12'000, Eigen::Vector3f(1.25F, -2.5F, 0.75F));
  take("sensor_msgs/PointCloud2", points_message({}, points, Serialization::kCdr));
  const Json scan = state()["scan"];
  EXPECT_EQ(scan.size(), 9000U);
  EXPECT_EQ((std::vector<int>{scan[0], scan[1], scan[2]}), (std::vector<int>{125, -250, 75}));
}

TEST_F(WatchStateTest, TakesTheHealthOfItsNodeAlone) {
  DiagnosticContent other{.level = 2, .name = "motor", .message = "hot", .values = {}};
  take("diagnostic_msgs/DiagnosticArray", diagnostics_message({}, other, Serialization::kCdr));
  other.name = "b: localization";
  take("diagnostic_msgs/DiagnosticArray", diagnostics_message({}, other, Serialization::kCdr));
  EXPECT_EQ(state()["health"]["text"], "");
  DiagnosticContent own{1, "aims: localization", "degraded: no legs", {{"messages lost", "3"}}};
  take("diagnostic_msgs/DiagnosticArray", diagnostics_message({}, own, Serialization::kCdr));
  EXPECT_EQ(state()["health"], Json::parse(R"({"level": 1, "text": "degraded: no legs",
                            "values": [["messages lost", "3"]]})"));
}

TEST_F(WatchStateTest, CountsWhatItCannotRead) {
  MessageBytes broken = string_message("no odometry", Serialization::kCdr);
  take("nav_msgs/Odometry", broken);
  EXPECT_EQ(state()["malformed"], 1);
}

}  // namespace
}  // namespace aims
