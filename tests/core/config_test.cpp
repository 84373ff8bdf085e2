// SPDX-License-Identifier: BSD-3-Clause
#include "core/config.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
// rapidcheck's gtest glue needs both headers above it.
#include <rapidcheck/gtest.h>

namespace aims {
namespace {

enum class Foot { kPoint, kRolling };

struct Item {
  double width = 1.0;
};

struct Nested {
  double alpha = 0.9;
  Foot foot = Foot::kPoint;
};

struct Sample {
  double eta = 3.0;
  int count = 2;
  bool on = false;
  std::string name = "x";
  std::vector<std::string> names = {"a"};
  std::vector<double> angles = {0.5};
  Eigen::Vector3d axis = Eigen::Vector3d::UnitX();
  Eigen::Vector2d corner = Eigen::Vector2d::Zero();
  Nested nested;
  std::vector<Item> items = std::vector<Item>(2);
};

/// Keys that begin alike, and one that is spelled alike.
struct Ranges {
  double range_min = 0.0;
  double range_max = 1.0;
  double rangs = 2.0;
};

void describe(Fields& f, Ranges& c) {
  f.number("range_min", c.range_min, {});
  f.number("range_max", c.range_max, {});
  f.number("rangs", c.rangs, {});
}

void describe(Fields& f, Item& c) { f.number("width", c.width, {.range = positive_up_to(10.0)}); }

void describe(Fields& f, Nested& c) {
  f.number("alpha", c.alpha, {.range = in_half_open(0.0, 1.0)});
  f.choice("foot", c.foot, {{"point", Foot::kPoint}, {"rolling", Foot::kRolling}}, {});
}

void describe(Fields& f, Sample& c) {
  f.number("eta", c.eta, {.unit = "-", .range = up_to(100.0), .source = "eq. (8)"});
  f.integer("count", c.count, {.range = in_range(1, 9)});
  f.flag("on", c.on, {});
  f.text("name", c.name, {});
  f.texts("names", c.names, {});
  f.numbers("angles", c.angles, {.range = within(90.0)});
  f.vector("axis", c.axis, {.range = in_range(-5.0, 5.0)});
  f.vector("corner", c.corner, {});
  f.group("nested", c.nested);
  f.list("items", c.items, "Things.");
}

/// Whether the sample takes the text for that key.
bool takes(const std::string& key, const std::string& text) {
  Sample sample;
  return assign(fields_of(sample), key, text).has_value();
}

std::string message_of(const std::string& key, const std::string& text) {
  Sample sample;
  return assign(fields_of(sample), key, text).error().message;
}

TEST(Range, BoundsAreIncludedOrNot) {
  EXPECT_TRUE(any().contains(-1e300));
  EXPECT_TRUE(up_to(2.0).contains(0.0));
  EXPECT_TRUE(up_to(2.0).contains(2.0));
  EXPECT_FALSE(positive_up_to(2.0).contains(0.0));
  EXPECT_TRUE(within(2.0).contains(-2.0));
  EXPECT_TRUE(in_range(0.0, 1.0).contains(1.0));
  EXPECT_FALSE(in_half_open(0.0, 1.0).contains(1.0));
  EXPECT_TRUE(in_half_open(0.0, 1.0).contains(0.0));
}

TEST(Range, TextIsReadable) {
  EXPECT_EQ(any().text(), "");
  EXPECT_EQ(up_to(1e6).text(), "in [0, 1e+06]");
  EXPECT_EQ(positive_up_to(2.0).text(), "in [1e-12, 2]");
  EXPECT_EQ((Range{.min = 0.0}).text(), ">= 0");
  EXPECT_EQ(in_range(0.0, 1.0).text(), "in [0, 1]");
  EXPECT_EQ(in_half_open(0.0, 0.5).text(), "in [0, 0.5)");
  EXPECT_EQ((Range{.max = 2.0}).text(), "<= 2");
}

TEST(Fields, HaveFullKeysInTheOrderOfDescription) {
  Sample sample;
  std::vector<std::string> keys;
  for (const Parameter& each : fields_of(sample).parameters()) keys.push_back(each.key);
  const std::vector<std::string> expected = {
      "eta",  "count",  "on",           "name",        "names",         "angles",
      "axis", "corner", "nested.alpha", "nested.foot", "items.0.width", "items.1.width"};
  EXPECT_EQ(keys, expected);
}

TEST(Fields, AssignmentReachesTheConfiguration) {
  Sample sample;
  const Fields fields = fields_of(sample);
  EXPECT_TRUE(assign(fields, "eta", " 1.5 "));
  EXPECT_TRUE(assign(fields, "count", "+7"));
  EXPECT_TRUE(assign(fields, "on", "true"));
  EXPECT_TRUE(assign(fields, "names", "[b, \"c, d\"]"));
  EXPECT_TRUE(assign(fields, "angles", "[1, -2.5]"));
  EXPECT_TRUE(assign(fields, "axis", "[1, 2, -3]"));
  EXPECT_TRUE(assign(fields, "nested.foot", "rolling"));
  EXPECT_TRUE(assign(fields, "items.1.width", "4"));
  EXPECT_EQ(sample.eta, 1.5);
  EXPECT_EQ(sample.count, 7);
  EXPECT_TRUE(sample.on);
  EXPECT_EQ(sample.names, (std::vector<std::string>{"b", "c, d"}));
  EXPECT_EQ(sample.angles, (std::vector<double>{1.0, -2.5}));
  EXPECT_EQ(sample.axis, Eigen::Vector3d(1.0, 2.0, -3.0));
  EXPECT_EQ(sample.nested.foot, Foot::kRolling);
  EXPECT_EQ(sample.items[1].width, 4.0);
}

TEST(Fields, RejectUnexpectedValues) {
  for (const char* text :
       {"", "x", "1x", "nan", "inf", "-inf", "1e999", "-1", "1,5", "+-1", "[1]"}) {
    EXPECT_FALSE(takes("eta", text)) << text;
  }
  for (const char* text : {"", "1.0", "0", "10", "1e1", "99999999999"}) {
    EXPECT_FALSE(takes("count", text)) << text;
  }
  for (const char* text : {"", "True", "yes", "1"}) EXPECT_FALSE(takes("on", text)) << text;
  for (const char* text :
       {"[1, 2]", "[1, 2, 3, 4]", "1, 2, 3", "[1, 2, 6]", "[1, 2, x]", "[1,,2]", "[1, 2, 3,]"}) {
    EXPECT_FALSE(takes("axis", text)) << text;
  }
  for (const char* text : {"", "Point", "wheel"}) EXPECT_FALSE(takes("nested.foot", text)) << text;
  for (const char* text : {"a", "[a", "[a,]", "[\"a]", "[\"a\" b]"}) {
    EXPECT_FALSE(takes("names", text)) << text;
  }
  for (const char* text : {"1", "[1, 91]", "[x]", "[1,]", "[nan]"}) {
    EXPECT_FALSE(takes("angles", text)) << text;
  }
  EXPECT_TRUE(takes("angles", "[]"));
}

TEST(Fields, ARejectedVectorIsUnchanged) {
  Sample sample;
  EXPECT_FALSE(assign(fields_of(sample), "axis", "[3, 4, 99]"));
  EXPECT_EQ(sample.axis, Eigen::Vector3d::UnitX());
}

TEST(Fields, ErrorsNameKeyAndWhatWasExpected) {
  EXPECT_EQ(message_of("eta", "-1"), "eta: '-1' is not a number in [0, 100]");
  EXPECT_EQ(message_of("count", "0"), "count: '0' is not an integer in [1, 9]");
  EXPECT_EQ(message_of("nested.foot", "x"), "nested.foot: 'x' is not one of point, rolling");
  EXPECT_EQ(message_of("nested.foot", "rollin"),
            "nested.foot: 'rollin' is not one of point, rolling; did you mean 'rolling'?");
  EXPECT_EQ(message_of("angles", "[99]"),
            "angles: '[99]' is not a list of numbers like [a, b], each in [-90, 90]");
  EXPECT_EQ(message_of("axis", "[1]"),
            "axis: '[1]' is not three numbers like [x, y, z] in [-5, 5]");
}

TEST(Fields, UnknownKeysComeWithTheNearestOne) {
  EXPECT_EQ(message_of("cuont", "1"), "unknown key 'cuont'; did you mean 'count'?");
  EXPECT_EQ(message_of("nested.alhpa", "1"),
            "unknown key 'nested.alhpa'; did you mean 'nested.alpha'?");
  EXPECT_EQ(message_of("alpha", "1"), "unknown key 'alpha'; did you mean 'nested.alpha'?");
  EXPECT_EQ(message_of("items.0.widht", "1"),
            "unknown key 'items.0.widht'; did you mean 'items.0.width'?");
  EXPECT_EQ(message_of("nothing_like_it", "1"), "unknown key 'nothing_like_it'");
  EXPECT_EQ(message_of("nested", "1"), "nested: a group of settings; expected one of its keys");
}

TEST(Fields, KeysThatBeginWithTheGivenNameAreProposedToo) {
  EXPECT_EQ(message_of("items.0.wid", "1"),
            "unknown key 'items.0.wid'; did you mean 'items.0.width'?");
  EXPECT_EQ(message_of("nested.al", "1"), "unknown key 'nested.al'; did you mean 'nested.alpha'?");
  Ranges ranges;
  const auto message = [&ranges](std::string_view key) {
    return assign(fields_of(ranges), key, "1").error().message;
  };
  EXPECT_EQ(message("range"),
            "unknown key 'range'; did you mean 'range_min', 'range_max' or 'rangs'?");
  EXPECT_EQ(message("r"), "unknown key 'r'");
}

TEST(Fields, AnEntryThatAListDoesNotHaveIsNamed) {
  EXPECT_EQ(message_of("items.7.width", "1"),
            "items.7.width: no entry 7; items has 2, counted from 0");
}

TEST(Fields, ListsResizeAndAreCollectedAgain) {
  Sample sample;
  fields_of(sample).lists()[0].resize(3);
  const Fields fields = fields_of(sample);
  EXPECT_EQ(fields.lists()[0].key, "items");
  EXPECT_EQ(fields.lists()[0].size(), 3U);
  EXPECT_NE(fields.find("items.2.width"), nullptr);
  EXPECT_EQ(fields.find("items.3.width"), nullptr);
}

TEST(Fields, TextOfEveryParameterIsTakenBack) {
  Sample sample;
  sample.eta = 0.1 + 0.2;
  sample.axis = {1.0 / 3.0, -2.0, 1e-17};
  for (const Parameter& each : fields_of(sample).parameters()) {
    const std::string before = each.text();
    EXPECT_TRUE(each.assign(before)) << each.key;
    EXPECT_EQ(each.text(), before);
    EXPECT_EQ(is_sequence(each), each.key == "names" || each.key == "angles" ||
                                     each.key == "axis" || each.key == "corner");
  }
  EXPECT_EQ(sample.eta, 0.1 + 0.2);
  EXPECT_EQ(sample.axis.x(), 1.0 / 3.0);
}

RC_GTEST_PROP(SequenceText, IsUndoneBySequenceEntries, ()) {
  const auto text = rc::gen::container<std::string>(
      rc::gen::oneOf(rc::gen::arbitrary<char>(), rc::gen::element('"', '\\', ',', ' ', '[', ']')));
  const auto entries = *rc::gen::container<std::vector<std::string>>(text);
  RC_ASSERT(sequence_entries(sequence_text(entries)) == entries);
}

TEST(NearMatch, FindsTyposOnly) {
  const std::vector<std::string> words = {"corridor", "garage", "eta"};
  EXPECT_EQ(near_match("coridor", words), "corridor");
  EXPECT_EQ(near_match("garbage", words), "garage");
  EXPECT_EQ(near_match("et", words), "eta");
  EXPECT_EQ(near_match("xy", words), "");
  EXPECT_EQ(near_match("warehouse", words), "");
  EXPECT_EQ(near_match("x", {}), "");
}

}  // namespace
}  // namespace aims
