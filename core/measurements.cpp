// SPDX-License-Identifier: BSD-3-Clause
#include "core/measurements.hpp"

namespace aims {
namespace {

Time stamp(const LidarScanPtr& scan) { return scan->end; }
template <class Sample>
Time stamp(const Sample& sample) {
  return sample.stamp;
}

}  // namespace

Time stamp_of(const Measurement& measurement) {
  return std::visit([](const auto& each) { return stamp(each); }, measurement);
}

}  // namespace aims
