// SPDX-License-Identifier: BSD-3-Clause
#include "bench/run/sequence_file.hpp"

#include <fmt/format.h>

#include <memory>
#include <optional>
#include <utility>

#include "bench/run/sequence_encoding.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view kBegin = "aimsseqn";
constexpr std::string_view kEnd = "seqndone";
constexpr std::uint32_t kFormat = 6;
/// At the end of the file: where the truth begins, and `kEnd`.
constexpr std::size_t kTrailerSize = sizeof(std::uint64_t) + kEnd.size();

}  // namespace

Result<SequenceWriter> SequenceWriter::create(const fs::path& file, const SensorRig& rig,
                                              std::string_view origin) {
  auto atomic = AtomicFile::create(file);
  if (!atomic) return tl::unexpected(atomic.error());
  SequenceWriter writer(std::move(*atomic));
  append(writer.buffer_, bytes_of(kBegin));
  append_number(writer.buffer_, kFormat);
  append_rig(writer.buffer_, rig);
  append_text(writer.buffer_, origin);
  return writer;
}

Result<void> SequenceWriter::write(std::span<const Delivery> deliveries) {
  for (const Delivery& delivery : deliveries) append_delivery(buffer_, delivery);
  return flush();
}

Result<void> SequenceWriter::finish(const Truth& truth) {
  const std::uint64_t truth_begin = flushed_ + buffer_.size();
  append_truth(buffer_, truth);
  append_number(buffer_, truth_begin);
  append(buffer_, bytes_of(kEnd));
  if (auto flushed = flush(); !flushed) return flushed;
  // It can be made again, and flushing takes longer than simulating.
  return file_.commit(false);
}

Result<void> SequenceWriter::flush() {
  auto written = file_.write(buffer_);
  flushed_ += buffer_.size();
  buffer_.clear();
  return written;
}

Result<SequenceReader> SequenceReader::open(const fs::path& file) {
  auto mapped = MappedFile::open(file);
  if (!mapped) return tl::unexpected(mapped.error());
  SequenceReader reader(file, std::move(*mapped));
  if (reader.read_header()) return reader;
  return failure(
      fmt::format("{}: expected a whole recorded sequence of format {}; delete it and it is "
                  "simulated again",
                  file.string(), kFormat));
}

bool SequenceReader::read_header() {
  const std::span<const std::byte> all = file_.bytes();
  if (all.size() < kTrailerSize) return false;
  ByteCursor trailer(all.last(kTrailerSize));
  const auto truth_begin = trailer.number<std::uint64_t>();
  if (as_text(*trailer.take(kEnd.size())) != kEnd) return false;
  ByteCursor cursor(all.first(all.size() - kTrailerSize));
  const auto magic = cursor.take(kBegin.size());
  if (!magic || as_text(*magic) != kBegin || cursor.number<std::uint32_t>() != kFormat) {
    return false;
  }
  if (!take_rig(cursor, rig_) || !take_text(cursor, origin_)) return false;
  const std::size_t begin = cursor.position();
  if (*truth_begin < begin || *truth_begin > all.size() - kTrailerSize) return false;
  deliveries_ = all.subspan(begin, *truth_begin - begin);
  truth_ = all.subspan(*truth_begin, all.size() - kTrailerSize - *truth_begin);
  Truth truth;
  ByteCursor truth_cursor(truth_);
  return take_truth(truth_cursor, truth) && truth_cursor.left() == 0;
}

Truth SequenceReader::truth() const {
  Truth truth;
  ByteCursor cursor(truth_);
  take_truth(cursor, truth);  // `open` has tried
  return truth;
}

Result<void> SequenceReader::replay(const std::function<void(const Delivery&)>& visit) const {
  return replay_some_points([](const LidarScan&) { return true; }, visit);
}

Result<void> SequenceReader::replay_without_points(
    const std::function<void(const Delivery&)>& visit) const {
  return replay_some_points([](const LidarScan&) { return false; }, visit);
}

Result<void> SequenceReader::replay_some_points(
    const ScanFilter& wanted, const std::function<void(const Delivery&)>& visit) const {
  ByteCursor cursor(deliveries_);
  while (cursor.left() > 0) {
    const std::size_t at = cursor.position();
    const auto delivery = take_delivery(cursor, wanted);
    if (!delivery) {
      return failure(
          fmt::format("{}: no delivery at byte {} of the stream; delete the file and it "
                      "is simulated again",
                      path_.string(), at));
    }
    visit(*delivery);
  }
  return {};
}

}  // namespace aims
