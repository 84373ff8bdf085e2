// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "core/error.hpp"
#include "recordings/messages/message_type.hpp"
#include "recordings/messages/message_view.hpp"
#include "recordings/messages/number_type.hpp"

namespace aims {

/// Kind of a message field.
enum class FieldKind { kNumber, kTime, kText, kNumbers, kTimes, kTexts, kMessages };

/// A field of a message, by its path; an array of messages is one field.
struct MessageField {
  std::string path;
  FieldKind kind = FieldKind::kNumber;
  std::optional<NumberType> number;  ///< of numbers; bools are kUint8
  bool is_bool = false;
};

/// Decodes the messages of one connection by the definition in the bag.
class MessageDecoder {
 public:
  /// Error for a definition that cannot be read, naming the line and the type.
  static Result<MessageDecoder> create(std::string_view type, std::string_view definition,
                                       MessageFormat format = kRos1Format);

  /// All fields in the order of the definition, those of nested messages in place.
  std::vector<MessageField> fields() const;

  /// Error for too few or too many bytes, naming the field and the offset; CDR may pad the end by
  /// up to three bytes. Memory is bounded by a small multiple of the size of `data`.
  Result<MessageView> decode(std::span<const std::byte> data) const;

 private:
  struct Impl;
  std::shared_ptr<const Impl> impl_;
};

}  // namespace aims
