// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/rosbag2/db3_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <map>
#include <string_view>
#include <system_error>
#include <utility>

#include "core/files/byte_cursor.hpp"
#include "core/files/sqlite_database.hpp"
#include "recordings/bag/bag_file.hpp"
#include "recordings/messages/message_definition.hpp"
#include "recordings/messages/message_types.hpp"
#include "recordings/messages/quality_of_service.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// A message in the file, without its bytes.
struct MessageRow {
  Time time = 0;
  std::int64_t id = 0;
  std::uint32_t connection = 0;
};

/// What a database lists: topics, and messages in order of reading.
struct Db3Index {
  std::vector<BagConnection> connections;
  std::vector<MessageRow> rows;
};

/// SQLite would fill the rest of a truncated page with zeros.
Result<void> check_pages(const BagFile& file) {
  constexpr std::size_t kSizeOffset = 16;
  std::array<std::byte, 2> field{};
  if (auto got = file.read(kSizeOffset, field); !got) return got;
  const auto stated = load_number<std::uint16_t>(field.data(), std::endian::big);
  const std::uint64_t page = stated == 1 ? 65536 : std::max<std::uint64_t>(stated, 1);
  if (file.size() % page == 0) return {};
  return file.refuse(file.size(),
                     fmt::format("is damaged: expected whole pages of {} bytes", page));
}

/// The file has what rosbag2 creates, as tables that nothing else computes.
Result<void> check_tables(const SqliteDatabase& database) {
  auto tables = database.prepare(
      "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND rootpage > 0 "
      "AND name IN ('messages', 'topics')");
  if (!tables) return tl::unexpected(tables.error());
  const auto row = tables->step();
  if (!row) return tl::unexpected(row.error());
  if (tables->integer(0) == 2) return {};
  return failure(
      fmt::format("{}: expected a recording of rosbag2, with the tables messages and "
                  "topics",
                  database.file().string()));
}

Result<void> check_structure(const SqliteDatabase& database) {
  auto check = database.prepare("PRAGMA quick_check(1)");
  if (!check) return tl::unexpected(check.error());
  const auto row = check->step();
  if (!row) return tl::unexpected(row.error());
  if (*row && check->text(0) == "ok") return {};
  return failure(
      fmt::format("{}: is damaged: SQLite: {}", database.file().string(), check->text(0)));
}

Result<bool> has_column(const SqliteDatabase& database, std::string_view table,
                        std::string_view column) {
  auto found = database.prepare("SELECT count(*) FROM pragma_table_info(?1) WHERE name = ?2");
  if (!found) return tl::unexpected(found.error());
  const auto row = found->bind(1, table).bind(2, column).step();
  if (!row) return tl::unexpected(row.error());
  return found->integer(0) > 0;
}

struct Db3Definition {
  std::string encoding;
  std::string text;
};

/// Definitions by type name; none before ROS 2 Iron.
Result<std::map<std::string, Db3Definition>> read_definitions(const SqliteDatabase& database) {
  std::map<std::string, Db3Definition> definitions;
  const auto present = has_column(database, "message_definitions", "encoded_message_definition");
  if (!present) return tl::unexpected(present.error());
  if (!*present) return definitions;
  auto rows = database.prepare(
      "SELECT topic_type, encoding, encoded_message_definition FROM message_definitions");
  if (!rows) return tl::unexpected(rows.error());
  while (true) {
    const auto row = rows->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return definitions;
    definitions.try_emplace(rows->text(0), Db3Definition{rows->text(1), rows->text(2)});
  }
}

BagConnection connection_of(const SqliteStatement& topic, bool has_quality,
                            const std::map<std::string, Db3Definition>& definitions) {
  BagConnection connection;
  connection.topic = topic.text(1);
  connection.type = plain_type_name(topic.text(2));
  connection.format = kRos2Format;
  if (topic.text(3) != "cdr") connection.format.serialization = Serialization::kOther;
  connection.latching = has_quality && is_transient_local(topic.text(4));
  const auto definition = definitions.find(topic.text(2));
  if (definition != definitions.end()) {
    connection.definition = definition->second.text;
    if (definition->second.encoding == "ros2idl") {
      connection.format.language = DefinitionLanguage::kRos2Idl;
    }
  }
  complete_definition(connection.type, connection.definition, connection.format);
  return connection;
}

/// The topics, and where in `connections` each topic number of the file stands.
Result<std::map<std::int64_t, std::uint32_t>> read_topics(const SqliteDatabase& database,
                                                          std::vector<BagConnection>& connections) {
  const auto definitions = read_definitions(database);
  if (!definitions) return tl::unexpected(definitions.error());
  const auto quality = has_column(database, "topics", "offered_qos_profiles");
  if (!quality) return tl::unexpected(quality.error());
  auto rows = database.prepare(
      fmt::format("SELECT id, name, type, serialization_format{} FROM topics ORDER BY id",
                  *quality ? ", offered_qos_profiles" : ""));
  if (!rows) return tl::unexpected(rows.error());
  std::map<std::int64_t, std::uint32_t> places;
  while (true) {
    const auto row = rows->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return places;
    const auto id = static_cast<std::uint32_t>(connections.size());
    if (!rows->is_integer(0) || !places.emplace(rows->integer(0), id).second) {
      return failure(fmt::format("{}: expected topics with different numbers, found '{}' twice",
                                 database.file().string(), rows->text(0)));
    }
    connections.push_back(connection_of(*rows, *quality, *definitions));
    connections.back().id = id;
  }
}

Result<std::vector<MessageRow>> read_rows(const SqliteDatabase& database,
                                          const std::map<std::int64_t, std::uint32_t>& topics,
                                          std::size_t memory_limit) {
  auto found = database.prepare("SELECT rowid, topic_id, timestamp FROM messages ORDER BY rowid");
  if (!found) return tl::unexpected(found.error());
  const auto refuse = [&](const std::string& what) {
    return failure(
        fmt::format("{}: message {}: {}", database.file().string(), found->text(0), what));
  };
  std::vector<MessageRow> rows;
  while (true) {
    const auto row = found->step();
    if (!row) return tl::unexpected(row.error());
    if (!*row) return rows;
    const std::int64_t id = found->integer(0);
    // A damaged tree can lead to the same page again and again.
    if (!rows.empty() && id <= rows.back().id) {
      return refuse(fmt::format("expected a number above {}: the file is damaged", rows.back().id));
    }
    const auto topic = topics.find(found->integer(1));
    if (!found->is_integer(1) || topic == topics.end()) {
      return refuse(fmt::format("of topic {}, which the file does not list", found->text(1)));
    }
    if (!found->is_integer(2) || found->integer(2) < 0) {
      return refuse(fmt::format("expected a time >= 0 in ns, found {}", found->text(2)));
    }
    if ((rows.size() + 1) * sizeof(MessageRow) > memory_limit) {
      return refuse(fmt::format("the list of messages needs more than {} bytes", memory_limit));
    }
    rows.push_back({found->integer(2), id, topic->second});
  }
}

Result<Db3Index> read_index(const SqliteDatabase& database, BagOpenOptions options) {
  if (auto ok = check_tables(database); !ok) return tl::unexpected(ok.error());
  if (options.recover) {
    if (auto ok = check_structure(database); !ok) return tl::unexpected(ok.error());
  }
  Db3Index index;
  const auto topics = read_topics(database, index.connections);
  if (!topics) return tl::unexpected(topics.error());
  auto rows = read_rows(database, *topics, options.memory_limit);
  if (!rows) return tl::unexpected(rows.error());
  index.rows = std::move(*rows);
  for (const MessageRow& row : index.rows) ++index.connections[row.connection].messages;
  std::ranges::stable_sort(index.rows, {}, &MessageRow::time);
  return index;
}

/// The error of a file that cannot be read; of a damaged one with what can be done about it.
tl::unexpected<Error> refuse_damaged(const fs::path& file, const Error& error) {
  constexpr std::array<std::string_view, 3> kSigns = {"malformed", "damaged", "disk I/O error"};
  const bool damaged = std::ranges::any_of(
      kSigns, [&](std::string_view sign) { return error.message.find(sign) != std::string::npos; });
  std::error_code code;
  if (fs::exists(fs::path(file) += "-journal", code)) {
    return failure(
        fmt::format("{}; {}-journal holds changes that were never completed: open a "
                    "copy of both with `sqlite3`, which undoes them",
                    error.message, file.filename().string()));
  }
  if (!damaged) return tl::unexpected(error);
  return failure(
      fmt::format("{}; a database has no checksums by which --recover could keep its "
                  "intact part: `sqlite3 {} .recover` extracts what it finds, unchecked",
                  error.message, file.filename().string()));
}

}  // namespace

struct Db3Reader::Impl {
  SqliteDatabase database;
  SqliteStatement content;
  Db3Index index;
  BagSummary summary;
  std::vector<bool> chosen;  ///< by connection
  std::size_t next = 0;
};

Db3Reader::Db3Reader(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Db3Reader::Db3Reader(Db3Reader&&) noexcept = default;
Db3Reader& Db3Reader::operator=(Db3Reader&&) noexcept = default;
Db3Reader::~Db3Reader() = default;

Result<Db3Reader> Db3Reader::open(const fs::path& path, BagOpenOptions options) {
  const auto file = BagFile::open(path);
  if (!file) return tl::unexpected(file.error());
  if (auto whole = check_pages(*file); !whole) return refuse_damaged(path, whole.error());
  // Rows may lie in the log beside it.
  std::error_code absent;
  const std::uint64_t log = fs::file_size(fs::path(path) += "-wal", absent);
  const auto max_value = static_cast<std::size_t>(
      std::min<std::uint64_t>(file->size() + (absent ? 0 : log), options.memory_limit));
  auto database = SqliteDatabase::open(path, max_value);
  if (!database) return tl::unexpected(database.error());
  auto index = read_index(*database, options);
  if (!index) return refuse_damaged(path, index.error());
  auto content = database->prepare("SELECT data FROM messages WHERE rowid = ?1");
  if (!content) return refuse_damaged(path, content.error());
  BagSummary summary;
  summary.file_size = file->size();
  summary.chunks = 1;
  summary.messages = index->rows.size();
  summary.compression = name_of(BagCompression::kNone);
  if (!index->rows.empty()) {
    summary.start = index->rows.front().time;
    summary.end = index->rows.back().time;
  }
  const std::size_t topics = index->connections.size();
  return Db3Reader(
      std::unique_ptr<Impl>(new Impl{std::move(*database), std::move(*content), std::move(*index),
                                     std::move(summary), std::vector<bool>(topics, true)}));
}

std::string Db3Reader::name() const { return impl_->database.file().string(); }

const std::vector<BagConnection>& Db3Reader::connections() const {
  return impl_->index.connections;
}

const BagSummary& Db3Reader::summary() const { return impl_->summary; }

void Db3Reader::select(std::span<const std::string> topics) {
  for (const BagConnection& each : impl_->index.connections) {
    impl_->chosen[each.id] = std::ranges::find(topics, each.topic) != topics.end();
  }
}

Result<std::optional<BagMessage>> Db3Reader::next() {
  Impl& db3 = *impl_;
  db3.content.reset();
  const auto& rows = db3.index.rows;
  while (db3.next < rows.size() && !db3.chosen[rows[db3.next].connection]) ++db3.next;
  if (db3.next == rows.size()) return std::optional<BagMessage>();
  const MessageRow& row = rows[db3.next++];
  const auto found = db3.content.bind(1, row.id).step();
  if (!found) {
    return refuse_damaged(db3.database.file(),
                          {fmt::format("{} (message {})", found.error().message, row.id)});
  }
  if (!*found) {
    return failure(
        fmt::format("{}: message {}: was removed while the file was read", name(), row.id));
  }
  return BagMessage{&db3.index.connections[row.connection], row.time, db3.content.bytes(0),
                    static_cast<std::uint64_t>(row.id)};
}

void Db3Reader::rewind() { impl_->next = 0; }

}  // namespace aims
