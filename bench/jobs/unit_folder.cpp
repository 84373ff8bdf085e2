// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/unit_folder.hpp"

#include <algorithm>
#include <system_error>

#include "core/files/atomic_file.hpp"

namespace aims {

namespace fs = std::filesystem;

std::optional<Json> UnitFolder::read(const std::string& id) const {
  const auto text = read_file(file_of(id));
  if (!text) return std::nullopt;
  Json json = Json::parse(*text, nullptr, false);
  if (json.is_discarded()) return std::nullopt;
  return json;
}

std::optional<UnitResult> UnitFolder::find(const std::string& id) const {
  const auto json = read(id);
  return json ? result_in(*json) : std::nullopt;
}

Result<void> UnitFolder::put(const SweepUnit& unit, const UnitResult& result) const {
  std::error_code code;
  fs::create_directories(folder_, code);
  // Messages may hold what is no UTF-8, e.g. of a file's name.
  const std::string text =
      unit_json(unit, result).dump(1, ' ', false, Json::error_handler_t::replace);
  return write_file_atomically(file_of(unit.id), text + "\n");
}

std::vector<std::string> UnitFolder::ids() const {
  std::vector<std::string> ids;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder_, ignored)) {
    if (entry.path().extension() == ".json") ids.push_back(entry.path().stem().string());
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

}  // namespace aims
