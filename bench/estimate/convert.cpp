// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/convert.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <system_error>

#include "bench/estimate/new_recording.hpp"
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
