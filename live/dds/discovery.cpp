// SPDX-License-Identifier: BSD-3-Clause
#include "live/dds/discovery.hpp"

#include <dds/dds.h>

#include <algorithm>
#include <cstring>
#include <string_view>

namespace aims {
namespace {

constexpr std::string_view kTopicPrefix = "rt/";
constexpr std::string_view kMiddle = "::msg::dds_::";
constexpr std::size_t kBatch = 16;  ///< samples per call of DDS

OfferedQuality quality_of(const dds_qos_t* qos) {
  auto reliability = DDS_RELIABILITY_BEST_EFFORT;
  auto durability = DDS_DURABILITY_VOLATILE;
  dds_duration_t blocking = 0;
  dds_qget_reliability(qos, &reliability, &blocking);
  dds_qget_durability(qos, &durability);
  return {reliability == DDS_RELIABILITY_RELIABLE, durability != DDS_DURABILITY_VOLATILE};
}

/// What a node of this project says of itself.
Time began(const dds_qos_t* qos) {
  void* data = nullptr;
  std::size_t size = 0;
  Time time = 0;
  if (dds_qget_userdata(qos, &data, &size) && size == sizeof(time)) {
    std::memcpy(&time, data, sizeof(time));
  }
  dds_free(data);
  return time;
}

}  // namespace

std::string dds_topic(const std::string& topic) {
  return std::string(kTopicPrefix) + topic.substr(topic.starts_with("/") ? 1 : 0);
}

std::optional<std::string> ros_topic(const std::string& dds) {
  if (!dds.starts_with(kTopicPrefix) || dds.size() == kTopicPrefix.size()) return std::nullopt;
  return dds.substr(kTopicPrefix.size() - 1);  // from the slash on
}

std::string dds_type(const std::string& type) {
  const std::size_t slash = type.find('/');
  if (slash == std::string::npos) return type;
  return type.substr(0, slash) + std::string(kMiddle) + type.substr(slash + 1) + "_";
}

std::optional<std::string> ros_type(const std::string& dds) {
  const std::size_t middle = dds.find(kMiddle);
  const std::size_t name = middle + kMiddle.size();
  if (middle == std::string::npos || middle == 0 || dds.size() < name + 2 || !dds.ends_with("_")) {
    return std::nullopt;
  }
  return dds.substr(0, middle) + "/" + dds.substr(name, dds.size() - name - 1);
}

Result<Discovery> Discovery::create(std::int32_t participant) {
  Discovery discovery;
  dds_guid_t own = {};
  dds_get_guid(participant, &own);
  std::memcpy(discovery.own_.data(), own.v, discovery.own_.size());
  discovery.reader_ =
      dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPUBLICATION, nullptr, nullptr);
  if (discovery.reader_ < 0) return failure("DDS discovery is not available");
  return discovery;
}

void Discovery::update() {
  std::array<void*, kBatch> samples{};
  std::array<dds_sample_info_t, kBatch> infos{};
  int count = 0;
  std::map<std::uint64_t, Offer> came;
  while ((count = dds_take(reader_, samples.data(), infos.data(), kBatch, kBatch)) > 0) {
    for (std::size_t i = 0; i < static_cast<std::size_t>(count); ++i) {
      if (!infos[i].valid_data || infos[i].instance_state != DDS_IST_ALIVE) {
        offers_.erase(infos[i].instance_handle);
        came.erase(infos[i].instance_handle);
        continue;
      }
      const auto& endpoint = *static_cast<const dds_builtintopic_endpoint_t*>(samples[i]);
      if (std::memcmp(endpoint.participant_key.v, own_.data(), own_.size()) == 0) continue;
      const auto topic = ros_topic(endpoint.topic_name);
      const auto type = ros_type(endpoint.type_name);
      if (!topic || !type) continue;
      came[infos[i].instance_handle] = {*topic, *type, aims::quality_of(endpoint.qos),
                                        began(endpoint.qos)};
    }
    dds_return_loan(reader_, samples.data(), count);
  }
  // Those that went are gone by now: a driver that restarts is not there twice.
  for (auto& [instance, offer] : came) {
    const std::string& topic = (offers_[instance] = std::move(offer)).topic;
    if (const std::size_t all = offers_of(topic).size(); all > 1) {
      doubled_[topic] = std::max(doubled_[topic], all);
    }
  }
}

std::map<std::string, std::string> Discovery::topics() const {
  std::map<std::string, std::string> types;
  for (const auto& [instance, offer] : offers_) types[offer.topic] = offer.type;
  return types;
}

std::vector<Discovery::Offer> Discovery::offers_of(const std::string& topic) const {
  std::vector<Offer> found;
  for (const auto& [instance, offer] : offers_) {
    if (offer.topic == topic) found.push_back(offer);
  }
  return found;
}

std::map<std::string, std::size_t> Discovery::take_doubled() {
  auto found = doubled_;
  for (auto& [topic, count] : doubled_) count = offers_of(topic).size();
  std::erase_if(doubled_, [](const auto& each) { return each.second < 2; });
  return found;
}

OfferedQuality Discovery::quality_of(const std::string& topic) const {
  const std::vector<Offer> offers = offers_of(topic);
  // Before there is a publisher: the quality that matches any.
  OfferedQuality all{!offers.empty(), !offers.empty()};
  for (const Offer& each : offers) {
    all.reliable = all.reliable && each.quality.reliable;
    all.transient_local = all.transient_local && each.quality.transient_local;
  }
  all.transient_local = all.transient_local && all.reliable;
  return all;
}

}  // namespace aims
