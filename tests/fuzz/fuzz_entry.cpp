// SPDX-License-Identifier: BSD-3-Clause
// The door through which libFuzzer comes, to one of the targets.
#include "tests/fuzz/fuzz_targets.hpp"

// NOLINTNEXTLINE: libFuzzer gives the name.
extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  aims::AIMS_FUZZ_TARGET({data, size});
  return 0;
}
