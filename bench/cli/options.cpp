// SPDX-License-Identifier: BSD-3-Clause
#include "bench/cli/options.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <thread>

namespace aims {

int bad_input(const char* command, const Error& error) {
  fmt::print(stderr, "aims {}: {}\n", command, error.message);
  return kBadInput;
}

CLI::Option* add_repeatable(CLI::App& command, const std::string& name,
                            std::vector<std::string>& values, const std::string& meaning) {
  return command.add_option(name, values, meaning)
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
}

void add_jobs_option(CLI::App& command, int& jobs, const std::string& meaning) {
  command.add_option("--jobs", jobs, meaning)->check(CLI::Range(1, 256));
}

int default_jobs() { return static_cast<int>(std::max(1U, std::thread::hardware_concurrency())); }

}  // namespace aims
