// SPDX-License-Identifier: BSD-3-Clause
#include "live/dds/dds_transport.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <span>
#include <string_view>
#include <utility>

#include "recordings/messages/message_types.hpp"

namespace aims {
namespace {

constexpr int kHistory = 100;       ///< messages of a topic that wait in DDS
constexpr std::size_t kBatch = 16;  ///< samples per call of DDS
constexpr std::size_t kHeader = 4;  ///< of CDR [bytes]

/// Times of sending by this computer's clock are as near, also on a busy one.
constexpr Duration kOwnClock = 5 * kSecond;

constexpr auto kWatchPeriod = std::chrono::seconds(1);

constexpr const char* kConfiguration = "CYCLONEDDS_URI";
/// What ROS_LOCALHOST_ONLY=1 means.
constexpr const char* kThisComputer =
    "<CycloneDDS><Domain><General><Interfaces><NetworkInterface address=\"127.0.0.1\"/>"
    "</Interfaces><AllowMulticast>false</AllowMulticast></General><Discovery>"
    "<ParticipantIndex>auto</ParticipantIndex><Peers><Peer Address=\"127.0.0.1\"/></Peers>"
    "</Discovery></Domain></CycloneDDS>";

/// A receive buffer that holds a cloud: with CycloneDDS's own of 1 MB, what does not fit is sent
/// again, late. A writer keeps what a subscriber that was killed does not acknowledge until that is
/// noticed, after 10 s; by default 500 kB, then all others wait. It asks for acknowledgements every
/// 10 ms, for those who wait for them. What CYCLONEDDS_URI says takes precedence.
constexpr std::string_view kOwn =
    "<CycloneDDS><Domain><Internal><SocketReceiveBufferSize max=\"16 MiB\"/>"
    "<Watermarks><WhcHigh>512 MiB</WhcHigh></Watermarks>"
    "<HeartbeatInterval minsched=\"10 ms\">10 ms</HeartbeatInterval>"
    "</Internal></Domain></CycloneDDS>,";

/// What the user says.
std::string given_configuration() {
  const char* set = std::getenv(kConfiguration);
  const std::string given = set == nullptr ? "" : set;
  return given.starts_with(kOwn) ? given.substr(kOwn.size()) : given;
}

void configure_dds() {
  const char* here = std::getenv("ROS_LOCALHOST_ONLY");
  std::string given = given_configuration();
  if (given.empty() && here != nullptr && std::string_view(here) == "1") given = kThisComputer;
  setenv(kConfiguration, fmt::format("{}{}", kOwn, given).c_str(), 1);
}

using Qos = std::unique_ptr<dds_qos_t, decltype(&dds_delete_qos)>;
using Listener = std::unique_ptr<dds_listener_t, decltype(&dds_delete_listener)>;

Qos quality(const OfferedQuality& offered, double blocking) {
  Qos qos(dds_create_qos(), dds_delete_qos);
  const dds_data_representation_id_t representation = DDS_DATA_REPRESENTATION_XCDR1;
  dds_qset_data_representation(qos.get(), 1, &representation);
  dds_qset_reliability(qos.get(),
                       offered.reliable ? DDS_RELIABILITY_RELIABLE : DDS_RELIABILITY_BEST_EFFORT,
                       static_cast<dds_duration_t>(blocking * 1e9));
  dds_qset_durability(qos.get(), offered.transient_local ? DDS_DURABILITY_TRANSIENT_LOCAL
                                                         : DDS_DURABILITY_VOLATILE);
  dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, kHistory);
  dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, kHistory, DDS_LENGTH_UNLIMITED,
                              DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);  // of past messages
  return qos;
}

const char* name_of_policy(std::uint32_t policy) {
  if (policy == DDS_RELIABILITY_QOS_POLICY_ID) return "reliability";
  if (policy == DDS_DURABILITY_QOS_POLICY_ID) return "durability";
  if (policy == DDS_DATA_REPRESENTATION_QOS_POLICY_ID) return "data representation (not XCDR1)";
  return "another policy than reliability and durability";
}

}  // namespace

/// When a message arrived. With `source_time` one that was sent by this computer's clock is none of
/// a recording that is played: it comes with what was played last; 0: nothing yet.
Time DdsTransport::arrival_of(Time sent, bool latching) {
  const Time now = wall_time();
  if (!options_.source_time) return now;
  const bool of_player = std::abs(now - sent) > kOwnClock;
  // A latched message may have been sent by this computer's clock long ago.
  if (latching) return of_player && played_ == 0 ? std::max<Time>(sent, 1) : played_.load();
  if (!of_player) return played_;
  return played_ = std::max<Time>(sent, 1);  // not what another thread stores meanwhile
}

/// Counts what a writer numbered since its last sample and what did not arrive: lost on the way, or
/// no longer kept for this program when it could read on, as after it was stopped.
void DdsTransport::count_lost(Subscription& subscription, const SampleOrigin& origin) {
  if (origin.number == 0) return;
  const auto [last, added] = subscription.last.try_emplace(origin.writer, origin.number);
  if (!added && origin.number > last->second) lost_ += origin.number - last->second - 1;
  last->second = std::max(last->second, origin.number);
}

/// Called by DDS, in its own threads, when a reader has data.
void DdsTransport::take_samples(Subscription& subscription, Entity reader) {
  std::array<ddsi_serdata*, kBatch> samples{};
  std::array<dds_sample_info_t, kBatch> infos{};
  int count = 0;
  do {
    count = dds_takecdr(reader, samples.data(), kBatch, infos.data(), DDS_ANY_STATE);
    for (int i = 0; i < count; ++i) {
      const auto place = static_cast<std::size_t>(i);
      const auto bytes = raw_bytes(*samples[place]);
      count_lost(subscription, origin_of(*samples[place]));
      if (infos[place].valid_data && !bytes.empty()) {
        inbox_.push({subscription.connection,
                     arrival_of(infos[place].source_timestamp, subscription.connection->latching),
                     {bytes.begin(), bytes.end()}});
      }
      ddsi_serdata_unref(samples[place]);
    }
  } while (count == static_cast<int>(kBatch));
}

/// Called by DDS when a publisher's quality is below what a reader asks for.
void DdsTransport::refuse(Subscription& subscription, std::uint32_t policy) {
  tell(fmt::format("a publisher of {} does not match in {}{}", subscription.connection->topic,
                   name_of_policy(policy),
                   subscription.reliable ? "; subscribed as best effort" : ""));
  subscription.refused = subscription.reliable;
}

dds_entity_t DdsTransport::make_topic(const std::string& topic, const std::string& type) const {
  ddsi_sertype* raw = make_raw_type(dds_type(type));
  const dds_entity_t made = dds_create_topic_sertype(participant_, dds_topic(topic).c_str(), &raw,
                                                     nullptr, nullptr, nullptr);
  if (made < 0) ddsi_sertype_unref(raw);
  return made;
}

std::unique_ptr<DdsTransport::Subscription> DdsTransport::open(BagConnection connection,
                                                               bool reliable, LastSamples last) {
  const Qos qos = quality({reliable, connection.latching}, 0.0);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  std::unique_ptr<Subscription> opened(
      new Subscription{*this, std::make_shared<BagConnection>(std::move(connection)), reliable});
  opened->last = std::move(last);
  const Listener listener(dds_create_listener(opened.get()), dds_delete_listener);
  dds_lset_data_available(listener.get(), [](dds_entity_t reader, void* of) {
    auto& from = *static_cast<Subscription*>(of);
    from.owner.take_samples(from, reader);
  });
  dds_lset_requested_incompatible_qos(
      listener.get(), [](dds_entity_t, dds_requested_incompatible_qos_status_t status, void* of) {
        auto& from = *static_cast<Subscription*>(of);
        from.owner.refuse(from, status.last_policy_id);
      });
  const std::string& topic = opened->connection->topic;
  opened->topic = make_topic(topic, opened->connection->type);
  opened->reader = opened->topic;
  if (opened->topic > 0) {
    opened->reader = dds_create_reader(participant_, opened->topic, qos.get(), listener.get());
  }
  if (opened->reader < 0) {
    tell(fmt::format("cannot subscribe to {}: {}", topic, dds_strretcode(opened->reader)));
  }
  return opened;
}

DdsTransport::Subscription::~Subscription() {
  if (reader > 0) dds_delete(reader);
  if (topic > 0) dds_delete(topic);
}

/// Subscribes again, as best effort, where a publisher offers no more.
void DdsTransport::reopen_refused() {
  for (auto& [topic, subscription] : subscriptions_) {
    if (!subscription->refused) continue;
    BagConnection connection = *subscription->connection;
    connection.latching = false;
    dds_delete(std::exchange(subscription->reader, 0));  // ends its callbacks
    auto last = std::move(subscription->last);
    subscription.reset();  // or both would hear some publishers
    subscription = open(std::move(connection), false, std::move(last));
  }
}

/// Now and then reports topics of another type, or of which two publishers send; of diagnostics and
/// transforms there may be several.
void DdsTransport::watch_publishers() {
  const auto now = std::chrono::steady_clock::now();
  if (now - watched_ < kWatchPeriod) return;
  watched_ = now;
  discovery_.update();
  for (const auto& [topic, subscription] : subscriptions_) {
    const std::string& type = subscription->connection->type;
    const auto offers = discovery_.offers_of(topic);
    const auto other = std::ranges::find_if(offers, [&](auto& each) { return each.type != type; });
    if (other != offers.end()) {
      tell(fmt::format("a publisher of {} sends {}: expected {}, it is not heard", topic,
                       other->type, type));
    }
    if (type == "tf2_msgs/TFMessage" || type == "diagnostic_msgs/DiagnosticArray") continue;
    if (offers.size() < 2) continue;
    tell(fmt::format("{} has {} publishers: expected one", topic, offers.size()));
  }
}

DdsTransport::~DdsTransport() {
  // Ends all callbacks before what they use.
  subscriptions_.clear();
  if (participant_ > 0) dds_delete(participant_);
}

Result<std::unique_ptr<DdsTransport>> DdsTransport::connect(const DdsOptions& options) {
  std::unique_ptr<DdsTransport> made(new DdsTransport(options));
  configure_dds();
  made->participant_ = dds_create_participant(options.domain, nullptr, nullptr);
  if (made->participant_ < 0) {
    return failure(fmt::format("DDS domain {}: {}; see CYCLONEDDS_URI", options.domain,
                               dds_strretcode(made->participant_)));
  }
  auto discovery = Discovery::create(made->participant_);
  if (!discovery) return tl::unexpected(discovery.error());
  made->discovery_ = std::move(*discovery);
  return made;
}

std::map<std::string, std::string> DdsTransport::topics() {
  discovery_.update();
  return discovery_.topics();
}

bool DdsTransport::preceded(const std::string& topic) {
  discovery_.update();
  return std::ranges::any_of(discovery_.offers_of(topic),
                             [this](const auto& each) { return each.began < began_; });
}

std::string DdsTransport::place() const {
  const std::string given = given_configuration();
  return fmt::format(" on domain {}, {}", options_.domain,
                     given.empty()            ? "on the interface that CycloneDDS chooses"
                     : given == kThisComputer ? "on this computer alone (ROS_LOCALHOST_ONLY)"
                                              : fmt::format("{}={}", kConfiguration, given));
}

std::string DdsTransport::resolved(const std::string& topic) const {
  if (topic.starts_with("~")) return fmt::format("/{}/{}", options_.node, topic.substr(1));
  return topic.starts_with("/") ? topic : fmt::format("/{}", topic);
}

void DdsTransport::subscribe(const std::string& topic, const std::string& type) {
  const std::string name = resolved(topic);
  if (subscriptions_.contains(name)) return;
  discovery_.update();
  const OfferedQuality offered = discovery_.quality_of(name);
  BagConnection connection;
  connection.topic = name;
  connection.type = type;
  connection.latching = offered.transient_local;
  connection.format = kRos2Format;
  complete_definition(type, connection.definition, connection.format);
  subscriptions_.emplace(name, open(std::move(connection), offered.reliable));
}

void DdsTransport::unsubscribe(const std::string& topic) { subscriptions_.erase(resolved(topic)); }

std::optional<LiveMessage> DdsTransport::wait(double seconds) {
  reopen_refused();
  watch_publishers();
  return Transport::wait(seconds);
}

std::size_t DdsTransport::advertise(const std::string& topic, const MessageType& type,
                                    bool latching) {
  const std::string name = resolved(topic);
  const dds_entity_t made = make_topic(name, type.name);
  const Qos qos = quality({true, latching}, options_.max_blocking);
  dds_qset_userdata(qos.get(), &began_, sizeof(began_));
  if (options_.keep_all) dds_qset_history(qos.get(), DDS_HISTORY_KEEP_ALL, 0);
  const dds_entity_t writer =
      made > 0 ? dds_create_writer(participant_, made, qos.get(), nullptr) : made;
  if (writer < 0) tell(fmt::format("cannot publish {}: {}", name, dds_strretcode(writer)));
  writers_.push_back(writer);
  return writers_.size() - 1;
}

void DdsTransport::publish(std::size_t publisher, std::span<const std::byte> data) {
  publish_at(publisher, wall_time(), data);
}

bool DdsTransport::publish_at(std::size_t publisher, Time time, std::span<const std::byte> data) {
  const dds_entity_t writer = writers_.at(publisher);
  if (data.size() < kHeader) return false;  // it would break the stream
  return writer > 0 && dds_write_ts(writer, &data, time) == DDS_RETCODE_OK;
}

std::size_t DdsTransport::subscribers(std::size_t publisher) const {
  dds_publication_matched_status_t status = {};
  dds_get_publication_matched_status(writers_.at(publisher), &status);
  return status.current_count;
}

std::size_t DdsTransport::wait_for_subscribers(double seconds) const {
  std::size_t unanswered = 0;
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  for (const dds_entity_t writer : writers_) {
    const std::chrono::duration<double> left = end - std::chrono::steady_clock::now();
    const auto patience = static_cast<dds_duration_t>(std::max(left.count(), 0.0) * 1e9);
    if (writer > 0 && dds_wait_for_acks(writer, patience) != DDS_RETCODE_OK) ++unanswered;
  }
  return unanswered;
}

}  // namespace aims
