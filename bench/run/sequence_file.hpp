// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/error.hpp"
#include "core/files/atomic_file.hpp"
#include "core/files/mapped_file.hpp"
#include "core/measurements.hpp"
#include "sim/robot/truth.hpp"

namespace aims {

/// Writes a simulated sequence as one file, bit for bit what the simulation yielded: the rig, every
/// delivery in order of arrival, and of the truth what scores are made from (motion at the physics
/// rate, slip of the feet, joints at 10 Hz, waypoint times, information of the scans; no biases). A
/// bag holds the truth at 10 ms alone and nothing of the scans, so that scores would differ.
/// Little-endian numbers, one after the other; 22 bytes per return. The file appears at once, on
/// finish().
class SequenceWriter {
 public:
  /// `origin` is kept as text: what the sequence is of.
  static Result<SequenceWriter> create(const std::filesystem::path& file, const SensorRig& rig,
                                       std::string_view origin);

  Result<void> write(std::span<const Delivery> deliveries);
  /// Appends the truth and puts the file in its place.
  Result<void> finish(const Truth& truth);

 private:
  explicit SequenceWriter(AtomicFile file) : file_(std::move(file)) {}
  Result<void> flush();

  AtomicFile file_;
  std::vector<std::byte> buffer_;
  std::size_t flushed_ = 0;  ///< bytes in the file
};

/// Whether something is to be done with a scan.
using ScanFilter = std::function<bool(const LidarScan&)>;

/// Reads what `SequenceWriter` wrote. Measurements are read as they are asked for: memory is that
/// of one scan, and processes that read one sequence have its pages in common.
class SequenceReader {
 public:
  /// Error when the file is no sequence, of another format, or cut short.
  static Result<SequenceReader> open(const std::filesystem::path& file);

  const SensorRig& rig() const { return rig_; }
  /// The truth, read from the file each time.
  Truth truth() const;
  const std::string& origin() const { return origin_; }
  std::size_t size() const { return file_.bytes().size(); }

  /// Hands over every delivery, in order of arrival. Error for bytes that are no delivery.
  Result<void> replay(const std::function<void(const Delivery&)>& visit) const;
  /// The same with scans that have no points, at a fraction of the time.
  Result<void> replay_without_points(const std::function<void(const Delivery&)>& visit) const;
  /// The same with the points of those scans alone for which `wanted` holds; it gets them without.
  Result<void> replay_some_points(const ScanFilter& wanted,
                                  const std::function<void(const Delivery&)>& visit) const;

 private:
  SequenceReader(std::filesystem::path path, MappedFile file)
      : path_(std::move(path)), file_(std::move(file)) {}
  bool read_header();

  std::filesystem::path path_;
  MappedFile file_;
  std::span<const std::byte> deliveries_;
  std::span<const std::byte> truth_;
  SensorRig rig_;
  std::string origin_;
};

}  // namespace aims
