// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/job_results.hpp"

#include <algorithm>
#include <system_error>

#include "core/files/atomic_file.hpp"

namespace aims {

namespace fs = std::filesystem;

std::optional<Json> JobResults::read(const std::string& id) const {
  const auto text = read_file(file_of(id));
  if (!text) return std::nullopt;
  Json json = Json::parse(*text, nullptr, false);
  if (json.is_discarded()) return std::nullopt;
  return json;
}

std::optional<JobResult> JobResults::find(const std::string& id) const {
  const auto json = read(id);
  return json ? result_in(*json) : std::nullopt;
}

Result<void> JobResults::put(const Job& job, const JobResult& result) const {
  std::error_code code;
  fs::create_directories(folder_, code);
  // Messages may hold what is no UTF-8, e.g. of a file's name.
  const std::string text =
      job_json(job, result).dump(1, ' ', false, Json::error_handler_t::replace);
  return write_file_atomically(file_of(job.id), text + "\n");
}

std::vector<std::string> JobResults::ids() const {
  std::vector<std::string> ids;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(folder_, ignored)) {
    if (entry.path().extension() == ".json") ids.push_back(entry.path().stem().string());
  }
  std::sort(ids.begin(), ids.end());
  return ids;
}

}  // namespace aims
