// SPDX-License-Identifier: BSD-3-Clause
// usage: garbage DOMAIN TOPIC TYPE [TOPIC TYPE]...: a broken participant, which sends what no
// message of that type is: random bytes of every length up to some hundred, then some that are
// longer than a cloud may be. usage: garbage DOMAIN listen TOPIC TYPE: one that says when it hears
// the topic, and listens until it is killed.
#include <cstdio>
#include <random>
#include <string>
#include <vector>

#include "live/dds/dds_transport.hpp"
#include "live/dds/raw_type.hpp"

namespace {

using namespace aims;

int listen(DdsTransport& transport, const std::string& topic, const std::string& type) {
  transport.subscribe(topic, type);
  while (transport.running() && !transport.wait(1.0)) continue;
  std::puts("heard");
  std::fflush(stdout);
  while (transport.running()) transport.wait(1.0);
  return 0;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 4) return 2;
  const auto transport = DdsTransport::connect(
      {.domain = static_cast<std::uint32_t>(std::stoul(argv[1])), .max_blocking = 5.0});
  if (!transport) return 2;
  if (argc == 5 && std::string(argv[2]) == "listen") return listen(**transport, argv[3], argv[4]);
  std::vector<std::size_t> topics;
  for (int i = 2; i + 1 < argc; i += 2) {
    topics.push_back((*transport)->advertise(argv[i], {argv[i + 1], {}, {}}, false));
  }
  for (const std::size_t topic : topics) {
    while ((*transport)->running() && !(*transport)->heard(topic)) (*transport)->wait(0.05);
  }
  std::mt19937 random(1);
  std::vector<std::byte> bytes;
  const auto send = [&](std::size_t size) {
    bytes.resize(size);
    for (std::byte& each : bytes) each = static_cast<std::byte>(random());
    if (random() % 2 == 0) bytes[0] = std::byte{0}, bytes[1] = std::byte{1};  // as CDR begins
    for (const std::size_t topic : topics) {
      (*transport)->publish(topic, bytes);
    }
  };
  for (std::size_t size = 4; size < 400; ++size) send(size);
  send(5'000'000);
  send(kMaxSample + 4);
  (*transport)->wait_for_subscribers(20.0);
  std::puts("sent");
}
