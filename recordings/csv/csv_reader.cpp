// SPDX-License-Identifier: BSD-3-Clause
#include "recordings/csv/csv_reader.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "core/files/csv_columns.hpp"
#include "core/files/iso_time.hpp"
#include "core/files/number_lines.hpp"
#include "core/files/text_file.hpp"
#include "core/text.hpp"
#include "recordings/csv/csv_mapping.hpp"
#include "recordings/messages/message_encoding.hpp"
#include "recordings/messages/message_types.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// Of the largest table; in memory it takes several times as much [bytes].
constexpr std::size_t kMaxTableBytes = std::size_t{256} << 20;
constexpr std::array<std::string_view, kLegCount> kFeet = {"FL", "FR", "RL", "RR"};
constexpr std::array<std::string_view, 3> kJoints = {"hip", "thigh", "calf"};
constexpr std::string_view kImuFrame = "imu";
constexpr std::string_view kBaseFrame = "base";

/// What a row can hold, in the order of its messages.
enum RowKind : std::size_t { kImu, kForces, kJointStates, kKinds };

/// Columns of numbers, of which a row has a value each.
using Columns = std::vector<std::vector<double>>;

/// The numbers of the table that the mapping names.
struct Table {
  std::vector<std::optional<Time>> times;  ///< nothing: the row has none
  Columns gyro, accelerometer, orientation, joint_position, joint_velocity, foot_force;
};

Result<Columns> columns_of(const CsvColumns& csv, const std::vector<std::string>& names,
                           const std::string& file) {
  Columns columns;
  for (const std::string& name : names) {
    if (!csv.has(name)) {
      return failure(
          fmt::format("{}: expected a column '{}', which the mapping names; there are '{}'", file,
                      name, fmt::join(csv.header(), "', '")));
    }
    auto numbers = csv.numbers(name);
    if (!numbers) return tl::unexpected(numbers.error());
    columns.push_back(std::move(*numbers));
  }
  return columns;
}

/// Error for a column without a number beside others that have some: no row would hold that sensor.
Result<void> check_none_empty(const Columns& columns, const std::vector<std::string>& names,
                              const std::string& file) {
  const auto has_none = [](const std::vector<double>& column) {
    return std::ranges::none_of(column, [](double each) { return std::isfinite(each); });
  };
  const auto empty = std::ranges::find_if(columns, has_none);
  if (empty == columns.end() || std::ranges::all_of(columns, has_none)) return {};
  const auto index = static_cast<std::size_t>(empty - columns.begin());
  return failure(
      fmt::format("{}: column '{}' holds no number in any row; expected one in each row "
                  "in which the others of [{}] have one",
                  file, names[index], fmt::join(names, ", ")));
}

/// The time in a cell, or nothing. A date needs no unit.
std::optional<Time> time_of(const std::string& cell, CsvTimeUnit unit) {
  if (const auto date = parse_iso_time(cell)) return date->time;
  if (unit == CsvTimeUnit::kSeconds) return parse_stamp(cell);
  if (unit == CsvTimeUnit::kNanoseconds) {
    if (const auto time = number_from<Time>(cell)) return time;
  }
  const auto number = parse_number(cell);
  const double scale = unit == CsvTimeUnit::kMilliseconds   ? 1e6
                       : unit == CsvTimeUnit::kMicroseconds ? 1e3
                                                            : 1.0;
  if (!number || !(std::abs(*number) * scale < 9e18)) return std::nullopt;
  return static_cast<Time>(std::llround(*number * scale));
}

/// What the digits of a time since 1970 that is not read tell of its unit.
std::string likely_unit(const std::string& cell) {
  const std::size_t digits = std::min(cell.find_first_not_of("0123456789"), cell.size());
  const char* unit = digits >= 19 ? "ns" : digits == 16 ? "us" : digits == 13 ? "ms" : nullptr;
  return unit == nullptr ? "" : fmt::format("; likely time_unit: {}", unit);
}

/// A cell in an error.
std::string shown(const std::string& cell) {
  if (cell.empty()) return "an empty cell";
  const auto number = parse_number(cell, false);
  return number && std::isnan(*number) ? fmt::format("NaN ('{}')", cell)
                                       : fmt::format("'{}'", cell);
}

/// The table without the line that names its separator to a spreadsheet ("sep=,"), and with lines
/// that end in a line feed where all end in a carriage return alone.
std::string plain_text(std::string text) {
  if (text.find('\n') == std::string::npos) std::ranges::replace(text, '\r', '\n');
  if (text.starts_with("sep=")) text.erase(0, text.find('\n') + 1);
  return text;
}

/// Whether a cell holds no time: it is empty, or no finite number.
bool is_missing(const std::string& cell) {
  if (cell.empty()) return true;
  const auto number = parse_number(cell, false);
  return number && !std::isfinite(*number);
}

/// Times of the rows, in order; a few rows may have none.
Result<std::vector<std::optional<Time>>> times_of(const CsvColumns& csv, const CsvMapping& mapping,
                                                  const std::string& file) {
  constexpr std::size_t kMostMissing = 10;  // one of so many rows
  if (!csv.has(mapping.time)) {
    return failure(fmt::format("{}: expected a column '{}' (time)", file, mapping.time));
  }
  std::vector<std::optional<Time>> times;
  Time least = 0;
  std::size_t missing = 0, first = 0;
  const std::vector<std::string> cells = csv.texts(mapping.time);
  for (const std::string& cell : cells) {
    if (is_missing(cell)) {
      if (missing++ == 0) first = times.size();
      times.emplace_back();
      continue;
    }
    const auto time = time_of(cell, mapping.time_unit);
    if (!time || *time < least) {
      return failure(fmt::format("{}:{}: {}: expected a time >= {} ns, found {}{}", file,
                                 csv.line(times.size()), mapping.time, least, shown(cell),
                                 likely_unit(cell)));
    }
    least = *time;
    times.push_back(time);
  }
  if (kMostMissing * missing > times.size()) {
    return failure(fmt::format(
        "{}:{}: {}: expected a time, found {}, as in {} of {} rows; at most a tenth "
        "may lack it",
        file, csv.line(first), mapping.time, shown(cells[first]), missing, times.size()));
  }
  return times;
}

Result<Table> read_table(const CsvMapping& mapping, const fs::path& file, bool recover) {
  auto text = read_text_file(file, kMaxTableBytes);
  if (!text) return tl::unexpected(text.error());
  const auto csv = CsvColumns::parse(plain_text(std::move(*text)), file.string(), {},
                                     recover ? CsvOrigin::kDamaged : CsvOrigin::kForeign);
  if (!csv) return tl::unexpected(csv.error());
  Table table;
  auto times = times_of(*csv, mapping, file.string());
  if (!times) return tl::unexpected(times.error());
  table.times = std::move(*times);
  const std::array<std::pair<const std::vector<std::string>*, Columns*>, 6> lists = {
      {{&mapping.gyro, &table.gyro},
       {&mapping.accelerometer, &table.accelerometer},
       {&mapping.orientation, &table.orientation},
       {&mapping.joint_position, &table.joint_position},
       {&mapping.joint_velocity, &table.joint_velocity},
       {&mapping.foot_force, &table.foot_force}}};
  for (const auto& [names, columns] : lists) {
    auto read = columns_of(*csv, *names, file.string());
    if (!read) return tl::unexpected(read.error());
    if (auto ok = check_none_empty(*read, *names, file.string()); !ok) {
      return tl::unexpected(ok.error());
    }
    *columns = std::move(*read);
  }
  return table;
}

/// The numbers of a row, or nothing where one is missing.
std::optional<std::vector<double>> row_of(const Columns& columns, std::size_t row) {
  std::vector<double> numbers;
  for (const std::vector<double>& each : columns) {
    if (!std::isfinite(each[row])) return std::nullopt;
    numbers.push_back(each[row]);
  }
  if (numbers.empty()) return std::nullopt;
  return numbers;
}

/// The same with NaN for what is missing, or nothing where all is: legs that have theirs serve.
std::optional<std::vector<double>> partial_row_of(const Columns& columns, std::size_t row) {
  std::vector<double> numbers;
  for (const std::vector<double>& each : columns) numbers.push_back(each[row]);
  const auto is_number = [](double each) { return std::isfinite(each); };
  if (std::ranges::none_of(numbers, is_number)) return std::nullopt;
  return numbers;
}

void put_header(MessageBytes& out, Time stamp, std::string_view frame) {
  out.put(std::uint32_t{0});
  out.time(stamp);
  out.text(frame);
}

std::optional<MessageBytes> imu_of(const Table& table, std::size_t row, double turn_scale) {
  const auto gyro = row_of(table.gyro, row);
  const auto force = row_of(table.accelerometer, row);
  if (!gyro || !force) return std::nullopt;
  ImuSample sample;
  sample.angular_velocity = turn_scale * Eigen::Vector3d(gyro->data());
  sample.specific_force = Eigen::Vector3d(force->data());
  if (const auto q = row_of(table.orientation, row)) {
    sample.orientation = Eigen::Quaterniond((*q)[3], (*q)[0], (*q)[1], (*q)[2]);
  }
  return imu_message({0, *table.times[row], kImuFrame}, sample);
}

std::optional<MessageBytes> forces_of(const Table& table, std::size_t row) {
  const auto forces = row_of(table.foot_force, row);
  if (!forces) return std::nullopt;
  MessageBytes out;
  put_header(out, *table.times[row], kBaseFrame);
  out.length(kFeet.size());
  for (const std::string_view foot : kFeet) out.text(foot);
  out.array(*forces);
  return out;
}

std::optional<MessageBytes> joints_of(const Table& table, std::size_t row) {
  const auto angles = partial_row_of(table.joint_position, row);
  if (!angles) return std::nullopt;
  MessageBytes out;
  put_header(out, *table.times[row], kBaseFrame);
  out.length(angles->size());
  for (const std::string_view foot : kFeet) {
    for (const std::string_view joint : kJoints) out.text(fmt::format("{}_{}_joint", foot, joint));
  }
  out.array(*angles);
  out.array(partial_row_of(table.joint_velocity, row).value_or(std::vector<double>()));
  out.array(std::vector<double>());
  return out;
}

}  // namespace

struct CsvReader::Impl {
  fs::path mapping;
  std::uint64_t table_size = 0;  ///< [bytes]
  Table table;
  double turn_scale = 1.0;  ///< of the gyro to rad/s
  std::size_t at = 0;       ///< rows times kinds
  MessageBytes message = MessageBytes();

  std::optional<MessageBytes> message_of(std::size_t row, std::size_t kind) const {
    if (!table.times[row]) return std::nullopt;
    if (kind == kImu) return imu_of(table, row, turn_scale);
    return kind == kForces ? forces_of(table, row) : joints_of(table, row);
  }
};

CsvReader::CsvReader(std::unique_ptr<Impl> impl)
    : KindSource(std::to_array<KindSource::Kind>({{"/imu/data", imu_type()},
                                                  {"/foot_forces", foot_forces_type()},
                                                  {"/joint_states", joint_state_type()}}),
                 impl->table_size),
      impl_(std::move(impl)) {}
CsvReader::CsvReader(CsvReader&&) noexcept = default;
CsvReader& CsvReader::operator=(CsvReader&&) noexcept = default;
CsvReader::~CsvReader() = default;

Result<CsvReader> CsvReader::open(const fs::path& file, BagOpenOptions options) {
  const auto mapping = read_csv_mapping(file);
  if (!mapping) return tl::unexpected(mapping.error());
  const fs::path csv = file.parent_path() / mapping->file;
  auto table = read_table(*mapping, csv, options.recover);
  if (!table) return tl::unexpected(table.error());
  std::error_code ignored;
  auto impl = std::unique_ptr<Impl>(new Impl{file, fs::file_size(csv, ignored), std::move(*table)});
  if (mapping->gyro_unit == CsvTurnUnit::kDegrees) impl->turn_scale = std::numbers::pi / 180.0;
  const auto untimed = std::ranges::count_if(
      impl->table.times, [](const std::optional<Time>& time) { return !time.has_value(); });
  CsvReader reader(std::move(impl));
  reader.set_untimed(static_cast<std::uint64_t>(untimed));
  if (auto counted = reader.count(); !counted) return tl::unexpected(counted.error());
  return reader;
}

std::string CsvReader::name() const { return impl_->mapping.string(); }

Result<std::optional<KindSource::Made>> CsvReader::make() {
  Impl& csv = *impl_;
  while (csv.at < csv.table.times.size() * kKinds) {
    const std::size_t row = csv.at / kKinds;
    const std::size_t kind = csv.at++ % kKinds;
    auto message = csv.message_of(row, kind);
    if (!message) continue;
    csv.message = std::move(*message);
    return Made{kind, *csv.table.times[row], csv.message.view(), row + 1};
  }
  return std::optional<Made>();
}

void CsvReader::rewind() { impl_->at = 0; }

}  // namespace aims
