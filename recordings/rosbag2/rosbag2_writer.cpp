// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/rosbag2/rosbag2_writer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <set>
#include <system_error>
#include <utility>
#include <vector>

#include "core/files/atomic_file.hpp"
#include "core/files/sqlite_database.hpp"
#include "recordings/messages/message_definition.hpp"
#include "recordings/messages/quality_of_service.hpp"
#include "recordings/rosbag2/rosbag2_metadata.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// SQLite's own limit of a value.
constexpr std::size_t kMaxMessageBytes = 1'000'000'000;

/// Version 4 of rosbag2's schema (ROS 2 Iron). Hashes of types are unknown: rosbag2 writes them
/// empty too, then.
constexpr const char* kSchema = R"(
CREATE TABLE schema(schema_version INTEGER PRIMARY KEY, ros_distro TEXT NOT NULL);
CREATE TABLE metadata(id INTEGER PRIMARY KEY, metadata_version INTEGER NOT NULL,
  metadata TEXT NOT NULL);
CREATE TABLE topics(id INTEGER PRIMARY KEY, name TEXT NOT NULL, type TEXT NOT NULL,
  serialization_format TEXT NOT NULL, offered_qos_profiles TEXT NOT NULL,
  type_description_hash TEXT NOT NULL);
CREATE TABLE message_definitions(id INTEGER PRIMARY KEY, topic_type TEXT NOT NULL,
  encoding TEXT NOT NULL, encoded_message_definition TEXT NOT NULL,
  type_description_hash TEXT NOT NULL);
CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id INTEGER NOT NULL,
  timestamp INTEGER NOT NULL, data BLOB NOT NULL);
CREATE INDEX timestamp_idx ON messages (timestamp ASC);
INSERT INTO schema VALUES (4, 'aims');
)";

/// What is committed is in the file or beside it in its log, also of a process that is killed.
constexpr const char* kBegin = "PRAGMA journal_mode = WAL; PRAGMA synchronous = OFF;";
/// Back to one file.
constexpr const char* kEnd = "PRAGMA journal_mode = DELETE;";

}  // namespace

struct Rosbag2Writer::Impl {
  fs::path folder;
  fs::path file;
  std::size_t batch = 0;  ///< bytes between commits
  SqliteDatabase database;
  SqliteStatement message;
  std::vector<BagConnection> topics = {};
  std::set<std::string> defined = {};
  std::size_t pending = 0;  ///< bytes since the last commit
  std::optional<std::pair<Time, Time>> span = {};
  bool closed = false;
  std::optional<Error> broken = {};  ///< the first error, returned by every later call

  Result<void> announce(const BagConnection& topic);
  Result<void> commit();
  Result<void> close_file();
  tl::unexpected<Error> refuse(const std::string& why) const {
    return failure(fmt::format("{}: {}", file.string(), why));
  }
};

Result<void> Rosbag2Writer::Impl::announce(const BagConnection& topic) {
  const std::string type = ros2_type_name(topic.type);
  if (defined.insert(type).second) {
    auto definition =
        database.prepare("INSERT INTO message_definitions VALUES (NULL, ?1, ?2, ?3, '')");
    if (!definition) return tl::unexpected(definition.error());
    const bool idl = topic.format.language == DefinitionLanguage::kRos2Idl;
    const std::string_view encoding = idl ? "ros2idl" : "ros2msg";
    auto ok = definition->bind(1, type).bind(2, encoding).bind(3, topic.definition).finish();
    if (!ok) return ok;
  }
  auto row = database.prepare("INSERT INTO topics VALUES (?1, ?2, ?3, 'cdr', ?4, '')");
  if (!row) return tl::unexpected(row.error());
  const std::string quality = offered_quality(topic.latching);
  return row->bind(1, std::int64_t{topic.id} + 1)
      .bind(2, topic.topic)
      .bind(3, type)
      .bind(4, quality)
      .finish();
}

Result<void> Rosbag2Writer::Impl::commit() {
  pending = 0;
  return database.run("COMMIT; BEGIN");
}

Result<void> Rosbag2Writer::Impl::close_file() {
  if (auto ok = database.run("COMMIT"); !ok) return ok;
  message.reset();
  if (auto ok = database.run(kEnd); !ok) return ok;
  const auto [start, end] = span.value_or(std::pair<Time, Time>(0, 0));
  return write_file_atomically(folder / kRosbag2Metadata,
                               rosbag2_metadata_text(file.filename().string(), topics, start, end));
}

Rosbag2Writer::Rosbag2Writer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Rosbag2Writer::Rosbag2Writer(Rosbag2Writer&&) noexcept = default;

Rosbag2Writer& Rosbag2Writer::operator=(Rosbag2Writer&& other) noexcept {
  std::swap(impl_, other.impl_);
  return *this;
}

Rosbag2Writer::~Rosbag2Writer() {
  if (impl_) static_cast<void>(close());
}

Result<Rosbag2Writer> Rosbag2Writer::create(const fs::path& folder, BagWriterOptions options) {
  if (options.compression != BagCompression::kNone) {
    return failure(fmt::format("{}: compression {}: expected none for a folder of rosbag2",
                               folder.string(), name_of(options.compression)));
  }
  std::error_code code;
  if (!fs::create_directory(folder, code)) {
    return failure(fmt::format("{}: cannot be created: {}", folder.string(),
                               code ? code.message() : "File exists"));
  }
  const fs::path file = folder / (folder.stem().string() + "_0.db3");
  auto database = SqliteDatabase::create(file);
  if (!database) return tl::unexpected(database.error());
  auto ok = database->run(std::string(kBegin) + kSchema + "BEGIN;");
  if (!ok) return tl::unexpected(ok.error());
  auto message = database->prepare("INSERT INTO messages VALUES (NULL, ?1, ?2, ?3)");
  if (!message) return tl::unexpected(message.error());
  return Rosbag2Writer(std::unique_ptr<Impl>(
      new Impl{folder, file, options.chunk_size, std::move(*database), std::move(*message)}));
}

std::uint32_t Rosbag2Writer::add_connection(const std::string& topic, const MessageType& type,
                                            bool latching) {
  Impl& rosbag = *impl_;
  BagConnection added;
  added.id = static_cast<std::uint32_t>(rosbag.topics.size());
  added.topic = topic;
  added.type = type.name;
  added.definition = type.definition;
  added.latching = latching;
  added.format = type.format;
  if (!rosbag.broken) {
    if (auto ok = rosbag.announce(added); !ok) rosbag.broken = ok.error();
  }
  rosbag.topics.push_back(std::move(added));
  return rosbag.topics.back().id;
}

Result<void> Rosbag2Writer::write(std::uint32_t connection, Time record_time,
                                  std::span<const std::byte> data) {
  Impl& rosbag = *impl_;
  if (rosbag.broken) return tl::unexpected(*rosbag.broken);
  if (rosbag.closed) return rosbag.refuse("is closed: nothing can be written");
  if (connection >= rosbag.topics.size()) {
    return rosbag.refuse(fmt::format("has no connection {}", connection));
  }
  if (record_time < 0) {
    return rosbag.refuse(fmt::format("expected a record time >= 0, found {} ns", record_time));
  }
  if (data.size() > kMaxMessageBytes) {
    return rosbag.refuse(fmt::format("a message of {} bytes is too large", data.size()));
  }
  auto ok = rosbag.message.bind(1, std::int64_t{connection} + 1)
                .bind(2, record_time)
                .bind(3, data)
                .finish();
  ++rosbag.topics[connection].messages;
  const auto known = rosbag.span.value_or(std::pair(record_time, record_time));
  rosbag.span = {std::min(known.first, record_time), std::max(known.second, record_time)};
  rosbag.pending += data.size();
  if (ok && rosbag.pending >= rosbag.batch) ok = rosbag.commit();
  if (!ok) rosbag.broken = ok.error();
  return ok;
}

Result<void> Rosbag2Writer::close() {
  Impl& rosbag = *impl_;
  if (rosbag.broken) return tl::unexpected(*rosbag.broken);
  if (rosbag.closed) return {};
  rosbag.closed = true;
  auto outcome = rosbag.close_file();
  if (!outcome) rosbag.broken = outcome.error();
  return outcome;
}

}  // namespace aims
