// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "core/error.hpp"

namespace aims {

/// What a path of the server has; an empty type: nothing.
struct WebContent {
  std::string type;  ///< e.g. "text/html; charset=utf-8"
  std::string body;
};

/// A small web server: GET alone, one request per connection, each for at most two seconds; a
/// client that is silent keeps nobody waiting. On an address of this computer it answers only to
/// requests for this computer, so that no page of another site reads from it.
class WebServer {
 public:
  /// Gets the target of a request, "/state.json?from=3"; called in the server's thread.
  using Handler = std::function<WebContent(const std::string& target)>;

  /// Listens and serves in its own thread until it is destroyed; port 0: any free one. Error for
  /// an address that is none or a port that is taken.
  static Result<std::unique_ptr<WebServer>> start(const std::string& address, std::uint16_t port,
                                                  Handler handler);
  ~WebServer();

  std::uint16_t port() const;

 private:
  struct Impl;
  explicit WebServer(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace aims
