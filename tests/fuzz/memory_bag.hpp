// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "recordings/bag/bag_output.hpp"
#include "recordings/bag/bag_publisher.hpp"
#include "recordings/bag/bag_writer.hpp"
#include "tests/fuzz/demand.hpp"

namespace aims {

/// A bag of ROS 1 in memory.
class MemoryBag {
 public:
  MemoryBag()
      : writer_(*BagWriter::create(std::make_unique<Output>(bytes_), "fuzz.bag",
                                   {BagCompression::kNone, 1 << 14})) {}

  /// Topics are numbered from 0.
  std::uint32_t add(const std::string& topic, const MessageType& type) {
    writer_.add_connection(topic, type);
    return topics_++;
  }

  void write(std::uint32_t topic, Time time, std::span<const std::byte> message) {
    demand(writer_.write(topic, time, message).has_value());
  }

  /// Of the whole bag; nothing can be written after.
  const std::vector<std::byte>& bytes() {
    demand(writer_.close().has_value());
    return bytes_;
  }

 private:
  class Output final : public BagOutput {
   public:
    explicit Output(std::vector<std::byte>& bytes) : bytes_(bytes) {
      bytes_ = BagPublisher::empty_bag();
    }
    Result<void> write_at(std::uint64_t offset, std::span<const std::byte> bytes) override {
      if (bytes_.size() < offset + bytes.size()) bytes_.resize(offset + bytes.size());
      std::copy(bytes.begin(), bytes.end(), bytes_.begin() + static_cast<std::ptrdiff_t>(offset));
      return {};
    }
    Result<void> truncate(std::uint64_t size) override {
      bytes_.resize(size);
      return {};
    }
    Result<void> close() override { return {}; }

   private:
    std::vector<std::byte>& bytes_;
  };

  std::vector<std::byte> bytes_;
  BagWriter writer_;
  std::uint32_t topics_ = 0;
};

}  // namespace aims
