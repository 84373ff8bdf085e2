// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/clouds/repeated_clouds.hpp"

#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <utility>

namespace aims {
namespace {

constexpr std::size_t kCompared = 256;  ///< points of a cloud
constexpr std::size_t kFewest = 30;  ///< of them that are returns; fewer may be the same by chance
constexpr int kLongRun = 10;         ///< a second of most LiDARs
constexpr int kOften = 20;           ///< one of so many clouds, where they are single

/// The coordinates of returns that are spread over the cloud.
std::vector<double> some_returns(const PointTable& table) {
  const PointField x(table, *table.find("x")), y(table, *table.find("y")),
      z(table, *table.find("z"));
  std::vector<double> numbers;
  const std::size_t step = std::max<std::size_t>(1, table.size() / kCompared);
  for (std::size_t i = 0; i < table.size(); i += step) {
    const std::byte* bytes = table.point(i);
    const Eigen::Vector3d position(x.at(bytes), y.at(bytes), z.at(bytes));
    if (!position.allFinite() || position.isZero(0.0)) continue;
    numbers.insert(numbers.end(), position.begin(), position.end());
  }
  return numbers;
}

}  // namespace

void RepeatedClouds::add(const PointTable& table) {
  std::vector<double> returns = some_returns(table);
  const bool same =
      clouds_++ > 0 && returns.size() >= 3 * kFewest && table.size() == size_ && returns == last_;
  last_ = std::move(returns);
  size_ = table.size();
  const bool again = same && table.stamp != stamp_;
  stamp_ = table.stamp;
  run_ = again ? run_ + 1 : 0;
  longest_run_ = std::max(longest_run_, run_);
  if (again && repeated_++ == 0) first_ = table.stamp;
}

bool RepeatedClouds::found() const {
  return longest_run_ >= kLongRun || (repeated_ >= kLongRun && repeated_ * kOften > clouds_);
}

std::string repeated_clouds_text(const std::string& topic, int repeated, int clouds) {
  return fmt::format(
      "{}: {} of {} clouds are the cloud before them under a new stamp: the LiDAR or its driver "
      "hangs and sends the last cloud again, by which the robot would stand still",
      topic, repeated, clouds);
}

}  // namespace aims
