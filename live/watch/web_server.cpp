// SPDX-License-Identifier: BSD-3-Clause
#include "live/watch/web_server.hpp"

#include <fmt/format.h>

#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/beast/core.hpp>
#include <boost/beast/http.hpp>
#include <chrono>
#include <string_view>
#include <thread>
#include <utility>

namespace aims {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using Tcp = asio::ip::tcp;
using Request = http::request<http::empty_body>;
using Response = http::response<http::string_body>;

constexpr auto kPatience = std::chrono::seconds(2);      ///< with a client
constexpr auto kPause = std::chrono::milliseconds(100);  ///< where no connection can be taken

/// The name without the port: "localhost" of "localhost:8080", "[::1]" of "[::1]:8080".
std::string_view host_of(std::string_view header) {
  const std::size_t end = header.starts_with('[') ? header.find(']') + 1 : header.find(':');
  return header.substr(0, end);
}

bool is_this_computer(std::string_view host) {
  return host == "localhost" || host == "[::1]" || host.starts_with("127.");
}

/// One request and its answer; it lives as long as its operations.
struct Exchange {
  explicit Exchange(Tcp::socket socket) : stream(std::move(socket)) {}

  beast::tcp_stream stream;
  beast::flat_buffer buffer;
  Request request;
  Response response;
};

}  // namespace

struct WebServer::Impl {
  asio::io_context context;
  Tcp::acceptor acceptor{context};
  asio::steady_timer pause{context};
  Handler handler;
  bool loopback = true;
  std::thread thread;

  void accept();
  void answer(Tcp::socket socket) const;
  Response response_to(const Request& request) const;
};

Response WebServer::Impl::response_to(const Request& request) const {
  Response response(http::status::ok, request.version());
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

void WebServer::Impl::answer(Tcp::socket socket) const {
  const auto exchange = std::make_shared<Exchange>(std::move(socket));
  exchange->stream.expires_after(kPatience);
  http::async_read(exchange->stream, exchange->buffer, exchange->request,
                   [this, exchange](beast::error_code error, std::size_t) {
                     if (error) return;
                     exchange->response = response_to(exchange->request);
                     http::async_write(exchange->stream, exchange->response,
                                       [exchange](beast::error_code, std::size_t) {
                                         beast::error_code none;
                                         exchange->stream.socket().shutdown(
                                             Tcp::socket::shutdown_both, none);
                                       });
                   });
}

void WebServer::Impl::accept() {
  acceptor.async_accept([this](beast::error_code error, Tcp::socket socket) {
    if (!error) {
      answer(std::move(socket));
      return accept();
    }
    pause.expires_after(kPause);
    pause.async_wait([this](beast::error_code stopped) {
      if (!stopped) accept();
    });
  });
}

WebServer::WebServer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {
  impl_->accept();
  impl_->thread = std::thread([server = impl_.get()] { server->context.run(); });
}

WebServer::~WebServer() {
  impl_->context.stop();
  impl_->thread.join();
}

Result<std::unique_ptr<WebServer>> WebServer::start(const std::string& address, std::uint16_t port,
                                                    Handler handler) {
  auto impl = std::make_unique<Impl>();
  impl->handler = std::move(handler);
  beast::error_code error;
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
