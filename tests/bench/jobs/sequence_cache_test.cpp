// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/sequence_cache.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <fstream>

#include "bench/estimate/stream.hpp"
#include "bench/run/evaluate.hpp"
#include "bench/run/sequence_file.hpp"
#include "bench/scoring/score_record.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/tum.hpp"
#include "sim/simulation.hpp"
#include "tests/bench/short_walk.hpp"
#include "tests/support/estimator_settings.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;
using testing::short_walk;

/// One sequence that the tests share, since simulating it takes most of their time.
class SequenceFile : public ::testing::Test {
 protected:
  static void SetUpTestSuite() {
    shared_ = new TemporaryFolder;
    const auto made = SequenceCache(shared_->path()).make(short_walk(), 1);
    ASSERT_TRUE(made) << made.error().message;
    ASSERT_TRUE(made->simulated);
  }
  static void TearDownTestSuite() { delete shared_; }

  static fs::path file() {
    return SequenceCache(shared_->path()).file_of(SequenceCache::id_of(short_walk(), 1));
  }

  static TemporaryFolder* shared_;
  TemporaryFolder folder_;
};

TemporaryFolder* SequenceFile::shared_ = nullptr;

TEST_F(SequenceFile, ReadsBackEveryDeliveryBitForBit) {
  auto simulation = Simulation::create(short_walk().simulation, 1);
  ASSERT_TRUE(simulation);
  std::vector<Delivery> direct;
  while (simulation->advance(kSecond, direct)) continue;
  const auto reader = SequenceReader::open(file());
  ASSERT_TRUE(reader) << reader.error().message;
  std::size_t next = 0;
  std::size_t scans = 0;
  const auto replayed = reader->replay([&](const Delivery& read) {
    ASSERT_LT(next, direct.size());
    const Delivery& made = direct[next++];
    ASSERT_EQ(read.arrival, made.arrival);
    ASSERT_EQ(read.measurement.index(), made.measurement.index());
    if (const auto* imu = std::get_if<ImuSample>(&read.measurement)) {
      const auto& other = std::get<ImuSample>(made.measurement);
      ASSERT_EQ(imu->stamp, other.stamp);
      ASSERT_EQ(imu->angular_velocity, other.angular_velocity);
      ASSERT_EQ(imu->specific_force, other.specific_force);
    } else if (const auto* legs = std::get_if<LegOdometrySample>(&read.measurement)) {
      const auto& other = std::get<LegOdometrySample>(made.measurement);
      ASSERT_EQ(legs->stamp, other.stamp);
      ASSERT_EQ(legs->T_odom_base.translation, other.T_odom_base.translation);
      ASSERT_EQ(legs->T_odom_base.rotation.coeffs(), other.T_odom_base.rotation.coeffs());
      ASSERT_EQ(legs->linear_velocity, other.linear_velocity);
      ASSERT_EQ(legs->angular_velocity, other.angular_velocity);
      ASSERT_EQ(legs->contact, other.contact);
      ASSERT_EQ(legs->joint_position, other.joint_position);
      ASSERT_EQ(legs->joint_velocity, other.joint_velocity);
    } else {
      ++scans;
      const LidarScan& scan = *std::get<LidarScanPtr>(read.measurement);
      const LidarScan& other = *std::get<LidarScanPtr>(made.measurement);
      ASSERT_EQ(scan.stamp, other.stamp);
      ASSERT_EQ(scan.end, other.end);
      ASSERT_EQ(scan.points.size(), other.points.size());
      for (std::size_t i = 0; i < scan.points.size(); ++i) {
        ASSERT_EQ(scan.points[i].position, other.points[i].position);
        ASSERT_EQ(scan.points[i].intensity, other.points[i].intensity);
        ASSERT_EQ(scan.points[i].time_offset_ns, other.points[i].time_offset_ns);
        ASSERT_EQ(scan.points[i].ring, other.points[i].ring);
      }
    }
  });
  ASSERT_TRUE(replayed) << replayed.error().message;
  EXPECT_EQ(next, direct.size());
  EXPECT_GT(scans, 20U);
}

TEST_F(SequenceFile, DoesNotDependOnTheThreads) {
  const SequenceCache other(folder_.path());
  ASSERT_TRUE(other.make(short_walk(), 1, {}, 2));
  const auto one = read_file(file());
  const auto two = read_file(other.file_of(SequenceCache::id_of(short_walk(), 1)));
  ASSERT_TRUE(one && two);
  EXPECT_TRUE(*one == *two);
}

TEST_F(SequenceFile, ReadsBackTheTruthBitForBit) {
  auto simulation = Simulation::create(short_walk().simulation, 1);
  ASSERT_TRUE(simulation);
  std::vector<Delivery> deliveries;
  while (simulation->advance(kSecond, deliveries)) continue;
  const Truth& made = simulation->truth();
  const Truth read = SequenceReader::open(file())->truth();
  ASSERT_EQ(read.samples.size(), made.samples.size());
  for (std::size_t i = 0; i < made.samples.size(); ++i) {
    ASSERT_EQ(read.samples[i].stamp, made.samples[i].stamp);
    ASSERT_EQ(read.samples[i].T_world_body.translation, made.samples[i].T_world_body.translation);
    ASSERT_EQ(read.samples[i].slip_speed, made.samples[i].slip_speed);
  }
  ASSERT_EQ(read.snapshots.size(), made.snapshots.size());
  ASSERT_FALSE(made.snapshots.empty());
  EXPECT_EQ(read.snapshots.back().qpos, made.snapshots.back().qpos);
  ASSERT_EQ(read.scans.size(), made.scans.size());
  EXPECT_EQ(read.scans.back().information, made.scans.back().information);
  EXPECT_EQ(read.waypoint_times.size(), made.waypoint_times.size());
}

TEST_F(SequenceFile, GivesEstimatorsWhatTheSimulationGives) {
  Scenario scenario = short_walk();
  scenario.run = {"aims", "other=aims+degeneracy.eta=1", "leg"};
  auto simulation = Simulation::create(scenario.simulation, 1);
  ASSERT_TRUE(simulation);
  auto direct = make_estimators(scenario.run, scenario.estimators, simulation->rig());
  ASSERT_TRUE(direct);
  std::vector<Delivery> deliveries;
  while (simulation->advance(kSecond, deliveries)) continue;
  const auto sequence = open_sequence(file(), scenario, 1);
  ASSERT_TRUE(sequence) << sequence.error().message;
  for (std::size_t i = 0; i < scenario.run.size(); ++i) {
    TimedEstimator& estimator = (*direct)[i];
    estimator.consume(deliveries);
    estimator.finish();
    const Trajectory& trajectory = estimator.estimator().result().trajectory;
    const auto outcome = evaluate(*sequence, scenario, scenario.run[i], [](double) {});
    ASSERT_TRUE(outcome) << outcome.error().message;
    EXPECT_EQ(tum_text(outcome->result.trajectory), tum_text(trajectory)) << estimator.name();
    const Truth& truth = simulation->truth();
    const Scores scores =
        score(trajectory, body_trajectory(truth), truth.waypoint_times, scenario.scoring);
    EXPECT_EQ(scores_json(outcome->scores), scores_json(scores)) << estimator.name();
    EXPECT_FALSE(outcome->weak_axis.empty());
  }
}

TEST_F(SequenceFile, IsRefusedWhenCutShortOrOfAnotherFormat) {
  const std::string whole = read_file(file()).value();
  const fs::path broken = folder_.path() / "broken.sequence";
  for (const std::size_t size :
       {std::size_t{0}, std::size_t{7}, whole.size() / 2, whole.size() - 1}) {
    ASSERT_TRUE(write_file_atomically(broken, std::string_view(whole).substr(0, size)));
    const auto reader = SequenceReader::open(broken);
    ASSERT_FALSE(reader) << size;
    EXPECT_NE(reader.error().message.find("broken.sequence: expected a whole recorded sequence"),
              std::string::npos);
  }
  std::string other = whole;
  other[8] = 9;  // the format's number
  ASSERT_TRUE(write_file_atomically(broken, other));
  EXPECT_FALSE(SequenceReader::open(broken));
}

TEST_F(SequenceFile, IsMadeOnce) {
  const SequenceCache cache(shared_->path());
  const auto stamp = fs::last_write_time(file());
  const auto again = cache.make(short_walk(), 1);
  ASSERT_TRUE(again);
  EXPECT_FALSE(again->simulated);
  EXPECT_EQ(fs::last_write_time(file()), stamp);
}

TEST(SequenceCache, IdDependsOnWhatDecidesTheWalkAndOnNothingElse) {
  const std::string id = SequenceCache::id_of(short_walk(), 1);
  EXPECT_EQ(id.size(), 16U);
  EXPECT_NE(id, SequenceCache::id_of(short_walk(), 2));
  Scenario other = short_walk();
  other.simulation.lidar.range_max = 5.0;
  EXPECT_NE(id, SequenceCache::id_of(other, 1));
  Scenario same = short_walk("another name");
  same.estimators = test::with(same.estimators, "aims.degeneracy.eta", "4");
  same.scoring.max_error_offset += 1.0;
  same.run = {"lio"};
  EXPECT_EQ(id, SequenceCache::id_of(same, 1));
}

TEST(SequenceCache, ClearsAwayWhatAKilledProcessLeftOfTheWalk) {
  const TemporaryFolder folder;
  const SequenceCache cache(folder.path());
  const fs::path file = cache.file_of(SequenceCache::id_of(short_walk(), 2));
  std::ofstream(file.string() + ".node7.4711.tmp") << "half a sequence";
  std::ofstream(folder.path() / "0123456789abcdef.sequence.node7.4711.tmp") << "another's";
  ASSERT_TRUE(cache.make(short_walk(), 2)->simulated);
  EXPECT_FALSE(fs::exists(file.string() + ".node7.4711.tmp"));
  EXPECT_TRUE(fs::exists(folder.path() / "0123456789abcdef.sequence.node7.4711.tmp"));
}

TEST(SequenceCache, RefusesWhatCannotBeSimulatedAndLeavesNothing) {
  const TemporaryFolder folder;
  const auto made = SequenceCache(folder.path()).make(testing::in_wall(), 1);
  ASSERT_TRUE(made) << made.error().message;
  ASSERT_TRUE(made->refusal);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

/// A cache with sequences of 1000 bytes, used an hour apart in the order of their names.
class FullCache : public ::testing::Test {
 protected:
  FullCache() {
    const auto now = fs::file_time_type::clock::now();
    for (int i = 0; i < 4; ++i) {
      std::ofstream(cache_.file_of(kIds[i])) << std::string(1000, 'w');
      fs::last_write_time(cache_.file_of(kIds[i]), now - std::chrono::hours(10 - i));
    }
    std::ofstream(folder_.path() / "a.sequence.node7.4711.tmp") << "being made";
  }

  /// Names of those that are there.
  std::string left() const {
    std::string names;
    for (const char* id : kIds) names += cache_.has(id) ? id : "";
    return names;
  }

  static constexpr std::array<const char*, 4> kIds = {"a", "b", "c", "d"};
  TemporaryFolder folder_;
  SequenceCache cache_{folder_.path()};
};

TEST_F(FullCache, LosesWhatWasUsedLongestAgoUntilItFits) {
  const CachePruned nothing = cache_.prune(4000, {});
  EXPECT_EQ(nothing.sequences, 0U);
  EXPECT_EQ(nothing.left, 4000U);
  const CachePruned pruned = cache_.prune(2500, {});
  EXPECT_EQ(left(), "cd");
  EXPECT_EQ(pruned.sequences, 2U);
  EXPECT_EQ(pruned.bytes, 2000U);
  EXPECT_EQ(pruned.left, 2000U);
  EXPECT_TRUE(fs::exists(folder_.path() / "a.sequence.node7.4711.tmp")) << "its maker's";
  EXPECT_EQ(SequenceCache(folder_.path() / "nowhere").prune(0, {}).sequences, 0U);
}

TEST_F(FullCache, KeepsWhatIsInUseOrWaitedFor) {
  {
    const auto in_use = cache_.use("b");
    ASSERT_TRUE(in_use);
    const auto twice = cache_.use("b");
    EXPECT_TRUE(twice) << "any number may use it";
    const CachePruned pruned = cache_.prune(1, {"c"});
    EXPECT_EQ(left(), "bc");
    EXPECT_EQ(pruned.left, 2000U) << "more than the limit";
  }
  cache_.prune(1, {});
  EXPECT_EQ(left(), "");
  EXPECT_FALSE(cache_.use("b"));
  EXPECT_FALSE(cache_.has("b")) << "asking made none";
}

TEST_F(FullCache, CountsAWalkAsUsedWhenItIsUsed) {
  EXPECT_TRUE(cache_.use("a"));
  cache_.prune(2000, {});
  EXPECT_EQ(left(), "ad");
}

TEST_F(FullCache, KeepsWhatAnotherProcessUses) {
  const auto in_use = cache_.use("a");
  const pid_t child = ::fork();
  if (child == 0) {
    const bool kept = SequenceCache(folder_.path()).prune(1, {}).left == 1000;
    ::_exit(kept ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(::waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(left(), "a");
}

TEST(SequenceCache, AFolderThatCannotBeWrittenIsAnError) {
  const TemporaryFolder folder;
  std::ofstream(folder.path() / "file") << "x";
  const auto made = SequenceCache(folder.path() / "file").make(short_walk(), 1);
  ASSERT_FALSE(made);
  EXPECT_NE(made.error().message.find((folder.path() / "file").string()), std::string::npos);
}

}  // namespace
}  // namespace aims
