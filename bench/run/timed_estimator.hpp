// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "estimator/estimator.hpp"

namespace aims {

/// An estimator and the wall time that it takes: estimators themselves never read a clock.
class TimedEstimator {
 public:
  TimedEstimator(std::string name, std::unique_ptr<Estimator> estimator);

  void consume(std::span<const Delivery> deliveries);
  void finish();

  const std::string& name() const { return name_; }
  const Estimator& estimator() const { return *estimator_; }
  double total_seconds() const { return total_seconds_; }
  /// Time from one scan to the next: the scan and all samples since the scan before [ms].
  const std::vector<double>& scan_times_ms() const { return scan_times_ms_; }

 private:
  template <class Work>
  void timed(const Work& work);

  std::string name_;
  std::unique_ptr<Estimator> estimator_;
  double total_seconds_ = 0.0;
  double seconds_since_scan_ = 0.0;
  std::vector<double> scan_times_ms_;
};

}  // namespace aims
