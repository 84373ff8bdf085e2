// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/message_decoder.hpp"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "recordings/messages/message_traversal.hpp"
#include "recordings/messages/message_view_impl.hpp"

namespace aims {

struct MessageDecoder::Impl {
  std::shared_ptr<const std::vector<MessageLayout>> layouts;
};

Result<MessageDecoder> MessageDecoder::create(std::string_view type, std::string_view definition) {
  auto layouts = message_layouts(type, definition);
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
  auto view = std::make_shared<MessageView::Impl>();
  view->layouts = impl_->layouts;
  view->bytes = data;
  view->make_room(layout.segment_sizes.size());
  MessageTraversal traversal(*impl_->layouts, data);
  const auto end = traversal.end_of(layout, 0, view->segments());
  if (!end) {
    const TraversalError& error = traversal.error();
    return failure(
        fmt::format("{}: field '{}' needs {} bytes at byte {}, but the message ends at "
                    "byte {}",
                    layout.type, error.field, error.needed, error.offset, data.size()));
  }
  if (*end != data.size()) {
    return failure(fmt::format("{}: expected a message of {} bytes, found {}", layout.type, *end,
                               data.size()));
  }
  MessageView out;
  out.impl_ = std::move(view);
  return out;
}

}  // namespace aims
