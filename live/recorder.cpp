// SPDX-License-Identifier: BSD-3-Clause
#include "live/recorder.hpp"

#include <fmt/format.h>

#include <system_error>
#include <utility>

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
  recorder.file_ = file;
  recorder.kind_ = wanted;
  if (auto ok = recorder.open(); !ok) return tl::unexpected(ok.error());
  return recorder;
}

Result<void> Recorder::open() {
  auto sink = create_recording(file_, kind_);
  if (!sink) return tl::unexpected(sink.error());
  sink_ = std::move(*sink);
  converter_.emplace("live topics", *sink_);
  return {};
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

void Recorder::begin_again() {
  if (file_.empty()) return;
  converter_.reset();
  sink_.reset();
  connections_.clear();
  std::error_code code;
  std::filesystem::remove(file_, code);  // it is of this recorder; `open` replaces none
  state_ = open();
}

Result<void> Recorder::close() {
  if (!sink_) return state_;
  const auto closed = sink_->close();
  return state_ ? closed : state_;
}

}  // namespace aims
