// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/message_decoder.hpp"

#include <fmt/format.h>

#include <bit>
#include <limits>
#include <utility>

#include "recordings/messages/message_traversal.hpp"
#include "recordings/messages/message_view_impl.hpp"

namespace aims {
namespace {

constexpr std::size_t kCdrHeader = 4;

/// The values of a message.
struct Payload {
  std::span<const std::byte> bytes;
  std::endian order = std::endian::little;
  std::size_t max_padding = 0;  ///< behind the last value [bytes]
};

Result<Payload> payload_of(std::span<const std::byte> data, Serialization serialization) {
  if (serialization == Serialization::kRos1) return Payload{data};
  if (data.size() < kCdrHeader) {
    return failure(
        fmt::format("expected the {} bytes of a CDR header, found {}", kCdrHeader, data.size()));
  }
  const auto first = std::to_integer<int>(data[0]);
  const auto second = std::to_integer<int>(data[1]);
  if (first != 0 || second > 1) {
    return failure(fmt::format(
        "expected a header of plain CDR (00 00 or 00 01), found {:02x} {:02x}", first, second));
  }
  return Payload{data.subspan(kCdrHeader), second == 0 ? std::endian::big : std::endian::little, 3};
}

}  // namespace

struct MessageDecoder::Impl {
  std::shared_ptr<const std::vector<MessageLayout>> layouts;
};

Result<MessageDecoder> MessageDecoder::create(std::string_view type, std::string_view definition,
                                              MessageFormat format) {
  if (format.serialization == Serialization::kOther) {
    return failure(fmt::format("{}: expected messages serialized as ros1 or cdr", type));
  }
  auto layouts = message_layouts(type, definition, format);
  if (!layouts) return tl::unexpected(layouts.error());
  auto impl = std::make_shared<Impl>();
  impl->layouts = std::make_shared<const std::vector<MessageLayout>>(std::move(*layouts));
  MessageDecoder decoder;
  decoder.impl_ = std::move(impl);
  return decoder;
}

std::vector<MessageField> MessageDecoder::fields() const {
  std::vector<MessageField> fields;
  for (const FieldSlot& slot : impl_->layouts->back().slots) {
    if (slot.is_placeholder) continue;
    const bool number = slot.kind == FieldKind::kNumber || slot.kind == FieldKind::kNumbers;
    fields.push_back({slot.path, slot.kind,
                      number ? std::optional<NumberType>(slot.number) : std::nullopt,
                      slot.is_bool});
  }
  return fields;
}

Result<MessageView> MessageDecoder::decode(std::span<const std::byte> data) const {
  const MessageLayout& layout = impl_->layouts->back();
  if (data.size() > std::numeric_limits<std::uint32_t>::max()) {
    return failure(
        fmt::format("{}: {} bytes are too many for a message", layout.type, data.size()));
  }
  auto payload = payload_of(data, layout.serialization);
  if (!payload) return failure(fmt::format("{}: {}", layout.type, payload.error().message));
  const std::size_t header = data.size() - payload->bytes.size();
  auto view = std::make_shared<MessageView::Impl>();
  view->layouts = impl_->layouts;
  view->bytes = payload->bytes;
  view->order = payload->order;
  view->make_room(layout.segment_sizes.size());
  MessageTraversal traversal(*impl_->layouts, payload->bytes, payload->order);
  const auto end = traversal.end_of(layout, 0, view->segments());
  if (!end) {
    const TraversalError& error = traversal.error();
    return failure(
        fmt::format("{}: field '{}' needs {} bytes at byte {}, but the message ends at "
                    "byte {}",
                    layout.type, error.field, error.needed, header + error.offset, data.size()));
  }
  if (payload->bytes.size() - *end > payload->max_padding) {
    return failure(fmt::format("{}: expected a message of {} bytes, found {}", layout.type,
                               header + *end, data.size()));
  }
  MessageView out;
  out.impl_ = std::move(view);
  return out;
}

}  // namespace aims
