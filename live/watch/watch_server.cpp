// SPDX-License-Identifier: BSD-3-Clause
#include "live/watch/watch_server.hpp"

#include <fmt/format.h>
#include <httplib.h>

#include <charconv>

namespace aims {
namespace {

using httplib::Request;
using httplib::Response;
using Routed = httplib::Server::HandlerResponse;

constexpr int kPatience = 2;  ///< with a client [s]

/// The name without the port: "localhost" of "localhost:8080", "[::1]" of "[::1]:8080".
std::string host_of(const std::string& header) {
  return header.substr(0, header.starts_with('[') ? header.find(']') + 1 : header.find(':'));
}

bool is_this_computer(const std::string& host) {
  return host == "localhost" || host == "[::1]" || host.starts_with("127.");
}

/// The number of a parameter; 0 without.
std::uint64_t number_in(const Request& request, const char* name) {
  const std::string text = request.get_param_value(name);
  std::uint64_t number = 0;
  std::from_chars(text.data(), text.data() + text.size(), number);
  return number;
}

Routed refuse(Response& response, int status) {
  response.status = status;
  response.set_content("no such page\n", "text/plain");
  return Routed::Handled;
}

}  // namespace

WatchServer::WatchServer() : server_(std::make_unique<httplib::Server>()) {}

WatchServer::~WatchServer() {
  server_->stop();
  if (thread_.joinable()) thread_.join();
}

Result<std::unique_ptr<WatchServer>> WatchServer::start(const std::string& address,
                                                        std::uint16_t port,
                                                        const WatchState& state) {
  std::unique_ptr<WatchServer> made(new WatchServer());
  httplib::Server& server = *made->server_;
  server.set_keep_alive_max_count(1).set_keep_alive_timeout(kPatience);
  server.set_read_timeout(kPatience).set_write_timeout(kPatience);
  server.set_default_headers(
      {{"X-Content-Type-Options", "nosniff"}, {"Cache-Control", "no-store"}});
  // Without SO_REUSEPORT, with which two programs would share a port.
  server.set_socket_options([](int socket) {
    const int yes = 1;
    setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof(yes));
  });
  const bool loopback = address == "::1" || is_this_computer(address);
  server.set_pre_routing_handler([loopback](const Request& request, Response& response) {
    if (request.method != "GET") return refuse(response, 405);
    const std::string host = host_of(request.get_header_value("Host"));
    if (loopback && !is_this_computer(host)) return refuse(response, 403);
    return Routed::Unhandled;
  });
  server.Get("/", [](const Request&, Response& response) {
    response.set_content(std::string(watch_page()), "text/html; charset=utf-8");
  });
  server.Get("/state.json", [&state](const Request& request, Response& response) {
    response.set_content(state.json(number_in(request, "epoch"), number_in(request, "from")),
                         "application/json");
  });
  const bool bound = port == 0 ? (made->port_ = server.bind_to_any_port(address)) > 0
                               : server.bind_to_port(address, made->port_ = port);
  if (!bound) {
    return failure(fmt::format(
        "{} port {}: expected an address of this computer, e.g. 127.0.0.1, and a free port",
        address, port));
  }
  made->thread_ = std::thread([&server] { server.listen_after_bind(); });
  while (!server.is_running()) std::this_thread::yield();  // else `stop` would be missed
  return made;
}

}  // namespace aims
