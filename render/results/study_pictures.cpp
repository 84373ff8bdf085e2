// SPDX-License-Identifier: BSD-3-Clause
#include "render/results/study_pictures.hpp"

#include "bench/studies/written_runs.hpp"
#include "render/results/run_pictures.hpp"

namespace aims {

Result<void> draw_paper(const std::vector<PaperExperiment>& experiments,
                        const std::filesystem::path& folder, const DrawObserver& observer) {
  for (const PaperExperiment& each : experiments) {
    if (each.seeds.empty()) continue;
    auto drawn = draw_systems(suite_run_folder(folder, each.scenario, each.seeds.front()),
                              {"loam", "fast_lio2", "lego_loam", "aims"}, folder, observer);
    if (!drawn) return drawn;
  }
  return {};
}

}  // namespace aims
