// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <Eigen/Core>
#include <boost/random/mersenne_twister.hpp>
#include <cstdint>
#include <string_view>

namespace aims {

/// Named stream of random numbers. Its values depend only on the run's seed and its name, so that a
/// new sensor never changes another's noise. Identical on every compiler.
class RandomStream {
 public:
  RandomStream(std::uint64_t run_seed, std::string_view name);

  double uniform();                         ///< in [0, 1)
  double uniform(double low, double high);  ///< in [low, high)
  double normal();                          ///< zero mean, unit variance
  Eigen::Vector3d normal3();                ///< three independent `normal()`
  bool chance(double probability);          ///< true with that probability

 private:
  boost::random::mt19937_64 engine_;
};

/// The stream `name` of the run with that seed, e.g. rng(seed, "imu.gyro").
inline RandomStream rng(std::uint64_t run_seed, std::string_view name) {
  return RandomStream(run_seed, name);
}

}  // namespace aims
