// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string_view>

namespace aims {

/// Whether `word` stands in `text` by itself. Words are of letters, digits and the characters of
/// `also`: "gt" is one of "/gt_odom", and none where `also` is "_".
bool has_word(std::string_view text, std::string_view word, std::string_view also = {});

}  // namespace aims
