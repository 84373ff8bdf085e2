// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include "bench/scoring/report.hpp"

namespace aims {
namespace {

struct Row {
  std::string name;
  std::size_t runs = 0;
  std::optional<double> ate;
};

const TableColumns<Row>& columns() {
  static const TableColumns<Row> columns = {
      {"name", "estimator", &Row::name},
      {"runs", "", &Row::runs},
      {"ate_m", "ATE [m]", &Row::ate, "{:.2f}"},
      {"", "twice", [](const Row& row) { return std::to_string(2 * row.runs); }}};
  return columns;
}

const std::vector<Row> kRows = {{"lio, old", 3, 0.125}, {"leg", 0, std::nullopt}};

TEST(Columns, GiveJsonCsvAndTableOfOneList) {
  EXPECT_EQ(rows_json(columns(), kRows).dump(),
            R"([{"name":"lio, old","runs":3,"ate_m":0.125},{"name":"leg","runs":0,"ate_m":null}])");
  EXPECT_EQ(rows_csv(columns(), kRows).text(), "name,runs,ate_m\n\"lio, old\",3,0.125\nleg,0,\n");
  const TextTable table = rows_table(columns(), kRows, "none");
  EXPECT_EQ(table.header, (std::vector<std::string>{"estimator", "ATE [m]", "twice"}));
  EXPECT_EQ(table.rows[0], (std::vector<std::string>{"lio, old", "0.12", "6"}));
  EXPECT_EQ(table.rows[1], (std::vector<std::string>{"leg", "none", "0"}));
}

TEST(Columns, StandBesideCellsOfTheirOwn) {
  CsvTable table(csv_header(columns(), {"scenario"}));
  table.add("corridor");
  add_cells(columns(), kRows[1], table);
  table.end_row();
  EXPECT_EQ(table.text(), "scenario,name,runs,ate_m\ncorridor,leg,0,\n");
}

TEST(Columns, AnIntervalHasBothEndsOrNone) {
  EXPECT_EQ(interval_text({0.5, 1.25}, "{:.1f}"), "[0.5, 1.2]");
  EXPECT_EQ(interval_text({}, "{:.1f}", "–"), "–");
}

}  // namespace
}  // namespace aims
