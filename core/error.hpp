// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace aims {

/// Reason of a failure: what, where, and what was expected, in one line.
struct Error {
  std::string message;
};

/// A value or an error.
template <class T>
using Result = tl::expected<T, Error>;

/// An error with that message.
inline tl::unexpected<Error> failure(std::string message) {
  return tl::unexpected<Error>(Error{std::move(message)});
}

}  // namespace aims
