// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "live/transport.hpp"

namespace aims {

/// A node of a ROS 1 network. This header needs neither ROS nor C++20: roscpp, which is not C++20,
/// stays in one source.
class Ros1Transport final : public Transport {
 public:
  /// The arguments without those of ROS ("topic:=other", "__name:=other") and without the program's
  /// name.
  static std::vector<std::string> own_arguments(int argc, char** argv);

  /// Registers the node. Without a master: nullptr, and a line in `error`.
  static std::unique_ptr<Ros1Transport> connect(int argc, char** argv, const std::string& name,
                                                std::string& error);
  ~Ros1Transport() override;

  bool cdr() const override { return false; }
  bool running() const override;
  std::map<std::string, std::string> topics() override;
  std::string resolved(const std::string& topic) const override;
  void subscribe(const std::string& topic, const std::string& type) override;
  void unsubscribe(const std::string& topic) override;
  std::optional<LiveMessage> wait(double seconds) override;
  std::size_t dropped() const override;
  void limit_wait(std::int64_t longest) override;
  std::size_t advertise(const LiveConnection& connection) override;
  bool heard(std::size_t publisher) const override;
  void publish(std::size_t publisher, const std::byte* data, std::size_t size) override;

 private:
  struct Impl;
  explicit Ros1Transport(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace aims
