// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/messages/message_decoder.hpp"

#include <fmt/format.h>

#include <limits>
#include <utility>

#include "recordings/messages/message_view_impl.hpp"
#include "recordings/messages/message_walk.hpp"

namespace aims {

struct MessageDecoder::Impl {
  std::shared_ptr<const std::vector<MessagePlan>> plans;
};

Result<MessageDecoder> MessageDecoder::create(std::string_view type, std::string_view definition) {
  auto plans = plan_message(type, definition);
  if (!plans) return tl::unexpected(plans.error());
  auto impl = std::make_shared<Impl>();
  impl->plans = std::make_shared<const std::vector<MessagePlan>>(std::move(*plans));
  MessageDecoder decoder;
  decoder.impl_ = std::move(impl);
  return decoder;
}

std::vector<MessageField> MessageDecoder::fields() const {
  std::vector<MessageField> fields;
  for (const MessageSlot& slot : impl_->plans->back().slots) {
    const bool number = slot.kind == FieldKind::kNumber || slot.kind == FieldKind::kNumbers;
    fields.push_back({slot.path, slot.kind,
                      number ? std::optional<NumberType>(slot.number) : std::nullopt,
                      slot.is_bool});
  }
  return fields;
}

Result<MessageView> MessageDecoder::decode(std::span<const std::byte> data) const {
  const MessagePlan& plan = impl_->plans->back();
  if (data.size() > std::numeric_limits<std::uint32_t>::max()) {
    return failure(fmt::format("{}: {} bytes are too many for a message", plan.type, data.size()));
  }
  auto view = std::make_shared<MessageView::Impl>();
  view->plans = impl_->plans;
  view->bytes = data;
  view->make_room(plan.segment_sizes.size());
  MessageWalk walk(*impl_->plans, data);
  const auto end = walk.end_of(plan, 0, view->segments());
  if (!end) {
    const WalkError& error = walk.error();
    return failure(
        fmt::format("{}: field '{}' needs {} bytes at byte {}, but the message ends at "
                    "byte {}",
                    plan.type, error.field, error.wanted, error.offset, data.size()));
  }
  if (*end != data.size()) {
    return failure(
        fmt::format("{}: expected a message of {} bytes, found {}", plan.type, *end, data.size()));
  }
  MessageView out;
  out.impl_ = std::move(view);
  return out;
}

}  // namespace aims
