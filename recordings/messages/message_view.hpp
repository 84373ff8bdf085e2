// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "core/time.hpp"
#include "recordings/messages/number_type.hpp"

namespace aims {

/// One decoded message. Paths are written "pose.pose.position.x", elements "transforms[0].header".
/// An absent path, or a field of another kind, yields nothing. Views point into the decoded bytes.
class MessageView {
 public:
  std::optional<double> number(std::string_view path) const;  ///< any number, or a bool as 0 or 1
  std::optional<Time> time(std::string_view path) const;      ///< a time or duration
  std::optional<std::string_view> text(std::string_view path) const;
  std::optional<std::vector<double>> numbers(std::string_view path) const;  ///< array of numbers
  std::optional<std::vector<std::string_view>> texts(std::string_view path) const;
  std::optional<std::span<const std::byte>> bytes(
      std::string_view path) const;                              ///< uint8[], int8[]
  std::optional<std::size_t> size(std::string_view path) const;  ///< entries of any array
  /// The entries of an array of messages, with paths relative to the entry. One pass, whereas
  /// "path[i].field" starts at the first entry each time.
  std::optional<std::vector<MessageView>> messages(std::string_view path) const;
  /// An array of messages that consist of numbers, bools and times. A time becomes two uint32
  /// columns "name.sec" and "name.nsec"; the fields of a nested message are "name.field".
  std::optional<TableView> table(std::string_view path) const;

 private:
  friend class FieldLookup;
  friend class MessageDecoder;
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace aims
