// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <filesystem>
#include <string>

namespace aims::testing {

/// What a made-up run's folder is to hold.
struct WrittenRun {
  std::string name = "made_up";
  int scans = 50;
  int map_points = 500;  ///< of each estimator
  double start_s = 0.0;  ///< of the clock
  int noisy = 0;         ///< more estimators: "noisy_0", ... with noise in every series
};

/// Estimators of a made-up run: "exact" walks along +x with the truth, "ahead" 10 % too far.
inline constexpr const char* kMadeUpEstimators[] = {"exact", "ahead"};
/// Distance [m] that the robot truly walks between two scans, along the world's x axis from (1,
/// 0.2).
inline constexpr double kStep = 0.05;

/// Writes a folder as `aims run` does, of a robot that walks straight along a corridor, with the
/// given estimators.
void write_run(const std::filesystem::path& folder, const WrittenRun& run);

/// A scans.csv of as many scans and returns as `aims run` keeps, each return at random in the
/// corridor.
std::string noisy_scans();

/// Puts `text` into a file.
void put(const std::filesystem::path& file, const std::string& text);

/// The content of a file.
std::string content(const std::filesystem::path& file);

}  // namespace aims::testing
