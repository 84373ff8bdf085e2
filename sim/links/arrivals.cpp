// SPDX-License-Identifier: BSD-3-Clause
#include "sim/links/arrivals.hpp"

#include <utility>

namespace aims {

void Arrivals::add(Delivery delivery) {
  static_assert(std::is_same_v<std::variant_alternative_t<0, Measurement>, ImuSample>);
  const Order order{delivery.arrival, delivery.measurement.index(), sent_++};
  pending_.emplace(order, std::move(delivery));
}

void Arrivals::take(Time now, std::vector<Delivery>& out) {
  while (!pending_.empty() && pending_.begin()->second.arrival <= now) {
    out.push_back(std::move(pending_.begin()->second));
    pending_.erase(pending_.begin());
  }
}

}  // namespace aims
