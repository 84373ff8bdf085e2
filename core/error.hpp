// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <tl/expected.hpp>
#include <utility>

namespace aims {

/// What a caller may decide by, besides the message.
enum class ErrorKind {
  kOther,
  kRecoverable,  ///< of a damaged recording, whose intact part `--recover` reads
};

/// Reason of a failure: what, where, and what was expected, in one line.
struct Error {
  std::string message;
  ErrorKind kind = ErrorKind::kOther;
};

/// A value or an error.
template <class T>
using Result = tl::expected<T, Error>;

/// An error with that message.
inline tl::unexpected<Error> failure(std::string message, ErrorKind kind = ErrorKind::kOther) {
  return tl::unexpected<Error>(Error{std::move(message), kind});
}

}  // namespace aims
