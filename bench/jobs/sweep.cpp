// SPDX-License-Identifier: BSD-3-Clause
#include "bench/jobs/sweep.hpp"

#include <fmt/format.h>

#include <charconv>
#include <optional>
#include <set>
#include <system_error>
#include <utility>

#include "bench/jobs/sweep_folder.hpp"
#include "core/files/folder_lock.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// Locks of a folder: of all of it, or of one shard while others may have theirs.
struct Claim {
  FolderLock folder;
  std::optional<FolderLock> shard;
};

Result<void> make_folder(const fs::path& folder) {
  std::error_code code;
  fs::create_directories(folder, code);
  if (code) return failure(fmt::format("{}: {}", folder.string(), code.message()));
  return {};
}

/// A folder that is not there, has a plan, or holds nothing but what a claim leaves.
bool holds_sweep_or_nothing(const fs::path& out) {
  std::error_code ignored;
  if (!fs::exists(out, ignored) || fs::exists(out / "plan.yaml", ignored)) return true;
  if (!fs::is_directory(out, ignored)) return false;
  for (const auto& entry : fs::directory_iterator(out, ignored)) {
    const fs::path name = entry.path().filename();
    if (name != ".lock" && name != "shards" && name.extension() != ".tmp") return false;
  }
  return true;
}

Result<Claim> claim(const fs::path& out, const Shard& shard) {
  if (!holds_sweep_or_nothing(out)) {
    return failure(
        fmt::format("{}: exists and is no folder of aims sweep; give another --out", out.string()));
  }
  if (auto made = make_folder(out); !made) return tl::unexpected(made.error());
  const bool alone = shard.count == 1;
  auto folder = alone ? FolderLock::take(out) : FolderLock::share(out);
  if (!folder) {
    return failure(
        fmt::format("{}: in use by another aims sweep, or it cannot be written", out.string()));
  }
  Claim claim{std::move(*folder), std::nullopt};
  if (alone) return claim;
  const fs::path own = out / "shards" / fmt::format("{}-of-{}", shard.index, shard.count);
  if (auto made = make_folder(own); !made) return tl::unexpected(made.error());
  if (auto lock = FolderLock::take(own)) claim.shard.emplace(std::move(*lock));
  if (claim.shard) return claim;
  return failure(fmt::format("{}: another process works on shard {}/{}", out.string(), shard.index,
                             shard.count));
}

/// The sequences of jobs that other shards may still do.
std::set<std::string> shared_sequences(std::span<const Job> jobs, const Shard& shard) {
  std::set<std::string> sequences;
  if (shard.count == 1) return sequences;
  std::set<std::pair<const Scenario*, std::uint64_t>> known;
  for (const Job& job : jobs) {
    if (!known.emplace(job.scenario.get(), job.seed).second) continue;
    sequences.insert(SequenceCache::id_of(*job.scenario, job.seed));
  }
  return sequences;
}

}  // namespace

Result<Shard> parse_shard(std::string_view text) {
  Shard shard;
  const char* end = text.data() + text.size();
  const auto index = std::from_chars(text.data(), end, shard.index);
  bool right = index.ec == std::errc() && index.ptr != end && *index.ptr == '/';
  if (right) {
    const auto count = std::from_chars(index.ptr + 1, end, shard.count);
    right = count.ec == std::errc() && count.ptr == end;
  }
  if (right && shard.index >= 1 && shard.index <= shard.count) return shard;
  return failure(fmt::format("--shard: expected I/N with I from 1 to N, e.g. 2/8, got '{}'", text));
}

std::span<const Job> part_of(std::span<const Job> jobs, const Shard& shard) {
  const auto border = [&](int index) {
    return jobs.size() * static_cast<std::size_t>(index) / static_cast<std::size_t>(shard.count);
  };
  return jobs.subspan(border(shard.index - 1), border(shard.index) - border(shard.index - 1));
}

Result<JobRun> run_sweep(const std::string& plan, std::span<const Job> jobs,
                         const SweepOptions& options, const JobObserver& observer) {
  const auto claimed = claim(options.out, options.shard);
  if (!claimed) return tl::unexpected(claimed.error());
  const SweepFolder folder(options.out);
  if (auto entered = folder.enter(plan, jobs, options.renew); !entered) {
    return tl::unexpected(entered.error());
  }
  JobOptions job_options;
  job_options.folder = folder.jobs().path();
  if (!options.cache.empty()) job_options.cache = options.cache;
  job_options.cache_limit = options.cache_limit;
  job_options.kept_sequences = shared_sequences(jobs, options.shard);
  job_options.jobs = options.jobs;
  job_options.timeout_s = options.timeout_s;
  job_options.retry = options.retry;
  job_options.simulate_only = options.simulate_only;
  return JobRunner(std::move(job_options)).run(part_of(jobs, options.shard), observer);
}

}  // namespace aims
