// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/error.hpp"
#include "live/transport.hpp"

namespace aims {

/// A node of a ROS 1 network.
class Ros1Transport final : public Transport {
 public:
  /// The arguments without those of ROS ("topic:=other", "__name:=other") and without the program's
  /// name.
  static std::vector<std::string> own_arguments(int argc, char** argv);

  /// Registers the node. Error without a master.
  static Result<std::unique_ptr<Ros1Transport>> connect(int argc, char** argv,
                                                        const std::string& name);
  ~Ros1Transport() override;

  MessageFormat format() const override { return kRos1Format; }
  bool running() const override;
  std::map<std::string, std::string> topics() override;
  std::string resolved(const std::string& topic) const override;
  void subscribe(const std::string& topic, const std::string& type) override;
  void unsubscribe(const std::string& topic) override;
  std::size_t advertise(const std::string& topic, const MessageType& type, bool latching) override;
  bool heard(std::size_t publisher) const override;
  void publish(std::size_t publisher, std::span<const std::byte> data) override;

 private:
  struct Impl;
  explicit Ros1Transport(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace aims
