// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/plan_paths.hpp"

#include <system_error>

namespace aims {
namespace {

namespace fs = std::filesystem;

std::string resolved(const fs::path& plan, const std::string& given) {
  std::error_code ignored;
  const fs::path beside = plan.parent_path() / given;
  return fs::is_regular_file(beside, ignored) ? beside.string() : given;
}

}  // namespace

void resolve_scenarios(const fs::path& plan, std::vector<std::string>& scenarios) {
  for (std::string& each : scenarios) each = resolved(plan, each);
}

void resolve_settings(const fs::path& plan, std::vector<std::string>& settings) {
  for (std::string& each : settings) {
    if (each.starts_with('@')) each = "@" + resolved(plan, each.substr(1));
  }
}

}  // namespace aims
