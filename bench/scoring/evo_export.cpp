// SPDX-License-Identifier: BSD-3-Clause
#include "bench/scoring/evo_export.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstdint>
#include <span>
#include <vector>

#include "bench/scoring/json_text.hpp"
#include "core/file_name.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/crc32.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// Appends the low `bytes` bytes of a number, the lowest first.
void append(std::string& text, std::uint64_t number, int bytes) {
  for (int i = 0; i < bytes; ++i) text += static_cast<char>(number >> (8 * i) & 0xff);
}

/// A ZIP archive of files that are stored as they are (APPNOTE 6.3.3, sections 4.3.7 to 4.3.16).
class ZipArchive {
 public:
  void add(const std::string& name, const std::string& content) {
    const auto offset = text_.size();
    const std::uint32_t crc = crc32_of(std::as_bytes(std::span(content)));
    const std::string fields = file_fields(name, content.size(), crc);
    append(text_, 0x04034b50, 4);
    text_ += fields + name + content;
    append(directory_, 0x02014b50, 4);
    append(directory_, kVersion, 2);
    directory_ += fields;
    append(directory_, 0, 10);  // comment, disk, attributes
    append(directory_, offset, 4);
    directory_ += name;
    ++count_;
  }

  std::string bytes() const {
    std::string all = text_ + directory_;
    append(all, 0x06054b50, 4);
    append(all, 0, 4);
    append(all, count_, 2);
    append(all, count_, 2);
    append(all, directory_.size(), 4);
    append(all, text_.size(), 4);
    append(all, 0, 2);
    return all;
  }

 private:
  static constexpr int kVersion = 20;

  /// What a file's own header and its entry in the directory share.
  static std::string file_fields(const std::string& name, std::size_t size, std::uint32_t crc) {
    constexpr int kFirstOf1980 = 0x21;
    std::string text;
    append(text, kVersion, 2);
    append(text, 0, 6);  // flags, stored, midnight
    append(text, kFirstOf1980, 2);
    append(text, crc, 4);
    append(text, size, 4);
    append(text, size, 4);
    append(text, name.size(), 2);
    append(text, 0, 2);
    return text;
  }

  std::string text_;
  std::string directory_;
  std::uint64_t count_ = 0;
};

/// A vector as a file of NumPy, format 1.0.
std::string npy(const std::vector<double>& values) {
  std::string header =
      fmt::format("{{'descr': '<f8', 'fortran_order': False, 'shape': ({},), }}", values.size());
  constexpr std::size_t kBefore = 10;
  header.append(63 - (kBefore + header.size()) % 64, ' ');
  header += '\n';
  std::string text = "\x93NUMPY\x01";
  text += '\0';
  append(text, header.size(), 2);
  text += header;
  for (const double value : values) append(text, std::bit_cast<std::uint64_t>(value), 8);
  return text;
}

Json statistics(const std::vector<double>& errors, const Scores& scores) {
  double squares = 0.0;
  for (const double each : errors) squares += each * each;
  const AbsoluteErrorStatistics statistics = scores.ape_yaw.value_or(AbsoluteErrorStatistics());
  return {{"rmse", scores.ate_yaw_m.value_or(0.0)},
          {"mean", statistics.mean_m},
          {"median", statistics.median_m},
          {"std", statistics.std_m},
          {"min", statistics.min_m},
          {"max", statistics.max_m},
          {"sse", squares}};
}

}  // namespace

std::string evo_archive(const ScoredEstimate& estimate, const TrajectoryScores& scores) {
  const std::vector<PosePair> pairs =
      headline_pairs(estimate.given.trajectory, scores.truth.trajectory, scores.scoring);
  std::vector<double> stamps;
  std::vector<double> seconds;
  std::vector<double> distances;
  for (const PosePair& each : pairs) {
    const double step =
        stamps.empty()
            ? 0.0
            : (each.truth.translation - pairs[stamps.size() - 1].truth.translation).norm();
    distances.push_back((distances.empty() ? 0.0 : distances.back()) + step);
    stamps.push_back(to_seconds(each.stamp));
    seconds.push_back(to_seconds(each.stamp - pairs.front().stamp));
  }
  const std::vector<double> errors = position_errors(pairs);
  const Json info = {
      {"title", "APE w.r.t. translation part (m)\n(with alignment by yaw and translation)"},
      {"label", "APE (m)"},
      {"ref_name", scores.truth.name},
      {"est_name", estimate.given.name}};
  ZipArchive archive;
  archive.add("info.json", json_text(info, 1));
  archive.add("stats.json", json_text(statistics(errors, estimate.scores), 1));
  archive.add("error_array.npy", npy(errors));
  archive.add("timestamps.npy", npy(stamps));
  archive.add("seconds_from_start.npy", npy(seconds));
  archive.add("distances_from_start.npy", npy(distances));
  return archive.bytes();
}

Result<void> write_evo_archives(const TrajectoryScores& scores, const fs::path& folder) {
  for (const ScoredEstimate& each : scores.estimates) {
    if (!check_file_name("--name", each.given.name)) continue;
    auto written =
        write_file_atomically(folder / (each.given.name + ".evo.zip"), evo_archive(each, scores));
    if (!written) return written;
  }
  return {};
}

}  // namespace aims
