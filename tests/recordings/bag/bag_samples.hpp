// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "core/files/atomic_file.hpp"
#include "core/files/byte_cursor.hpp"
#include "recordings/bag/bag_reader.hpp"
#include "recordings/bag/bag_writer.hpp"
#include "recordings/messages/message_types.hpp"

namespace aims {

/// A message as a test wrote it or read it, with its own copy of the bytes.
struct SampleMessage {
  std::string topic;
  Time time = 0;
  std::string bytes;

  bool operator==(const SampleMessage&) const = default;
};

/// Writes a file without waiting for the disk; false when that fails.
inline bool put_file(const std::filesystem::path& file, std::string_view bytes) {
  // Some file systems wait for the disk when a file is cut and written again, not for a new one.
  std::filesystem::remove(file);
  std::ofstream stream(file, std::ios::binary);
  stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  return static_cast<bool>(stream.flush());
}

/// Every message of a bag until its end or an error.
struct ReadOutcome {
  std::vector<SampleMessage> messages;
  std::string error;  ///< empty: none
  ErrorKind kind = ErrorKind::kOther;
  BagSummary summary;
};

template <class Reader = BagReader>
ReadOutcome read_all(const std::filesystem::path& file, BagOpenOptions options = {}) {
  ReadOutcome outcome;
  const auto fail = [&outcome](const Error& error) {
    outcome.error = error.message;
    outcome.kind = error.kind;
    return outcome;
  };
  auto bag = Reader::open(file, options);
  if (!bag) return fail(bag.error());
  outcome.summary = bag->summary();
  while (true) {
    const auto message = bag->next();
    if (!message) return fail(message.error());
    if (!*message) return outcome;
    const BagMessage& each = **message;
    outcome.messages.push_back(
        {each.connection->topic, each.record_time, std::string(as_text(each.data))});
  }
}

/// Writes the messages in order to a new bag.
template <class Writer = BagWriter>
void write_bag(const std::filesystem::path& file, const std::vector<SampleMessage>& messages,
               BagWriterOptions options = {}) {
  auto bag = Writer::create(file, options);
  ASSERT_TRUE(bag) << bag.error().message;
  std::vector<std::string> topics;
  for (const SampleMessage& each : messages) {
    std::size_t id = 0;
    while (id < topics.size() && topics[id] != each.topic) ++id;
    if (id == topics.size()) {
      topics.push_back(each.topic);
      bag->add_connection(each.topic, string_type(), false);
    }
    const auto written =
        bag->write(static_cast<std::uint32_t>(id), each.time, bytes_of(each.bytes));
    ASSERT_TRUE(written) << written.error().message;
  }
  const auto closed = bag->close();
  ASSERT_TRUE(closed) << closed.error().message;
}

/// Twelve messages of two topics, 10 ms apart.
inline std::vector<SampleMessage> few_messages() {
  std::vector<SampleMessage> messages;
  for (int i = 0; i < 12; ++i) {
    messages.push_back({i % 3 == 0 ? "/b" : "/a", kSecond + i * 10 * kMillisecond,
                        "message " + std::to_string(i) + std::string(40, '.')});
  }
  return messages;
}

/// Writes a number over the value of the nth field of that name ("size="), counted from 0.
template <class T>
void patch(std::string& bytes, std::string_view field, int nth, T value) {
  std::size_t at = bytes.find(field);
  for (int i = 0; i < nth && at != std::string::npos; ++i) at = bytes.find(field, at + 1);
  ASSERT_NE(at, std::string::npos) << field;
  std::memcpy(bytes.data() + at + field.size(), &value, sizeof(value));
}

}  // namespace aims
