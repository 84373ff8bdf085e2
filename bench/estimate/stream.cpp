// SPDX-License-Identifier: BSD-3-Clause
#include "bench/estimate/stream.hpp"

#include <tbb/task_arena.h>
#include <tbb/task_group.h>

#include <utility>

#include "estimator/estimator_spec.hpp"
#include "estimator/registry.hpp"

namespace aims {

Result<std::vector<TimedEstimator>> make_estimators(std::span<const std::string> specs,
                                                    const EstimatorConfigs& configs,
                                                    const SensorRig& rig) {
  std::vector<TimedEstimator> estimators;
  for (const std::string& text : specs) {
    const auto spec = parse_estimator_spec(text);
    if (!spec) return tl::unexpected(spec.error());
    const auto own = config_with(*spec, configs);
    if (!own) return tl::unexpected(own.error());
    auto made = (*own)->create(rig);
    if (const auto& broken = made->result().failure) return tl::unexpected(*broken);
    estimators.emplace_back(spec->label, std::move(made));
  }
  return estimators;
}

StreamEnd stream(const NextBatch& next_batch, std::vector<TimedEstimator>& estimators, int jobs,
                 const std::function<bool()>& wanted) {
  tbb::task_arena arena(jobs);
  StreamEnd end;
  std::vector<Delivery> current;
  std::vector<Delivery> next;
  const auto more_of = [&](std::vector<Delivery>& batch) {
    const Result<bool> more = next_batch(batch);
    if (!more) end.error = more.error();
    return more && *more;
  };
  bool more = more_of(current);
  for (bool pending = true; pending && !end.stopped;) {
    pending = more;
    next.clear();
    arena.execute([&] {
      tbb::task_group tasks;
      for (TimedEstimator& each : estimators) tasks.run([&] { each.consume(current); });
      if (more) tasks.run([&] { more = more_of(next); });
      tasks.wait();
    });
    std::swap(current, next);
    end.stopped = !wanted();
  }
  arena.execute([&] {
    tbb::task_group tasks;
    for (TimedEstimator& each : estimators) tasks.run([&each] { each.finish(); });
    tasks.wait();
  });
  return end;
}

}  // namespace aims
