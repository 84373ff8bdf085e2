// SPDX-License-Identifier: BSD-3-Clause
#include "live/recorder.hpp"

#include <fmt/format.h>

#include <utility>

#include "recordings/source/recording_file.hpp"

namespace aims {

Result<Recorder> Recorder::create(const std::filesystem::path& file, MessageFormat format) {
  Recorder recorder;
  if (file.empty()) return recorder;
  const bool cdr = format.serialization == Serialization::kCdr;
  const RecordingFormat wanted = cdr ? RecordingFormat::kMcap : RecordingFormat::kBag;
  if (format_by_name(file) != wanted) {
    return failure(
        fmt::format("{}: expected a name that ends in {}", file.string(), cdr ? ".mcap" : ".bag"));
  }
  auto sink = create_recording(file, wanted);
  if (!sink) return tl::unexpected(sink.error());
  recorder.sink_ = std::move(*sink);
  recorder.converter_.emplace("live topics", *recorder.sink_);
  return recorder;
}

void Recorder::add(const BagMessage& message) {
  if (!converter_ || !state_) return;
  const BagConnection& from = *message.connection;
  const auto [place, added] = connections_.try_emplace({from.topic, from.type, from.md5}, from);
  if (added) place->second.id = static_cast<std::uint32_t>(connections_.size());
  BagMessage own = message;
  own.connection = &place->second;
  state_ = converter_->write(own);
}

Result<void> Recorder::close() {
  if (!sink_) return {};
  const auto closed = sink_->close();
  return state_ ? closed : state_;
}

}  // namespace aims
