// SPDX-License-Identifier: BSD-3-Clause
// Messages of a table, against the layouts of ROS 1; tests/formats/csv_test.py has a robot's.
#include "recordings/csv/csv_reader.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include "core/files/atomic_file.hpp"
#include "core/files/byte_cursor.hpp"
#include "recordings/bag/message_source.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

/// sequence, stamp, and the frame behind them.
constexpr std::size_t kHeader = 16;
/// Of sensor_msgs/Imu in frame "imu" [bytes].
constexpr std::size_t kQuaternion = kHeader + 3, kTurn = kQuaternion + (4 + 9) * 8,
                      kForce = kTurn + (3 + 9) * 8;

constexpr const char* kImu = "gyro: [wx, wy, wz]\naccelerometer: [ax, ay, az]\n";

class CsvTable : public testing::Test {
 protected:
  void put(const std::string& name, const std::string& text) {
    ASSERT_TRUE(write_file_atomically(folder_.path() / name, text));
  }

  Result<CsvReader> open(const std::string& mapping, const std::string& table) {
    put("map.yaml", "file: t.csv\n" + mapping);
    put("t.csv", table);
    return CsvReader::open(folder_.path() / "map.yaml");
  }

  /// Why the table is refused, without the folder.
  std::string refusal(const std::string& mapping, const std::string& table) {
    const auto reader = open(mapping, table);
    if (reader) return "accepted";
    std::string message = reader.error().message;
    const std::string folder = folder_.path().string() + "/";
    for (std::size_t at = 0; (at = message.find(folder)) != std::string::npos;) {
      message.erase(at, folder.size());
    }
    return message;
  }

  TemporaryFolder folder_;
};

double number(std::span<const std::byte> data, std::size_t at) {
  return load_number<double>(&data[at]);
}

TEST_F(CsvTable, CarriesAnImuInItsUnits) {
  auto reader =
      open(std::string("time_unit: ms\ngyro_unit: deg/s\norientation: [qx, qy, qz, qw]\n") + kImu,
           "qw,qx,qy,qz,time,wx,wy,wz,ax,ay,az\n"
           "0.8,0,0.6,0,1500.25,180,-90,45,1,2,9.5\n");
  ASSERT_TRUE(reader) << reader.error().message;
  const auto message = reader->next();
  ASSERT_TRUE(message && *message);
  EXPECT_EQ((*message)->connection->topic, "/imu/data");
  EXPECT_EQ((*message)->record_time, 1'500'250'000);
  const auto data = (*message)->data;
  EXPECT_EQ(load_number<std::uint32_t>(&data[4]), 1U);
  EXPECT_EQ(load_number<std::uint32_t>(&data[8]), 500'250'000U);
  const std::vector<double> quaternion = {0.0, 0.6, 0.0, 0.8};
  const std::vector<double> turn = {std::numbers::pi, -std::numbers::pi / 2, std::numbers::pi / 4};
  const std::vector<double> force = {1.0, 2.0, 9.5};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(number(data, kQuaternion + 8 * i), quaternion[i]) << i;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_NEAR(number(data, kTurn + 8 * i), turn[i], 1e-12) << i;
    EXPECT_EQ(number(data, kForce + 8 * i), force[i]) << i;
  }
}

TEST_F(CsvTable, NamesAColumnThatIsEmptyInAllRows) {
  const std::string forces = "foot_force: [a, b, c, d]\n";
  EXPECT_EQ(refusal(forces, "time,a,b,c,d\n1,1,2,,4\n2,1,2,nan,4\n"),
            "t.csv: column 'c' holds no number in any row; expected one in each row in which the "
            "others of [a, b, c, d] have one");
  EXPECT_EQ(refusal(forces, "time,a,b,c,d\n1,1,2,,4\n2,1,2,3,4\n"), "accepted");
}

TEST_F(CsvTable, ReadsEveryUnitOfTime) {
  const std::map<std::string, std::string> cells = {
      {"s", "1.000000002"}, {"ms", "1000.000002"}, {"us", "1000000.002"}, {"ns", "1000000002"}};
  for (const auto& [unit, cell] : cells) {
    auto reader = open("time_unit: " + unit + "\nfoot_force: [a, b, c, d]\n",
                       "time,a,b,c,d\n" + cell + ",1,2,3,4\n");
    ASSERT_TRUE(reader) << reader.error().message;
    EXPECT_EQ(reader->summary().start, 1'000'000'002) << unit;
  }
}

TEST_F(CsvTable, LinesOfASpreadsheetAreRead) {
  for (const char* table : {"sep=,\ntime,a,b,c,d\n1.5,1,2,3,4\n", "time,a,b,c,d\r1.5,1,2,3,4\r",
                            "sep=;\r\ntime;a;b;c;d\r\n1,5;1;2;3;4\r\n"}) {
    auto reader = open("foot_force: [a, b, c, d]\n", table);
    ASSERT_TRUE(reader) << table << reader.error().message;
    EXPECT_EQ(reader->summary().start, 1'500'000'000) << table;
  }
}

TEST_F(CsvTable, NamesTheLikelyUnitAndTheColumnsThatThereAre) {
  const std::string mapping = "foot_force: [a, b, c, d]\n";
  EXPECT_NE(refusal(mapping, "time,a,b,c,d\n1700000000000000000,1,2,3,4\n")
                .find("; likely time_unit: ns"),
            std::string::npos);
  EXPECT_NE(refusal(mapping, "time,a [N],b,c,d\n1,1,2,3,4\n")
                .find("expected a column 'a', which the mapping names; there are 'time', 'a [N]'"),
            std::string::npos);
}

TEST_F(CsvTable, LacksTheMessagesOfEmptyCells) {
  auto reader = open(std::string("foot_force: [a, b, c, d]\n") + kImu,
                     "time,wx,wy,wz,ax,ay,az,a,b,c,d\n"
                     "1,0,0,0,0,0,9.8,1,2,3,4\n"
                     "1,0,0,0,0,0,,1,2,3,4\n"
                     "2,0,0,0,0,0,9.8,1,,3,4\n");
  ASSERT_TRUE(reader) << reader.error().message;
  std::vector<std::pair<std::string, std::uint64_t>> found;
  while (true) {
    const auto message = reader->next();
    ASSERT_TRUE(message);
    if (!*message) break;
    found.emplace_back((*message)->connection->topic, (*message)->offset);
  }
  const std::vector<std::pair<std::string, std::uint64_t>> expected = {
      {"/imu/data", 1}, {"/foot_forces", 1}, {"/foot_forces", 2}, {"/imu/data", 3}};
  EXPECT_EQ(found, expected);
  ASSERT_EQ(reader->connections().size(), 2U);
  EXPECT_EQ(reader->connections()[0].messages, 2U);
  EXPECT_EQ(reader->summary().messages, 4U);
}

TEST_F(CsvTable, JointsOfWhichAFewAreNoNumbersAreOneMessage) {
  auto reader = open("joint_position: [a, b, c, d, e, f, g, h, i, j, k, l]\n",
                     "time,a,b,c,d,e,f,g,h,i,j,k,l\n"
                     "1,1,2,3,4,5,6,7,8,9,10,11,12\n"
                     "2,1,nan,3,4,5,6,7,8,9,10,,12\n"
                     "3,,,,,,,,,,,,\n");
  ASSERT_TRUE(reader) << reader.error().message;
  ASSERT_EQ(reader->summary().messages, 2U) << "a row without any angle has none";
  ASSERT_TRUE(reader->next());
  const auto message = reader->next();
  ASSERT_TRUE(message && *message);
  const std::span<const std::byte> data = (*message)->data;
  const std::size_t angles = data.size() - (4 + 4) - 12 * sizeof(double);  // before empty arrays
  for (std::size_t i = 0; i < 12; ++i) {
    const double angle = number(data, angles + i * sizeof(double));
    EXPECT_TRUE(i == 1 || i == 10 ? std::isnan(angle) : angle == static_cast<double>(i + 1)) << i;
  }
}

TEST_F(CsvTable, TablesOfOtherToolsAreReadAsTheyAre) {
  const std::vector<std::string> tables = {
      "time, wx, wy, wz, ax, ay, az\n1, 0, 0, 0, 0, 0, +9.81\n",
      "time,wx,wy,wz,ax,ay,az\n1,0,0,0,0,0,9.81",
      "\xef\xbb\xbf# log\r\n\r\n#time;wx;wy;wz;ax;ay;az\r\n1;0;0;0;0;0;9.81\r\n# end\r\n\r\n",
      "time\twx\twy\twz\tax\tay\taz\n1\t0\t0\t0\t0\t0\t9.81\n"};
  for (const std::string& table : tables) {
    auto reader = open(kImu, table);
    ASSERT_TRUE(reader) << reader.error().message << "\n" << table;
    EXPECT_EQ(reader->summary().messages, 1U) << table;
    const auto message = reader->next();
    ASSERT_TRUE(message && *message);
    EXPECT_EQ(number((*message)->data, kForce + 16), 9.81) << table;
  }
}

TEST_F(CsvTable, TimesMayBeDates) {
  const std::string table =
      "time,wx,wy,wz,ax,ay,az\n2023-11-14T22:13:20Z,0,0,0,0,0,9.8\n"
      "2023-11-14T22:13:20.01Z,0,0,0,0,0,9.8\n";
  auto reader = open(kImu, table);
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(reader->summary().start, 1'700'000'000 * kSecond);
  EXPECT_EQ(reader->summary().end, reader->summary().start + kSecond / 100);
}

TEST_F(CsvTable, FewRowsWithoutATimeAreLeftOutAndCounted) {
  const std::string header = "time,wx,wy,wz,ax,ay,az\n", cells = ",0,0,0,0,0,9.8\n";
  for (const char* missing : {"", " ", "nan", "NaN", "inf"}) {
    std::string table = header + missing + cells;  // also the first row
    for (int i = 1; i < 20; ++i) table += (i == 7 ? missing : std::to_string(i)) + cells;
    auto reader = open(kImu, table);
    ASSERT_TRUE(reader) << missing << reader.error().message;
    EXPECT_EQ(reader->summary().untimed_rows, 2U) << missing;
    EXPECT_EQ(reader->summary().messages, 18U) << missing;
    EXPECT_EQ(reader->summary().start, kSecond) << missing;
    EXPECT_EQ(reader->summary().end, 19 * kSecond) << missing;
    EXPECT_NE(refusal(kImu, table + missing + cells).find("t.csv:2: time: expected a time, found"),
              std::string::npos)
        << missing;
  }
}

TEST_F(CsvTable, RecoveryLeavesAnIncompleteLastRowOut) {
  const std::string table = "time,wx,wy,wz,ax,ay,az\n1,0,0,0,0,0,9.8\n2,0,0,0,0";
  EXPECT_EQ(refusal(kImu, table),
            "t.csv:3: expected 7 cells and a line end, found 5 cells, truncated");
  const auto reader = CsvReader::open(folder_.path() / "map.yaml", {.recover = true});
  ASSERT_TRUE(reader) << reader.error().message;
  EXPECT_EQ(reader->summary().messages, 1U);
}

TEST_F(CsvTable, RefusesWhatIsMalformed) {
  const std::string header = "time,wx,wy,wz,ax,ay,az\n";
  const std::string row = "1,0,0,0,0,0,9.8\n";
  EXPECT_EQ(refusal(kImu, header + row + "0.5,0,0,0,0,0,9.8\n"),
            "t.csv:3: time: expected a time >= 1000000000 ns, found '0.5'");
  EXPECT_EQ(refusal(kImu, header + "soon,0,0,0,0,0,9.8\n"),
            "t.csv:2: time: expected a time >= 0 ns, found 'soon'");
  EXPECT_EQ(refusal(kImu, header + "-1,0,0,0,0,0,9.8\n"),
            "t.csv:2: time: expected a time >= 0 ns, found '-1'");
  EXPECT_EQ(refusal(kImu, header + row + "nan,0,0,0,0,0,9.8\n"),
            "t.csv:3: time: expected a time, found NaN ('nan'), as in 1 of 2 rows; at most a tenth "
            "may lack it");
  EXPECT_EQ(refusal(kImu, header + row + ",0,0,0,0,0,9.8\n"),
            "t.csv:3: time: expected a time, found an empty cell, as in 1 of 2 rows; at most a "
            "tenth may lack it");
  EXPECT_EQ(refusal(kImu, header + row + "2,0,up,0,0,0,9.8\n"),
            "t.csv:3: wy: expected a number, found 'up'");
  EXPECT_EQ(refusal(kImu, header + row + "2,0,0\n"),
            "t.csv:3: expected 7 cells and a line end, found 3 cells");
  EXPECT_EQ(refusal(kImu, header + row + "2,0,0,0,0,0,9.8,1\n"),
            "t.csv:3: expected 7 cells and a line end, found 8 cells");
  EXPECT_EQ(refusal("time: t\n" + std::string(kImu), header + row),
            "t.csv: expected a column 't' (time)");
  EXPECT_EQ(
      refusal("gyro: [wx, wy, w_z]\naccelerometer: [ax, ay, az]\n", header + row),
      "t.csv: expected a column 'w_z', which the mapping names; there are 'time', 'wx', 'wy', "
      "'wz', 'ax', 'ay', 'az'");
  EXPECT_EQ(refusal("gyro: [wx, wy]\n", header + row),
            "map.yaml: gyro: expected 3 columns or none, found 2");
  EXPECT_EQ(refusal("joint_velocity: [a,b,c,d,e,f,g,h,i,j,k,l]\n", header + row),
            "map.yaml: joint_velocity: has no effect without joint_position");
  EXPECT_NE(refusal("gyro_unit: rpm\n", header + row).find("expected one of rad/s, deg/s"),
            std::string::npos);
  put("map.yaml", "file: gone.csv\n" + std::string(kImu));
  const auto gone = CsvReader::open(folder_.path() / "map.yaml");
  ASSERT_FALSE(gone);
  EXPECT_NE(gone.error().message.find("gone.csv"), std::string::npos);
  const auto recovered = CsvReader::open(folder_.path() / "map.yaml", {.recover = true});
  ASSERT_FALSE(recovered);
  EXPECT_NE(recovered.error().message.find("gone.csv"), std::string::npos);
}

}  // namespace
}  // namespace aims
