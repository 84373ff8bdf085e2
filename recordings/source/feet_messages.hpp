// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "recordings/bag/message_source.hpp"
#include "recordings/messages/message_decoder.hpp"
#include "recordings/source/leg_fields.hpp"

namespace aims {

/// Where a message holds four feet: paths of arrays of four places [m], and of four loads.
struct FeetPaths {
  std::string places, loads;              ///< none: empty
  std::vector<std::string> single_loads;  ///< in place of `loads`: a field for each leg, FL first
};

/// Loads in fields that are called by the legs alike, as "lf", "rf", "lh", "rh" or "FL_contact".
std::optional<FeetPaths> loads_by_name(const MessageDecoder& decoder);

/// Whether a type may hold four feet in arrays, by the names of its fields.
bool may_hold_feet(const BagConnection& connection, const MessageDecoder& decoder);

/// By the names of the fields and the sizes of the arrays in a message; nothing without places.
std::optional<FeetPaths> feet_paths(const BagConnection& connection, const MessageDecoder& decoder,
                                    const MessageView& message);

/// The four feet in the order of the arrays; none where the message lacks one. `time`: without a
/// stamp.
std::vector<LegPartSample> feet_in(const MessageView& message, const FeetPaths& paths, Time time);

}  // namespace aims
