// SPDX-License-Identifier: BSD-3-Clause
#include "tests/fuzz/touch.hpp"

#include <algorithm>
#include <string>
#include <vector>

#include "recordings/bag/bag_reader.hpp"
#include "recordings/stream/recording_reader.hpp"
#include "tests/fuzz/demand.hpp"

namespace aims {
namespace {

constexpr std::size_t kMemoryLimit = std::size_t{16} << 20;
/// Lists claim more entries than are worth looking at.
constexpr std::size_t kMostEntries = 20;

void touch_table(const TableView& table) {
  demand(table.rows * table.stride <= table.bytes.size());
  double sum = 0.0;
  for (const ColumnLayout& column : table.columns) {
    demand(column.offset + column.count * size_of(column.type) <= table.stride);
    for (std::size_t row = 0; row < std::min(table.rows, kMostEntries); ++row) {
      sum += number_at(table.bytes.data() + row * table.stride + column.offset, column.type);
    }
  }
  demand(table.find("no such column") == nullptr || sum != 0.0);
}

void touch_array(const MessageView& view, const MessageField& field) {
  const auto size = view.size(field.path);
  demand(size.has_value());
  if (const auto numbers = view.numbers(field.path)) demand(numbers->size() == *size);
  if (const auto texts = view.texts(field.path)) demand(texts->size() == *size);
  if (const auto bytes = view.bytes(field.path)) demand(bytes->size() == *size);
  if (const auto table = view.table(field.path)) touch_table(*table);
  for (std::size_t i = 0; i < std::min(*size + 1, kMostEntries); ++i) {
    const std::string entry = field.path + "[" + std::to_string(i) + "]";
    const bool plain = view.number(entry) || view.text(entry) || view.time(entry);
    demand(plain == (i < *size && field.kind != FieldKind::kMessages));
    for (const char* rest : {".header.stamp", ".child_frame_id", ".x", ".a", ".a[1].a"}) {
      static_cast<void>(view.number(entry + rest));
      static_cast<void>(view.text(entry + rest));
    }
  }
}

}  // namespace

void touch_message(const MessageDecoder& decoder, std::span<const std::byte> bytes) {
  const auto view = decoder.decode(bytes);
  if (!view) return;
  for (const MessageField& field : decoder.fields()) {
    if (field.kind >= FieldKind::kNumbers) {
      touch_array(*view, field);
    } else {
      demand(view->number(field.path) || view->text(field.path) || view->time(field.path));
    }
  }
}

void touch_recording(const std::filesystem::path& bag, bool recover,
                     const RecordingConfig& config) {
  auto recording = RecordingReader::open(bag, config, {recover, kMemoryLimit});
  if (!recording) return;
  std::vector<Delivery> deliveries;
  // Record times may lie a century apart: a long step, and no more than a few.
  for (int step = 0; step < 100; ++step) {
    const auto more = recording->advance(step < 50 ? kSecond : 100'000'000 * kSecond, deliveries);
    deliveries.clear();
    if (!more || !*more) return;
  }
}

}  // namespace aims
