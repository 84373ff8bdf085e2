// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/tune_jobs.hpp"

#include <fstream>

#include "core/files/atomic_file.hpp"

namespace aims {
namespace {

constexpr const char* kFile = "tune_jobs.csv";
constexpr const char* kHeader = "id";

}  // namespace

Result<void> write_tune_jobs(const std::filesystem::path& folder,
                             const std::set<std::string>& ids) {
  std::string text = std::string(kHeader) + "\n";
  for (const std::string& id : ids) text += id + "\n";
  return write_file_atomically(folder / kFile, text);
}

std::optional<std::set<std::string>> read_tune_jobs(const std::filesystem::path& folder) {
  std::ifstream file(folder / kFile);
  std::string line;
  if (!std::getline(file, line) || line != kHeader) return std::nullopt;
  std::set<std::string> ids;
  while (std::getline(file, line)) ids.insert(line);
  return ids;
}

}  // namespace aims
