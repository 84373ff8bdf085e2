// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "recordings/messages/message_layout.hpp"
#include "recordings/messages/message_view.hpp"

namespace aims {

/// A decoded message: its bytes, and where its segments start.
struct MessageView::Impl {
  std::shared_ptr<const std::vector<MessageLayout>> layouts;
  std::optional<std::uint32_t> root;  ///< layout of an array's entry; none: the type's own
  std::span<const std::byte> bytes;   ///< of the whole message, without the header of CDR
  std::size_t start = 0;              ///< of an array's entry, in `bytes`
  std::endian order = std::endian::little;

  const MessageLayout& layout() const { return root ? (*layouts)[*root] : layouts->back(); }

  void make_room(std::size_t segments) {
    if (segments > few_.size()) many_.resize(segments);
  }
  std::uint32_t* segments() { return many_.empty() ? few_.data() : many_.data(); }
  const std::uint32_t* segments() const { return many_.empty() ? few_.data() : many_.data(); }

 private:
  std::array<std::uint32_t, 16> few_;  ///< enough for most types, without an allocation
  std::vector<std::uint32_t> many_;
};

}  // namespace aims
