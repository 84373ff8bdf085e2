// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

#include "core/error.hpp"

namespace aims {

/// Bytes of the largest YAML text that is read.
inline constexpr std::size_t kLargestYaml = std::size_t{512} << 10;

/// Refuses YAML text that would cost the parser far more memory than any configuration needs: above
/// `kLargestYaml`, or of some length with brackets or list marks nested more than a hundred deep.
/// Errors: "name:line: ...".
Result<void> check_yaml_size(std::string_view text, const std::string& name);

}  // namespace aims
