// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/sequence_cache.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <system_error>
#include <tuple>
#include <vector>

#include "bench/estimate/stream.hpp"
#include "bench/jobs/job_id.hpp"
#include "bench/run/code_version.hpp"
#include "bench/run/sequence_file.hpp"
#include "core/background_tasks.hpp"
#include "core/files/config_dump.hpp"
#include "sim/simulation.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// What the sequence is of: the simulation's configuration alone.
std::string simulation_text(const Scenario& scenario) {
  SimulationConfig copy = scenario.simulation;
  return dump_config(fields_of(copy));
}

Result<SequenceMade> simulate(const Scenario& scenario, std::uint64_t seed, const fs::path& file,
                              const std::function<void(double)>& observer, int threads) {
  auto simulation = Simulation::create(scenario.simulation, seed, threads);
  if (!simulation) return SequenceMade{false, located(scenario, simulation.error()).message};
  const std::string origin =
      fmt::format("# simulator {}, scenario {}, seed {}\n{}", simulator_version(), scenario.name,
                  seed, simulation_text(scenario));
  auto writer = SequenceWriter::create(file, simulation->rig(), origin);
  if (!writer) return tl::unexpected(writer.error());
  const double expected_s = to_seconds(simulation->expected_duration());
  std::vector<Delivery> deliveries;
  std::vector<Delivery> before;  // while the next are simulated, these are written
  Result<void> written;
  BackgroundTasks writes(threads);
  for (bool moving = true; moving;) {
    deliveries.clear();
    moving = simulation->advance(kStreamBatch, deliveries);
    writes.wait();
    if (!written) return tl::unexpected(written.error());
    std::swap(before, deliveries);
    writes.add([&] { written = writer->write(before); });
    if (observer) observer(std::min(1.0, to_seconds(simulation->now()) / expected_s));
  }
  writes.wait();
  if (!written) return tl::unexpected(written.error());
  if (auto done = writer->finish(simulation->truth()); !done) return tl::unexpected(done.error());
  return SequenceMade{true, std::nullopt};
}

/// A sequence of the cache.
struct CachedSequence {
  fs::path file;
  std::uintmax_t bytes = 0;
  fs::file_time_type used;
};

/// Every complete sequence of the folder, the one that was used longest ago first.
std::vector<CachedSequence> sequences_in(const fs::path& folder) {
  std::vector<CachedSequence> sequences;
  std::error_code code;
  for (const auto& entry : fs::directory_iterator(folder, code)) {
    if (entry.path().extension() != ".sequence") continue;
    CachedSequence sequence{entry.path(), entry.file_size(code), {}};
    if (code) continue;  // another process has removed it just now
    sequence.used = entry.last_write_time(code);
    if (!code) sequences.push_back(std::move(sequence));
  }
  std::sort(sequences.begin(), sequences.end(),
            [](const CachedSequence& a, const CachedSequence& b) {
              return std::tie(a.used, a.file) < std::tie(b.used, b.file);
            });
  return sequences;
}

/// Removes what processes that were killed while they made `file` have left: gigabytes. Whoever
/// holds the sequence's lock may.
void clear_remains(const fs::path& file) {
  const std::string start = file.filename().string() + ".";
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator(file.parent_path(), ignored)) {
    const std::string name = entry.path().filename().string();
    if (name.starts_with(start) && name.ends_with(".tmp")) fs::remove(entry.path(), ignored);
  }
}

}  // namespace

fs::path SequenceCache::default_folder() {
  const auto folder_in = [](const char* variable) -> fs::path {
    const char* value = std::getenv(variable);
    return value == nullptr ? "" : value;
  };
  const fs::path cache = folder_in("XDG_CACHE_HOME");
  if (cache.is_absolute()) return cache / "aims" / "sequences";
  const fs::path home = folder_in("HOME");
  if (home.is_absolute()) return home / ".cache" / "aims" / "sequences";
  return fs::temp_directory_path() / "aims" / "sequences";
}

std::string SequenceCache::id_of(const Scenario& scenario, std::uint64_t seed) {
  return text_hash(fmt::format("{}\n{}\n{}", simulator_version(), seed,
                               simulation_text(scenario_of_seed(scenario, seed))));
}

bool SequenceCache::has(const std::string& id) const {
  std::error_code ignored;
  return fs::exists(file_of(id), ignored);
}

Result<SequenceMade> SequenceCache::make(const Scenario& scenario, std::uint64_t seed,
                                         const std::function<void(double)>& observer,
                                         int threads) const {
  const std::string id = id_of(scenario, seed);
  if (has(id)) return SequenceMade{};
  std::error_code code;
  fs::create_directories(folder_, code);
  if (code) return failure(fmt::format("{}: {}", folder_.string(), code.message()));
  const auto lock = FolderLock::wait(folder_, id + ".lock");
  if (!lock) {
    return failure(fmt::format("{}: cannot be locked: {}", file_of(id).string(),
                               std::system_category().message(errno)));
  }
  if (has(id)) return SequenceMade{};
  clear_remains(file_of(id));
  auto made = simulate(scenario_of_seed(scenario, seed), seed, file_of(id), observer, threads);
  fs::remove(folder_ / (id + ".lock"), code);
  return made;
}

std::optional<FolderLock> SequenceCache::use(const std::string& id) const {
  auto lock = FolderLock::share_file(file_of(id));
  // Another user's sequence keeps its time: it counts as used when it was made.
  std::error_code ignored;
  if (lock) fs::last_write_time(file_of(id), fs::file_time_type::clock::now(), ignored);
  return lock;
}

CachePruned SequenceCache::prune(std::uintmax_t limit, const std::set<std::string>& kept) const {
  const std::vector<CachedSequence> sequences = sequences_in(folder_);
  CachePruned pruned;
  for (const CachedSequence& sequence : sequences) pruned.left += sequence.bytes;
  for (const CachedSequence& sequence : sequences) {
    if (pruned.left <= limit) break;
    if (kept.contains(sequence.file.stem().string())) continue;
    const auto lock = FolderLock::take_file(sequence.file);
    std::error_code code;
    if (!lock || !fs::remove(sequence.file, code)) continue;
    ++pruned.sequences;
    pruned.bytes += sequence.bytes;
    pruned.left -= sequence.bytes;
  }
  return pruned;
}

}  // namespace aims
