// SPDX-License-Identifier: BSD-3-Clause
#include "bench/tuning/design.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>
#include <string>
#include <vector>

#include "bench/tuning/range_key.hpp"

namespace aims {
namespace {

using Points = std::vector<std::vector<double>>;

constexpr DesignKind kDrawn[] = {DesignKind::kRandom, DesignKind::kSobol,
                                 DesignKind::kLatinHypercube};

ParameterRange range_of(const std::string& text) {
  const auto range = parse_range(text);
  EXPECT_TRUE(range) << range.error().message;
  return range.value_or(ParameterRange{});
}

std::vector<ParameterRange> ranges_of(const std::vector<std::string>& texts) {
  std::vector<ParameterRange> ranges;
  for (const std::string& text : texts) ranges.push_back(range_of(text));
  return ranges;
}

std::string refusal_of(const std::string& text) {
  const auto range = parse_range(text);
  return range ? "accepted" : range.error().message;
}

bool says(const std::string& message, const std::string& part) {
  return message.find(part) != std::string::npos;
}

std::string check(const std::vector<std::string>& texts) {
  const auto ranges = parse_ranges(texts, {});
  if (!ranges) return ranges.error().message;
  const std::vector<EstimatorSpec> aims = {*parse_estimator_spec("aims")};
  const auto checked = check_ranges(*ranges, {}, aims);
  return checked ? "" : checked.error().message;
}

/// How many points lie in each of `cells` equal parts of coordinate i.
std::vector<int> counts_of(const Points& points, const ParameterRange& range, std::size_t i,
                           int cells) {
  std::vector<int> counts(static_cast<std::size_t>(cells));
  for (const auto& point : points) {
    const int cell = static_cast<int>(std::floor(fraction_of(range, point[i]) * cells));
    ++counts[static_cast<std::size_t>(std::clamp(cell, 0, cells - 1))];
  }
  return counts;
}

TEST(ParameterRange, IsReadInBothForms) {
  EXPECT_EQ(range_of("degeneracy.eta=0:6:13"),
            (ParameterRange{"degeneracy.eta", 0.0, 6.0, 13, false}));
  EXPECT_EQ(range_of("degeneracy.kappa=log(1, 100, 9)"),
            (ParameterRange{"degeneracy.kappa", 1.0, 100.0, 9, true}));
  EXPECT_EQ(range_of("degeneracy.eta = 0:6").count, 0);
  EXPECT_EQ(range_of("degeneracy.eta=3:3:1").low, 3.0);
}

TEST(ParameterRange, IsWrittenAsItIsRead) {
  for (const char* text : {"degeneracy.eta=0:6:13", "degeneracy.kappa=log(0.1,100,9)",
                           "degeneracy.alpha=0.5:0.99", "degeneracy.sigma_0=log(0.001,0.1)"}) {
    EXPECT_EQ(text_of(range_of(text)), text);
  }
}

TEST(ParameterRange, RefusalSaysWhatIsWrongAndWhere) {
  EXPECT_TRUE(says(refusal_of("degeneracy.eta=6:0:13"), "reversed"));
  EXPECT_TRUE(says(refusal_of("degeneracy.eta=2:2:5"), "empty"));
  EXPECT_TRUE(says(refusal_of("degeneracy.eta=2:2"), "empty"));
  EXPECT_TRUE(says(refusal_of("degeneracy.eta=0:6:0"), "at least 1"));
  EXPECT_TRUE(says(refusal_of("degeneracy.eta=0:6:-2"), "at least 1"));
  EXPECT_TRUE(says(refusal_of("degeneracy.eta=0:6:1"), "at least 2"));
  EXPECT_TRUE(says(refusal_of("degeneracy.kappa=log(0,100,9)"), "above 0"));
  EXPECT_TRUE(says(refusal_of("degeneracy.kappa=log(-1,100,9)"), "above 0"));
  EXPECT_TRUE(says(refusal_of("degeneracy.eta=nan:6:13"), "finite"));
  EXPECT_TRUE(says(refusal_of("degeneracy.eta=0:inf:13"), "finite"));
  for (const char* text :
       {"", "=", "degeneracy.eta", "degeneracy.eta=", "=0:6:13", "a=0:6:1:2", "a=0", "a=0:x:3",
        "a=0:6:2.5", "a=log(1,2,3", "a=log(1:2:3)", "a=1,2,3", "a=0:6:99999999999"}) {
    EXPECT_TRUE(says(refusal_of(text), "expected KEY=")) << text << ": " << refusal_of(text);
    EXPECT_TRUE(says(refusal_of(text), std::string("'") + text + "'")) << text;
  }
}

TEST(ParameterRange, IsHeldAgainstTheConfiguration) {
  EXPECT_EQ(check({"degeneracy.eta=0:6:13", "degeneracy.kappa=log(1,100,9)"}), "");
  EXPECT_TRUE(says(check({"degeneracy.ete=0:6:13"}), "did you mean 'degeneracy.eta'"));
  EXPECT_TRUE(says(check({"degeneracy.alpha=0:2:3"}), "[0, 1)"));
  EXPECT_TRUE(says(check({"degeneracy.prior_residuals=0:1:2"}), "only numbers"));
  EXPECT_TRUE(says(check({"legs.velocity_sigma=0:1:2"}), "only numbers"));
  EXPECT_TRUE(says(check({"degeneracy.eta=0:6:13", "degeneracy.eta=0:1:2"}), "second"));
}

TEST(Design, GridHoldsEveryCombinationAndItsEnds) {
  const auto ranges = ranges_of({"a=0:6:3", "b=log(1,100,3)", "c=5:5:1"});
  const Points expected = {{0, 1, 5},   {0, 10, 5}, {0, 100, 5}, {3, 1, 5},  {3, 10, 5},
                           {3, 100, 5}, {6, 1, 5},  {6, 10, 5},  {6, 100, 5}};
  EXPECT_EQ(design(DesignKind::kGrid, ranges, 0, 1), expected);
}

TEST(Design, GridValuesCarryNoNoiseOfRounding) {
  const Points points = design(DesignKind::kGrid, ranges_of({"a=0:1:11"}), 0, 1);
  EXPECT_EQ(points[3][0], 0.3);
  EXPECT_EQ(points[7][0], 0.7);
}

TEST(Design, ThatCannotBeMadeIsRefused) {
  const auto size = [](DesignKind kind, const std::vector<std::string>& texts, int samples) {
    return design_size(kind, ranges_of(texts), samples);
  };
  EXPECT_EQ(size(DesignKind::kGrid, {"a=0:6:13", "b=0:1:9"}, 0).value(), 117U);
  EXPECT_EQ(size(DesignKind::kSobol, {"a=0:6", "b=0:1"}, 64).value(), 64U);
  EXPECT_TRUE(says(size(DesignKind::kGrid, {}, 0).error().message, "no range"));
  EXPECT_TRUE(says(size(DesignKind::kGrid, {"a=0:6"}, 0).error().message, "needs a count"));
  EXPECT_TRUE(says(size(DesignKind::kSobol, {"a=0:6"}, 0).error().message, "at least 1"));
  EXPECT_TRUE(says(size(DesignKind::kGrid, {"a=0:6:9999999", "b=0:6:9999999", "c=0:1:9999999"}, 0)
                       .error()
                       .message,
                   "more than"));
}

TEST(Design, PointsStayInTheirRanges) {
  const auto ranges = ranges_of({"a=-2:6", "b=log(0.001,100)", "c=5:5:1"});
  for (const DesignKind kind : kDrawn) {
    for (const auto& point : design(kind, ranges, 200, 3)) {
      for (std::size_t i = 0; i < ranges.size(); ++i) {
        EXPECT_GE(point[i], ranges[i].low);
        EXPECT_LE(point[i], ranges[i].high);
      }
    }
  }
}

TEST(Design, SameSeedGivesTheSamePointsAndAnotherSeedOthers) {
  const auto ranges = ranges_of({"a=0:6", "b=log(1,100)"});
  for (const DesignKind kind : kDrawn) {
    EXPECT_EQ(design(kind, ranges, 32, 7), design(kind, ranges, 32, 7));
    EXPECT_NE(design(kind, ranges, 32, 7), design(kind, ranges, 32, 8));
  }
}

TEST(Design, MorePointsKeepThoseThereAre) {
  const auto ranges = ranges_of({"a=0:6", "b=log(1,100)"});
  for (const DesignKind kind : {DesignKind::kRandom, DesignKind::kSobol}) {
    Points more = design(kind, ranges, 64, 7);
    more.resize(40);
    EXPECT_EQ(more, design(kind, ranges, 40, 7));
  }
}

TEST(Design, LatinHypercubeHasOnePointInEachStratum) {
  const auto ranges = ranges_of({"a=0:6", "b=log(1,100)", "c=-1:1"});
  const Points points = design(DesignKind::kLatinHypercube, ranges, 37, 5);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    EXPECT_EQ(counts_of(points, ranges[i], i, 37), std::vector<int>(37, 1));
  }
}

TEST(Design, SobolFillsEveryStratumOfEachAxisAndOfPlanes) {
  const auto ranges = ranges_of({"a=0:1", "b=0:1", "c=log(1,100)", "d=0:1"});
  const Points points = design(DesignKind::kSobol, ranges, 64, 5);
  for (std::size_t i = 0; i < ranges.size(); ++i) {
    EXPECT_EQ(counts_of(points, ranges[i], i, 64), std::vector<int>(64, 1)) << i;
  }
  std::set<std::pair<int, int>> squares;  // the first two axes make a (0, 6, 2)-net in base 2
  for (const auto& point : points) squares.insert({int(point[0] * 8), int(point[1] * 8)});
  EXPECT_EQ(squares.size(), 64U);
}

TEST(Design, PointBecomesSettingsOfTheEstimator) {
  const auto base = parse_estimator_spec("x=aims+degeneracy.eta=1+degeneracy.alpha=0.5");
  ASSERT_TRUE(base);
  const auto ranges = ranges_of({"degeneracy.eta=0:6", "lidar.max_iterations=1:8"});
  const EstimatorSpec spec = spec_at(*base, ranges, std::vector<double>{2.25, 3.7});
  EXPECT_EQ(text_of(spec),
            "x=aims+degeneracy.alpha=0.5+degeneracy.eta=2.25+lidar.max_iterations=4");
  EXPECT_TRUE(parse_estimator_spec(text_of(spec)));
}

}  // namespace
}  // namespace aims
