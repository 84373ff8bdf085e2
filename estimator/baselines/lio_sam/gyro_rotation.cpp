// SPDX-License-Identifier: BSD-3-Clause
#include "estimator/baselines/lio_sam/gyro_rotation.hpp"

#include <algorithm>

#include "estimator/baselines/lio_sam/attitude.hpp"

namespace aims::lio_sam {

GyroRotation::GyroRotation(const std::vector<ImuSample>& samples, Time end) {
  for (const ImuSample& sample : samples) {
    if (sample.stamp > end + kSampleMargin) break;
    if (stamps_.empty()) {
      angles_.emplace_back(Eigen::Vector3d::Zero());
    } else {
      const double step = to_seconds(sample.stamp - stamps_.back());
      angles_.emplace_back(angles_.back() + sample.angular_velocity * step);
    }
    stamps_.push_back(sample.stamp);
  }
}

Eigen::Vector3d GyroRotation::angles_at(Time stamp) const {
  const auto after = std::upper_bound(stamps_.begin(), stamps_.end(), stamp);
  if (after == stamps_.begin()) return angles_.front();
  if (after == stamps_.end()) return angles_.back();
  const auto i = static_cast<std::size_t>(after - stamps_.begin());
  const double fraction =
      to_seconds(stamp - stamps_[i - 1]) / to_seconds(stamps_[i] - stamps_[i - 1]);
  return (1.0 - fraction) * angles_[i - 1] + fraction * angles_[i];
}

Eigen::Matrix3f GyroRotation::rotation_at(Time stamp) const {
  const Eigen::Vector3d angles = angles_at(stamp);
  return rotation_of({angles.x(), angles.y(), angles.z()}).toRotationMatrix().cast<float>();
}

}  // namespace aims::lio_sam
