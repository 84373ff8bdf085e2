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
        fmt::format("{}: exists and is no sweep's folder; give another --out", out.string()));
  }
  if (auto made = make_folder(out); !made) return tl::unexpected(made.error());
  const bool alone = shard.count == 1;
  auto folder = alone ? FolderLock::take(out) : FolderLock::share(out);
  if (!folder) {
    return failure(
        fmt::format("{}: another sweep works there, or it cannot be written", out.string()));
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

/// The walks of units that other shards may still do.
std::set<std::string> shared_walks(std::span<const SweepUnit> units, const Shard& shard) {
  std::set<std::string> walks;
  if (shard.count == 1) return walks;
  std::set<std::pair<const Scenario*, std::uint64_t>> known;
  for (const SweepUnit& unit : units) {
    if (!known.emplace(unit.scenario.get(), unit.seed).second) continue;
    walks.insert(WalkCache::id_of(*unit.scenario, unit.seed));
  }
  return walks;
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

std::span<const SweepUnit> part_of(std::span<const SweepUnit> units, const Shard& shard) {
  const auto border = [&](int index) {
    return units.size() * static_cast<std::size_t>(index) / static_cast<std::size_t>(shard.count);
  };
  return units.subspan(border(shard.index - 1), border(shard.index) - border(shard.index - 1));
}

Result<UnitRun> run_sweep(const std::string& plan, std::span<const SweepUnit> units,
                          const SweepOptions& options, const UnitObserver& observer) {
  const auto claimed = claim(options.out, options.shard);
  if (!claimed) return tl::unexpected(claimed.error());
  const SweepFolder folder(options.out);
  if (auto entered = folder.enter(plan, units, options.renew); !entered) {
    return tl::unexpected(entered.error());
  }
  UnitOptions unit_options;
  unit_options.units = folder.units().path();
  if (!options.cache.empty()) unit_options.cache = options.cache;
  unit_options.cache_limit = options.cache_limit;
  unit_options.kept_walks = shared_walks(units, options.shard);
  unit_options.jobs = options.jobs;
  unit_options.timeout_s = options.timeout_s;
  unit_options.retry = options.retry;
  unit_options.walks_only = options.walks_only;
  return UnitRunner(std::move(unit_options)).run(part_of(units, options.shard), observer);
}

}  // namespace aims
