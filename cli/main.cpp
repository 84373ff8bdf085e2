// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <filesystem>

#include "bench/scenario/catalogue.hpp"
#include "cli/commands.hpp"

namespace {

using aims::CommandEntry;

constexpr std::array kCommands = {
    CommandEntry{"run", "Simulate a scenario, run estimators on it, score and draw",
                 aims::declare_run},
    CommandEntry{"suite", "Run many scenarios on many seeds and tabulate the scores",
                 aims::declare_suite},
    CommandEntry{"sweep", "Evaluate estimators over ranges of parameters", aims::declare_sweep},
    CommandEntry{"merge", "Collect the results of a sweep in one database and one table",
                 aims::declare_merge},
    CommandEntry{"tune", "Optimize the parameters of an estimator and validate them on other data",
                 aims::declare_tune},
    CommandEntry{"study", "Ablation, consistency, degeneracy detectors, comparison of results",
                 aims::declare_study},
    CommandEntry{"simulate", "Record the measurements of a scenario for ROS 1 or ROS 2",
                 aims::declare_simulate},
    CommandEntry{"estimate", "Run estimators on a recorded bag", aims::declare_estimate},
    CommandEntry{"benchmark", "Run estimators on a public data set, beside published scores",
                 aims::declare_benchmark},
    CommandEntry{"calibrate", "Learn from recordings what stays with a robot",
                 aims::declare_calibrate},
    CommandEntry{"score", "Score trajectories of any system against ground truth",
                 aims::declare_score},
    CommandEntry{"info", "Topics, rates, gaps, time offsets, noise and extrinsics of a bag",
                 aims::declare_info},
    CommandEntry{"check", "Which systems find all their inputs in a bag", aims::declare_check},
    CommandEntry{"convert", "Write a recording in another format or compression",
                 aims::declare_convert},
    CommandEntry{"render", "Draw a sequence: a still, a looped video, vector pictures",
                 aims::declare_render},
    CommandEntry{"page", "Write an HTML page that shows a folder of results", aims::declare_page},
    CommandEntry{"config", "Every parameter with value, unit, range, meaning and source",
                 aims::declare_config},
    CommandEntry{"list", "Scenarios, families of scenarios and estimators", aims::declare_list},
    CommandEntry{"completion", "Completion of commands, options and names by bash or zsh",
                 aims::declare_completion},
};

constexpr std::array kExternal = {
    aims::ExternalCommand{"live", "Estimate from the topics of a running robot (ROS 2)",
                          "aims-live"},
    aims::ExternalCommand{"play", "Publish a recording on the topics of ROS 2", "aims-live"},
    aims::ExternalCommand{"watch", "Show a live estimate in a browser", "aims-live"},
};

constexpr const char* kDescription =
    "aims: benchmark of legged-robot localization in degenerate corridors.\n"
    "A simulated quadruped walks through a scenario. Every estimator gets the same\n"
    "measurements, and its trajectory is scored against the ground truth.";

constexpr const char* kFooter =
    "Examples:\n"
    "  aims run corridor\n"
    "  aims run corridor --seeds 1-5 --estimators aims,lio --out out/compare\n"
    "  aims run corridor --set estimators.aims.degeneracy.eta=5 --out out/eta5\n"
    "  aims suite --tags stress --seeds 1-5 --out out/stress\n"
    "  aims sweep --param degeneracy.eta=0:6:13 --scenarios corridor --seeds 1-5\n"
    "  aims tune bench/tuning/plans/aims.yaml --out out/tune\n"
    "  aims study ablation severity_3 severity_8 --seeds 1-3\n"
    "  aims study consistency severity_9 --seeds 1-50 --estimators aims_d,lio\n"
    "  aims study compare out/before out/after\n"
    "  aims simulate corridor --out corridor.bag\n"
    "  aims estimate corridor.bag --estimators aims,lio\n"
    "  aims score --truth truth.tum --estimate mine.tum --segments a-b=12.5:110.2\n"
    "  aims page out/corridor-seed-1\n"
    "Exit codes: 0 success; 1 an expectation of a scenario failed, an estimator failed, or\n"
    "jobs are missing; 2 wrong usage, configuration or input; 3 internal error; 4 a run is\n"
    "invalid, e.g. the robot fell, and no expectation demands it; 130 interrupted (Ctrl-C),\n"
    "143 terminated (SIGTERM), 129 after a lost terminal (SIGHUP).";

}  // namespace

int main(int argc, char** argv) {
  const auto scenarios =
      aims::default_scenario_folder(std::filesystem::read_symlink("/proc/self/exe"));
  return aims::run_program(
      {"aims", kDescription, kFooter, "aims " AIMS_VERSION, kCommands, kExternal, scenarios}, argc,
      argv);
}
