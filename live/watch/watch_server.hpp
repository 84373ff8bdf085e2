// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <string_view>
#include <thread>

#include "core/error.hpp"
#include "live/watch/watch_state.hpp"

namespace httplib {
class Server;
}

namespace aims {

/// The page of `aims watch`; empty where it was built without npm.
std::string_view watch_page();

/// A small web server with the page and its /state.json: GET alone, one request per connection; a
/// client that is silent for two seconds is left. On an address of this computer it answers only to
/// requests for this computer, so that no page of another site reads from it.
class WatchServer {
 public:
  /// Listens and serves in its own threads until it is destroyed; port 0: any free one. `state`
  /// must outlive it. Error for an address that is not this computer's or a port that is taken.
  static Result<std::unique_ptr<WatchServer>> start(const std::string& address, std::uint16_t port,
                                                    const WatchState& state);
  ~WatchServer();

  std::uint16_t port() const { return static_cast<std::uint16_t>(port_); }

 private:
  WatchServer();

  std::unique_ptr<httplib::Server> server_;
  int port_ = 0;
  std::thread thread_;
};

}  // namespace aims
