// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/convert.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <set>
#include <string>
#include <system_error>
#include <vector>

#include "bench/estimate/new_recording.hpp"
#include "core/config.hpp"
#include "core/stopwatch.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

Result<ConversionOutcome> write_recording(MessageSource& source, const fs::path& file,
                                          RecordingFormat format, const ConvertOptions& options,
                                          const Observer& observer) {
  auto sink = create_recording(file, format, {.compression = options.compression});
  if (!sink) return tl::unexpected(sink.error());
  const Stopwatch stopwatch;
  const Time start = source.summary().start;
  const double length_s = to_seconds(source.summary().end - start);
  return convert_messages(source, **sink, [&](Time time) {
    return observer({to_seconds(time - start), length_s, stopwatch.seconds()});
  });
}

/// Restricts the source to the other topics.
Result<void> drop_topics(MessageSource& source, const std::vector<std::string>& drop) {
  if (drop.empty()) return {};
  std::vector<std::string> topics;
  for (const BagConnection& each : source.connections()) topics.push_back(each.topic);
  for (const std::string& topic : drop) {
    if (std::ranges::find(topics, topic) != topics.end()) continue;
    const std::string near = near_match(topic, topics);
    return failure(fmt::format("{}: no topic '{}' to leave out{}; it has {}", source.name(), topic,
                               near.empty() ? "" : fmt::format("; did you mean '{}'?", near),
                               fmt::join(std::set(topics.begin(), topics.end()), ", ")));
  }
  std::erase_if(topics, [&](const std::string& topic) {
    return std::ranges::find(drop, topic) != drop.end();
  });
  if (topics.empty()) return failure(source.name() + ": every topic is to be left out");
  source.select(topics);
  return {};
}

}  // namespace

Result<ConvertOutcome> convert(const ConvertOptions& options, const Observer& observer) {
  const auto format = format_of_new(options.to);
  if (!format) return tl::unexpected(format.error());
  auto source = open_recording(options.from, {.recover = options.recover, .with = options.with});
  if (!source) return tl::unexpected(source.error());
  std::error_code ignored;
  const auto is_output = [&](const fs::path& file) {
    return fs::equivalent(file, path_of_new(options.to), ignored);
  };
  if (is_output(options.from) || std::ranges::any_of(options.with, is_output)) {
    return failure(
        fmt::format("{}: is the recording itself; choose another --out", options.to.string()));
  }
  if (auto chosen = drop_topics(**source, options.drop); !chosen) {
    return tl::unexpected(chosen.error());
  }
  const auto partial = begin_recording(path_of_new(options.to), options.overwrite);
  if (!partial) return tl::unexpected(partial.error());
  ConvertOutcome outcome;
  outcome.lost_bytes = (*source)->summary().lost_bytes;
  if ((*source)->summary().untimed_rows > 0) outcome.left_out = untimed_text((*source)->summary());
  const auto content = write_recording(**source, *partial, *format, options, observer);
  Result<void> ok;
  if (content && content->complete) {
    outcome.content = *content;
    outcome.bytes = recording_size(*partial);
    ok = publish_recording(*partial, path_of_new(options.to));
  } else if (!content) {
    ok = tl::unexpected(content.error());
  }
  fs::remove_all(*partial, ignored);
  if (!ok) return tl::unexpected(ok.error());
  return outcome;
}

}  // namespace aims
