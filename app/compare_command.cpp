// SPDX-License-Identifier: BSD-3-Clause
#include "app/commands.hpp"

namespace aims {

void add_compare_command(CLI::App& app, int& exit_code) {
  (void)app;
  exit_code = exit_code;
}

}  // namespace aims
