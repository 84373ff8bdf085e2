// SPDX-License-Identifier: BSD-3-Clause
#include "lab/order/order_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "render/plots/field_plot.hpp"

namespace aims {
namespace {

/// Whether positive values span more than a factor of ten.
bool spans_decades(const std::vector<OrderMap::Cell>& cells, double OrderMap::Cell::*place) {
  const auto [low, high] = std::ranges::minmax(cells, {}, place);
  return low.*place > 0.0 && high.*place > 10.0 * (low.*place);
}

}  // namespace

Result<void> draw_order(const OrderStudy& study, const std::filesystem::path& folder) {
  if (!study.map) return {};
  FieldPlot plot;
  plot.title = fmt::format("Fraction of units in which {} is better than {}, by {}",
                           study.options.adaptive, study.options.fixed, study.options.score);
  plot.subtitle = summary_text(study);
  plot.x_label = study.map->x;
  plot.y_label = study.map->y;
  plot.logarithmic_x = spans_decades(study.map->cells, &OrderMap::Cell::x);
  plot.logarithmic_y = spans_decades(study.map->cells, &OrderMap::Cell::y);
  plot.value_label = "fraction [-], tau [-]";
  FieldPanel better{"adaptive weights are better", {}};
  FieldPanel agreement{"agreement with the paper's order (Kendall's tau)", {}};
  for (const OrderMap::Cell& cell : study.map->cells) {
    std::optional<double> fraction;
    if (cell.bin) {
      fraction = static_cast<double>(cell.bin->better) / static_cast<double>(cell.bin->units);
    }
    better.cells.push_back({cell.x, cell.y, fraction});
    agreement.cells.push_back({cell.x, cell.y, cell.bin ? cell.bin->tau : std::nullopt});
  }
  plot.panels = {better, agreement};
  return write_field_plot(folder / "order.png", plot);
}

}  // namespace aims
