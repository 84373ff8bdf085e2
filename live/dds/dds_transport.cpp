// SPDX-License-Identifier: BSD-3-Clause
#include "live/dds/dds_transport.hpp"

#include <dds/dds.h>
#include <dds/ddsi/ddsi_serdata.h>
#include <fmt/format.h>
#include <signal.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdlib>
#include <mutex>
#include <set>
#include <span>
#include <utility>

#include "live/dds/dds_names.hpp"
#include "live/dds/discovery.hpp"
#include "live/dds/raw_type.hpp"
#include "live/inbox.hpp"

namespace aims {
namespace {

constexpr int kHistory = 100;       ///< messages of a topic that wait in DDS
constexpr std::size_t kBatch = 16;  ///< samples per call of DDS

constexpr auto kWatchPeriod = std::chrono::seconds(1);

std::atomic<bool> end_requested{false};
static_assert(std::atomic<bool>::is_always_lock_free);
void request_end(int) { end_requested = true; }

/// A receive buffer that holds a cloud: with CycloneDDS's own of 1 MB, what does not fit is sent
/// again, late. A writer keeps what a subscriber that was killed does not acknowledge until that is
/// noticed, after 10 s; by default 500 kB, then all others wait. It asks for acknowledgements every
/// 10 ms, for those who wait for them. What CYCLONEDDS_URI says takes precedence.
void configure_dds() {
  constexpr const char* kVariable = "CYCLONEDDS_URI";
  const std::string own =
      "<CycloneDDS><Domain><Internal><SocketReceiveBufferSize max=\"16 MiB\"/>"
      "<Watermarks><WhcHigh>512 MiB</WhcHigh></Watermarks>"
      "<HeartbeatInterval minsched=\"10 ms\">10 ms</HeartbeatInterval>"
      "</Internal></Domain></CycloneDDS>";
  const char* set = std::getenv(kVariable);
  const std::string given = set == nullptr ? "" : set;
  if (given.starts_with(own)) return;
  setenv(kVariable, (given.empty() ? own : own + "," + given).c_str(), 1);
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

struct DdsTransport::Impl {
  /// One topic of which this node receives messages.
  struct Subscription {
    Impl* owner = nullptr;
    std::shared_ptr<const LiveConnection> connection;
    bool reliable = false;
    dds_entity_t topic = 0;
    dds_entity_t reader = 0;
    std::atomic<bool> refused{false};  ///< a publisher offers less than was asked for
  };

  explicit Impl(DdsOptions given) : options(std::move(given)) {}

  DdsOptions options;
  dds_entity_t participant = 0;
  Discovery discovery;
  std::map<std::string, std::unique_ptr<Subscription>> subscriptions;
  std::vector<dds_entity_t> writers;
  std::chrono::steady_clock::time_point watched;
  std::set<std::string> told;  ///< problems

  mutable std::mutex mutex;  ///< of what follows, which DDS's threads use too
  std::condition_variable arrived;
  Inbox inbox;
  std::vector<std::string> problems;
  std::size_t lost = 0;

  void open(Subscription& subscription);
  static void close(Subscription& subscription);
  void reopen_refused();
  void watch_publishers();
  void tell(std::string problem);
  dds_entity_t make_topic(const std::string& topic, const std::string& type) const;
  static void receive(dds_entity_t reader, void* argument);
  static void miss(dds_entity_t reader, dds_sample_lost_status_t status, void* argument);
  static void refuse(dds_entity_t reader, dds_requested_incompatible_qos_status_t status,
                     void* argument);
  void take(const Subscription& subscription, const ddsi_serdata& sample, std::int64_t sent);
};

/// Each problem once.
void DdsTransport::Impl::tell(std::string problem) {
  const std::lock_guard lock(mutex);
  if (told.insert(problem).second) problems.push_back(std::move(problem));
}

void DdsTransport::Impl::take(const Subscription& subscription, const ddsi_serdata& sample,
                              std::int64_t sent) {
  const auto bytes = raw_bytes(sample);
  if (bytes.empty()) return;
  LiveMessage message;
  message.connection = subscription.connection;
  message.arrival = options.source_time ? std::max<std::int64_t>(sent, 1) : wall_time();
  message.data.assign(bytes.begin(), bytes.end());
  const std::lock_guard lock(mutex);
  inbox.push(std::move(message));
}

/// Called by DDS when a reader has data.
void DdsTransport::Impl::receive(dds_entity_t reader, void* argument) {
  auto& subscription = *static_cast<Subscription*>(argument);
  std::array<ddsi_serdata*, kBatch> samples{};
  std::array<dds_sample_info_t, kBatch> infos{};
  int count = 0;
  do {
    count = dds_takecdr(reader, samples.data(), kBatch, infos.data(), DDS_ANY_STATE);
    for (int i = 0; i < count; ++i) {
      const auto place = static_cast<std::size_t>(i);
      if (infos[place].valid_data) {
        subscription.owner->take(subscription, *samples[place], infos[place].source_timestamp);
      }
      ddsi_serdata_unref(samples[place]);
    }
  } while (count == static_cast<int>(kBatch));
  subscription.owner->arrived.notify_one();
}

/// Called by DDS when messages did not arrive.
void DdsTransport::Impl::miss(dds_entity_t /*reader*/, dds_sample_lost_status_t status,
                              void* argument) {
  Impl& owner = *static_cast<Subscription*>(argument)->owner;
  const std::lock_guard lock(owner.mutex);
  owner.lost += status.total_count_change;
}

/// Called by DDS when a publisher's quality is below what a reader asks for.
void DdsTransport::Impl::refuse(dds_entity_t /*reader*/,
                                dds_requested_incompatible_qos_status_t status, void* argument) {
  auto& subscription = *static_cast<Subscription*>(argument);
  const std::uint32_t policy = status.last_policy_id;
  subscription.owner->tell(fmt::format("a publisher of {} does not match in {}{}",
                                       subscription.connection->topic, name_of_policy(policy),
                                       subscription.reliable ? "; subscribed as best effort" : ""));
  subscription.refused = subscription.reliable;
}

dds_entity_t DdsTransport::Impl::make_topic(const std::string& topic,
                                            const std::string& type) const {
  ddsi_sertype* raw = make_raw_type(dds_type(type));
  const dds_entity_t made = dds_create_topic_sertype(participant, dds_topic(topic).c_str(), &raw,
                                                     nullptr, nullptr, nullptr);
  if (made < 0) ddsi_sertype_unref(raw);
  return made;
}

void DdsTransport::Impl::open(Subscription& subscription) {
  const std::string& topic = subscription.connection->topic;
  const Qos qos = quality({subscription.reliable, subscription.connection->latching}, 0.0);
  dds_qset_ignorelocal(qos.get(), DDS_IGNORELOCAL_PARTICIPANT);
  const Listener listener(dds_create_listener(&subscription), dds_delete_listener);
  dds_lset_data_available(listener.get(), receive);
  dds_lset_sample_lost(listener.get(), miss);
  dds_lset_requested_incompatible_qos(listener.get(), refuse);
  subscription.topic = make_topic(topic, subscription.connection->type);
  if (subscription.topic > 0) {
    subscription.reader =
        dds_create_reader(participant, subscription.topic, qos.get(), listener.get());
  }
  if (subscription.topic < 0 || subscription.reader < 0) {
    const dds_return_t code = std::min(subscription.topic, subscription.reader);
    tell(fmt::format("cannot subscribe to {}: {}", topic, dds_strretcode(code)));
  }
}

void DdsTransport::Impl::close(Subscription& subscription) {
  if (subscription.reader > 0) dds_delete(subscription.reader);
  if (subscription.topic > 0) dds_delete(subscription.topic);
  subscription.reader = subscription.topic = 0;
}

/// Subscribes again, as best effort, where a publisher offers no more.
void DdsTransport::Impl::reopen_refused() {
  for (auto& [topic, subscription] : subscriptions) {
    if (!subscription->refused.exchange(false)) continue;
    close(*subscription);
    auto connection = *subscription->connection;
    connection.latching = false;
    subscription->connection = std::make_shared<LiveConnection>(std::move(connection));
    subscription->reliable = false;
    open(*subscription);
  }
}

/// Now and then reports topics of another type, or of which two publishers send; of diagnostics and
/// transforms there may be several.
void DdsTransport::Impl::watch_publishers() {
  const auto now = std::chrono::steady_clock::now();
  if (now - watched < kWatchPeriod) return;
  watched = now;
  discovery.update();
  for (const auto& [topic, subscription] : subscriptions) {
    const std::string& type = subscription->connection->type;
    if (const std::string other = discovery.other_type(topic, type); !other.empty()) {
      tell(fmt::format("a publisher of {} sends {}: expected {}, it is not heard", topic, other,
                       type));
    }
    if (type == "tf2_msgs/TFMessage" || type == "diagnostic_msgs/DiagnosticArray") continue;
    const std::size_t count = discovery.publishers(topic);
    if (count > 1) tell(fmt::format("{} has {} publishers: expected one", topic, count));
  }
}

DdsTransport::DdsTransport(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

DdsTransport::~DdsTransport() {
  // Ends all callbacks before what they use.
  if (impl_->participant > 0) dds_delete(impl_->participant);
}

Result<std::unique_ptr<DdsTransport>> DdsTransport::connect(const DdsOptions& options) {
  auto impl = std::make_unique<Impl>(options);
  configure_dds();
  impl->participant = dds_create_participant(options.domain, nullptr, nullptr);
  if (impl->participant < 0) {
    return failure(fmt::format("DDS domain {}: {}; see CYCLONEDDS_URI", options.domain,
                               dds_strretcode(impl->participant)));
  }
  auto discovery = Discovery::create(impl->participant);
  if (!discovery) return tl::unexpected(discovery.error());
  impl->discovery = std::move(*discovery);
  signal(SIGINT, request_end);
  signal(SIGTERM, request_end);
  // A lost ssh connection; under nohup it stays ignored.
  if (signal(SIGHUP, request_end) == SIG_IGN) signal(SIGHUP, SIG_IGN);
  return std::unique_ptr<DdsTransport>(new DdsTransport(std::move(impl)));
}

bool DdsTransport::running() const { return !end_requested; }

std::map<std::string, std::string> DdsTransport::topics() {
  impl_->discovery.update();
  return impl_->discovery.topics();
}

std::string DdsTransport::resolved(const std::string& topic) const {
  if (topic.starts_with("~")) return fmt::format("/{}/{}", impl_->options.node, topic.substr(1));
  return topic.starts_with("/") ? topic : fmt::format("/{}", topic);
}

void DdsTransport::subscribe(const std::string& topic, const std::string& type) {
  const std::string name = resolved(topic);
  if (impl_->subscriptions.contains(name)) return;
  impl_->discovery.update();
  const OfferedQuality offered = impl_->discovery.quality_of(name);
  auto subscription = std::make_unique<Impl::Subscription>();
  subscription->owner = impl_.get();
  subscription->connection = std::make_shared<LiveConnection>(
      LiveConnection{name, type, {}, {}, offered.transient_local, true});
  subscription->reliable = offered.reliable;
  impl_->open(*subscription);
  impl_->subscriptions.emplace(name, std::move(subscription));
}

void DdsTransport::unsubscribe(const std::string& topic) {
  const auto found = impl_->subscriptions.find(resolved(topic));
  if (found == impl_->subscriptions.end()) return;
  Impl::close(*found->second);
  impl_->subscriptions.erase(found);
}

std::optional<LiveMessage> DdsTransport::wait(double seconds) {
  impl_->reopen_refused();
  impl_->watch_publishers();
  std::unique_lock lock(impl_->mutex);
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  while (impl_->inbox.empty()) {
    if (!running() || std::chrono::steady_clock::now() >= end) return std::nullopt;
    // A signal does not wake the condition.
    impl_->arrived.wait_for(lock, std::chrono::milliseconds(50));
  }
  return impl_->inbox.pop();
}

std::size_t DdsTransport::dropped() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->inbox.dropped();
}

std::size_t DdsTransport::lost() const {
  const std::lock_guard lock(impl_->mutex);
  return impl_->lost;
}

void DdsTransport::limit_wait(std::int64_t longest) {
  const std::lock_guard lock(impl_->mutex);
  impl_->inbox.limit_wait(longest);
}

std::vector<std::string> DdsTransport::take_problems() {
  const std::lock_guard lock(impl_->mutex);
  return std::exchange(impl_->problems, {});
}

std::size_t DdsTransport::advertise(const LiveConnection& connection) {
  const std::string topic = resolved(connection.topic);
  const dds_entity_t made = impl_->make_topic(topic, connection.type);
  const Qos qos = quality({true, connection.latching}, impl_->options.max_blocking);
  if (impl_->options.keep_all) dds_qset_history(qos.get(), DDS_HISTORY_KEEP_ALL, 0);
  const dds_entity_t writer =
      made > 0 ? dds_create_writer(impl_->participant, made, qos.get(), nullptr) : made;
  if (writer < 0) impl_->tell(fmt::format("cannot publish {}: {}", topic, dds_strretcode(writer)));
  impl_->writers.push_back(writer);
  return impl_->writers.size() - 1;
}

void DdsTransport::publish(std::size_t publisher, const std::byte* data, std::size_t size) {
  publish_at(publisher, wall_time(), data, size);
}

bool DdsTransport::publish_at(std::size_t publisher, std::int64_t time, const std::byte* data,
                              std::size_t size) {
  const std::span<const std::byte> bytes(data, size);
  const dds_entity_t writer = impl_->writers.at(publisher);
  return writer > 0 && dds_write_ts(writer, &bytes, time) == DDS_RETCODE_OK;
}

std::size_t DdsTransport::subscribers(std::size_t publisher) const {
  dds_publication_matched_status_t status = {};
  dds_get_publication_matched_status(impl_->writers.at(publisher), &status);
  return status.current_count;
}

std::size_t DdsTransport::wait_for_subscribers(double seconds) const {
  std::size_t unanswered = 0;
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
  for (const dds_entity_t writer : impl_->writers) {
    const std::chrono::duration<double> left = end - std::chrono::steady_clock::now();
    const auto patience = static_cast<dds_duration_t>(std::max(left.count(), 0.0) * 1e9);
    if (writer > 0 && dds_wait_for_acks(writer, patience) != DDS_RETCODE_OK) ++unanswered;
  }
  return unanswered;
}

}  // namespace aims
