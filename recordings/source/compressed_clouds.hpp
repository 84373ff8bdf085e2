// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>

#include "core/error.hpp"
#include "recordings/bag/message_source.hpp"

namespace aims {

/// Where a recording holds point_cloud_interfaces/CompressedPointCloud2 (point_cloud_transport) of
/// format zlib or zstd, replaces `source` by one that also has them as sensor_msgs/PointCloud2 on
/// TOPIC/points. Error for a recording whose only clouds are compressed otherwise (draco, cloudini,
/// ...), which names topic, format and remedy; `source` is then unchanged. Rewinds.
Result<void> unpack_clouds(std::unique_ptr<MessageSource>& source);

}  // namespace aims
