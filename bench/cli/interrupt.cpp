// SPDX-License-Identifier: BSD-3-Clause
#include "bench/cli/interrupt.hpp"

#include <csignal>

namespace aims {
namespace {

volatile std::sig_atomic_t noted = 0;

void on_interrupt(int signal) {
  noted = 1;
  std::signal(signal, SIG_DFL);
}

}  // namespace

void watch_interrupt() { std::signal(SIGINT, on_interrupt); }

bool interrupted() { return noted != 0; }

}  // namespace aims
