// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "core/measurements.hpp"
#include "python/src/conversion.hpp"

namespace aims::python {

/// A measurement with its arrival, as Python sees it. A scan lives as long as anything refers to
/// it.
template <class Value>
struct Arrived {
  Time arrival = 0;
  Value value;
};
using ArrivedImu = Arrived<ImuSample>;
using ArrivedLegs = Arrived<LegOdometrySample>;
using ArrivedScan = Arrived<LidarScanPtr>;

/// The Python object of the delivery: ImuSample, LegSample or LidarScan.
inline py::object object_of(const Delivery& delivery) {
  return std::visit(
      [&](const auto& value) {
        return py::cast(Arrived<std::decay_t<decltype(value)>>{delivery.arrival, value});
      },
      delivery.measurement);
}

/// Deliveries, batch by batch, as a Python iterator.
class DeliveryBuffer {
 public:
  /// The next delivery; `advance(batch)` appends more, without the interpreter's lock, and returns
  /// whether there is still more to come. Raises StopIteration at the end.
  template <class Advance>
  py::object next(const Advance& advance) {
    while (position_ == batch_.size()) {
      if (!more_) throw py::stop_iteration();
      batch_.clear();
      position_ = 0;
      more_ = advance(batch_);
    }
    return object_of(batch_[position_++]);
  }

  /// Drops what was not handed out and ends.
  void end() {
    batch_.clear();
    position_ = 0;
    more_ = false;
  }
  bool at_end() const { return !more_ && position_ == batch_.size(); }

 private:
  std::vector<Delivery> batch_;
  std::size_t position_ = 0;
  bool more_ = true;
};

/// Declares the measurements, the rig of the sensors, and how to make them of arrays.
void bind_measurements(py::module_& module);
/// Declares `Estimator`.
void bind_estimator(py::module_& module);
/// Declares `RecordingStream`, `estimate`, `score` and `read_trajectory`.
void bind_recordings(py::module_& module);

/// A scan of NumPy arrays; errors name the argument.
LidarScanPtr scan_from(Time stamp, const py::object& xyz, const py::object& offsets,
                       const py::object& rings, const py::object& intensity, const py::object& end);

}  // namespace aims::python
