// SPDX-License-Identifier: BSD-3-Clause
#include "live/watch/watch_server.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <sys/socket.h>
#include <unistd.h>

#include <string>

namespace aims {
namespace {

/// What the server answers to these bytes; empty: it closed.
std::string answer(std::uint16_t port, const std::string& request) {
  const int client = socket(AF_INET, SOCK_STREAM, 0);
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  address.sin_port = htons(port);
  address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
  EXPECT_EQ(connect(client, reinterpret_cast<const sockaddr*>(&address), sizeof(address)), 0);
  EXPECT_EQ(send(client, request.data(), request.size(), MSG_NOSIGNAL),
            static_cast<ssize_t>(request.size()));
  std::string text;
  char bytes[4096];
  for (ssize_t size = 0; (size = recv(client, bytes, sizeof(bytes), 0)) > 0;) {
    text.append(bytes, static_cast<std::size_t>(size));
  }
  close(client);
  return text;
}

class WatchServerTest : public testing::Test {
 protected:
  WatchServerTest() {
    auto started = WatchServer::start("127.0.0.1", 0, state_);
    EXPECT_TRUE(started) << started.error().message;
    server_ = std::move(*started);
  }
  std::string get(const std::string& target, const std::string& host) const {
    return answer(server_->port(), "GET " + target + " HTTP/1.1\r\nHost: " + host + "\r\n\r\n");
  }
  WatchState state_{"/aims/odometry"};
  std::unique_ptr<WatchServer> server_;
};

TEST_F(WatchServerTest, AnswersWithTheState) {
  const std::string found = get("/state.json?epoch=1", "127.0.0.1:8631");
  EXPECT_TRUE(found.starts_with("HTTP/1.1 200 ")) << found;
  EXPECT_TRUE(found.ends_with("\r\n\r\n" + state_.json(1, 0))) << found;
  EXPECT_NE(found.find("Content-Type: application/json"), std::string::npos);
  EXPECT_NE(found.find("X-Content-Type-Options: nosniff"), std::string::npos);
  EXPECT_TRUE(get("/gone", "localhost").starts_with("HTTP/1.1 404 "));
}

TEST_F(WatchServerTest, TakesNoCommands) {
  for (const char* method : {"POST", "PUT", "DELETE"}) {
    const std::string request =
        std::string(method) + " /state.json?epoch=1 HTTP/1.1\r\nHost: localhost\r\n\r\n";
    EXPECT_TRUE(answer(server_->port(), request).starts_with("HTTP/1.1 405 ")) << method;
  }
}

TEST_F(WatchServerTest, RefusesPagesOfOtherSites) {
  for (const char* host : {"evil.example", "evil.example:8631", "", "localhost.evil.example"}) {
    EXPECT_TRUE(get("/state.json?epoch=1", host).starts_with("HTTP/1.1 403 ")) << host;
  }
  for (const char* host : {"localhost", "localhost:1", "[::1]:8631", "127.0.0.1"}) {
    EXPECT_TRUE(get("/state.json?epoch=1", host).starts_with("HTTP/1.1 200 ")) << host;
  }
}

TEST_F(WatchServerTest, SurvivesWhatIsNoRequest) {
  EXPECT_EQ(answer(server_->port(), std::string(20'000, 'x') + "\r\n\r\n").find(" 200 "),
            std::string::npos);
  EXPECT_TRUE(get("/state.json", "localhost").starts_with("HTTP/1.1 200 "));
}

TEST_F(WatchServerTest, NamesTheAddressThatIsNoneAndThePortThatIsTaken) {
  const auto wrong = WatchServer::start("here.invalid", 0, state_);
  ASSERT_FALSE(wrong);
  EXPECT_NE(wrong.error().message.find("here.invalid port 0: expected an address"),
            std::string::npos);
  const auto taken = WatchServer::start("127.0.0.1", server_->port(), state_);
  ASSERT_FALSE(taken);
  EXPECT_NE(taken.error().message.find("a free port"), std::string::npos);
}

}  // namespace
}  // namespace aims
