// SPDX-License-Identifier: BSD-3-Clause
#include "live/watch/web_server.hpp"

#include <fmt/format.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/time.h>

#include <atomic>
#include <boost/asio/ip/tcp.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <string_view>
#include <thread>
#include <utility>

namespace aims {
namespace {

namespace asio = boost::asio;
namespace http = boost::beast::http;
using Tcp = asio::ip::tcp;

constexpr timeval kPatience = {2, 0};  ///< for a client
constexpr int kPollMs = 200;           ///< between looks whether to end

/// The name without the port: "localhost" of "localhost:8080", "[::1]" of "[::1]:8080".
std::string_view host_of(std::string_view header) {
  const std::size_t end = header.starts_with('[') ? header.find(']') + 1 : header.find(':');
  return header.substr(0, end);
}

bool is_this_computer(std::string_view host) {
  return host == "localhost" || host == "[::1]" || host.starts_with("127.");
}

}  // namespace

struct WebServer::Impl {
  asio::io_context context;
  Tcp::acceptor acceptor{context};
  Handler handler;
  bool loopback = true;
  std::atomic<bool> ended{false};
  std::thread thread;

  void serve();
  void answer(Tcp::socket& socket) const;
  http::response<http::string_body> response_to(
      const http::request<http::empty_body>& request) const;
};

http::response<http::string_body> WebServer::Impl::response_to(
    const http::request<http::empty_body>& request) const {
  http::response<http::string_body> response(http::status::ok, request.version());
  response.set("X-Content-Type-Options", "nosniff");
  response.set(http::field::cache_control, "no-store");
  response.keep_alive(false);
  const auto host = request[http::field::host];
  WebContent content;
  if (request.method() != http::verb::get) {
    response.result(http::status::method_not_allowed);
  } else if (loopback && !is_this_computer(host_of({host.data(), host.size()}))) {
    response.result(http::status::forbidden);
  } else {
    content = handler(std::string(request.target()));
    if (content.type.empty()) response.result(http::status::not_found);
  }
  if (content.type.empty()) content = {"text/plain", "no such page\n"};
  response.set(http::field::content_type, content.type);
  response.body() = std::move(content.body);
  response.prepare_payload();
  return response;
}

void WebServer::Impl::answer(Tcp::socket& socket) const {
  for (const int option : {SO_RCVTIMEO, SO_SNDTIMEO}) {
    setsockopt(socket.native_handle(), SOL_SOCKET, option, &kPatience, sizeof(kPatience));
  }
  boost::beast::flat_buffer buffer;
  http::request<http::empty_body> request;
  boost::system::error_code error;
  http::read(socket, buffer, request, error);
  if (error) return;
  http::write(socket, response_to(request), error);
  socket.shutdown(Tcp::socket::shutdown_both, error);
}

void WebServer::Impl::serve() {
  while (!ended) {
    pollfd waiting = {acceptor.native_handle(), POLLIN, 0};
    if (poll(&waiting, 1, kPollMs) <= 0) continue;
    boost::system::error_code error;
    Tcp::socket socket = acceptor.accept(error);
    if (!error) answer(socket);
  }
}

WebServer::WebServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {
  impl_->thread = std::thread([server = impl_.get()] { server->serve(); });
}

WebServer::~WebServer() {
  impl_->ended = true;
  impl_->thread.join();
}

Result<std::unique_ptr<WebServer>> WebServer::start(const std::string& address, std::uint16_t port,
                                                    Handler handler) {
  auto impl = std::make_unique<Impl>();
  impl->handler = std::move(handler);
  boost::system::error_code error;
  const auto parsed = asio::ip::make_address(address, error);
  if (error) return failure(fmt::format("'{}': expected an address, e.g. 127.0.0.1", address));
  impl->loopback = parsed.is_loopback();
  const Tcp::endpoint endpoint(parsed, port);
  impl->acceptor.open(endpoint.protocol(), error);
  if (!error) impl->acceptor.set_option(Tcp::acceptor::reuse_address(true), error);
  if (!error) impl->acceptor.bind(endpoint, error);
  if (!error) impl->acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error) return failure(fmt::format("{} port {}: {}", address, port, error.message()));
  return std::unique_ptr<WebServer>(new WebServer(std::move(impl)));
}

std::uint16_t WebServer::port() const { return impl_->acceptor.local_endpoint().port(); }

}  // namespace aims
