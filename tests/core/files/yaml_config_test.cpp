// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/yaml_config.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <rapidcheck.h>
// rapidcheck's gtest glue needs both headers above it.
#include <rapidcheck/gtest.h>

#include "core/files/atomic_file.hpp"
#include "tests/core/files/sample_config.hpp"
#include "tests/support/temporary_folder.hpp"

namespace aims {
namespace {

using namespace testing;

namespace fs = std::filesystem;

/// The message of loading that text, or "" when it loads.
std::string message_of(std::string_view text) {
  Sample config;
  const auto loaded = load_config_text(text, "s.yaml", config);
  return loaded ? "" : loaded.error().message;
}

fs::path write(const fs::path& file, std::string_view text) {
  EXPECT_TRUE(write_file_atomically(file, text));
  return file;
}

TEST(YamlConfig, ReadsEveryKindOfField) {
  Sample c;
  const auto loaded = load_config_text(R"(
name: "two words"
gravity: [1, 2.5, -3e2]
estimators: [aims, 'a, b']
inner: {eta: 0.5, count: 7, enabled: false, model: rolling}
points:
  - name: a
  - {name: b, position: [1, 2], tags: [x]}
)",
                                       "s.yaml", c);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(c.name, "two words");
  EXPECT_EQ(c.gravity, Eigen::Vector3d(1.0, 2.5, -300.0));
  EXPECT_EQ(c.estimators, (std::vector<std::string>{"aims", "a, b"}));
  EXPECT_EQ(c.inner.eta, 0.5);
  EXPECT_EQ(c.inner.count, 7);
  EXPECT_FALSE(c.inner.enabled);
  EXPECT_EQ(c.inner.model, Model::kRolling);
  ASSERT_EQ(c.points.size(), 2U);
  EXPECT_EQ(c.points[1].position, Eigen::Vector2d(1.0, 2.0));
  EXPECT_EQ(c.points[1].tags, std::vector<std::string>{"x"});
}

struct Matrix {
  std::vector<double> entries;
};

void describe(Fields& f, Matrix& c) {
  f.numbers("entries", c.entries, {.unit = "-", .range = within(9.0), .meaning = "Row by row."});
}

TEST(YamlConfig, RowsOfAMatrixAreItsNumbers) {
  const std::vector<double> entries = {1.0, 2.0, 3.0, 4.0};
  for (const char* text : {"entries: [1, 2, 3, 4]\n", "entries: [[1, 2], [3, 4]]\n",
                           "entries:\n  - [1, 2]\n  - [3, 4]\n"}) {
    Matrix matrix;
    ASSERT_TRUE(load_config_text(text, "s.yaml", matrix)) << text;
    EXPECT_EQ(matrix.entries, entries);
  }
  Matrix matrix;
  EXPECT_FALSE(load_config_text("entries: [[[1, 2]], [3, 4]]\n", "s.yaml", matrix));
}

TEST(YamlConfig, WhatIsNotNamedKeepsItsValue) {
  Sample c;
  c.inner.count = 2;
  ASSERT_TRUE(load_config_text("inner: {eta: 1}", "s.yaml", c));
  EXPECT_EQ(c.inner.count, 2);
  EXPECT_EQ(c.name, "corridor");
}

TEST(YamlConfig, ErrorsNamePlaceKeyAndWhatWasExpected) {
  EXPECT_EQ(message_of("inner:\n  etta: 1\n"),
            "s.yaml:2:3: unknown key 'inner.etta'; did you mean 'inner.eta'?");
  EXPECT_EQ(message_of("iner:\n  eta: 1\n"),
            "s.yaml:1:1: unknown key 'iner'; did you mean 'inner'?");
  EXPECT_EQ(message_of("eta: 1\n"), "s.yaml:1:1: unknown key 'eta'; did you mean 'inner.eta'?");
  EXPECT_EQ(message_of("quite_unlike: 1\n"), "s.yaml:1:1: unknown key 'quite_unlike'");
  EXPECT_EQ(message_of("inner:\n  eta: fast\n"),
            "s.yaml:2:8: inner.eta: expected a number in [0, 100], found 'fast'");
  EXPECT_EQ(message_of("inner:\n  eta: -1\n"),
            "s.yaml:2:8: inner.eta: expected a number in [0, 100], found '-1'");
  EXPECT_EQ(message_of("inner: {count: 2.5}\n"),
            "s.yaml:1:16: inner.count: expected an integer in [1, 9], found '2.5'");
  EXPECT_EQ(message_of("inner: {enabled: yes}\n"),
            "s.yaml:1:18: inner.enabled: expected true or false, found 'yes'");
  EXPECT_EQ(message_of("inner: {model: wheel}\n"),
            "s.yaml:1:16: inner.model: expected one of point, rolling, found 'wheel'");
  EXPECT_EQ(message_of("inner:\n  eta: 1\n  eta: 2\n"),
            "s.yaml:3:3: inner.eta: duplicate key; expected each key once");
  EXPECT_EQ(message_of("name: a\nname: b\n"),
            "s.yaml:2:1: name: duplicate key; expected each key once");
}

TEST(YamlConfig, RefusesTheWrongShape) {
  EXPECT_EQ(message_of("inner: [1]\n"), "s.yaml:1:8: inner: expected a map, found a list");
  EXPECT_EQ(message_of("inner: 3\n"), "s.yaml:1:8: inner: expected a map, found '3'");
  EXPECT_EQ(message_of("inner:\n"), "s.yaml:1:1: inner: expected a map, found nothing");
  EXPECT_EQ(message_of("inner: {eta: {a: 1}}\n"),
            "s.yaml:1:14: inner.eta: expected a number in [0, 100], found a map");
  EXPECT_EQ(message_of("inner: {eta: [1]}\n"),
            "s.yaml:1:14: inner.eta: expected a number in [0, 100], found [1]");
  EXPECT_EQ(message_of("inner: {eta: }\n"),
            "s.yaml:1:9: inner.eta: expected a number in [0, 100], found nothing");
  EXPECT_EQ(message_of("name: [a]\n"), "s.yaml:1:7: name: expected a text, found [a]");
  EXPECT_EQ(message_of("gravity: [1, 2]\n"),
            "s.yaml:1:10: gravity: expected three numbers like [x, y, z], found [1, 2]");
  EXPECT_EQ(message_of("gravity: '[1, 2, 3]'\n"),
            "s.yaml:1:10: gravity: expected three numbers like [x, y, z], found '[1, 2, 3]'");
  EXPECT_EQ(message_of("points: {a: 1}\n"),
            "s.yaml:1:9: points: expected a list of maps, found a map");
  EXPECT_EQ(message_of("points: [a]\n"),
            "s.yaml:1:10: points.0: expected a map or a list [name, position, tags], found 'a'");
  EXPECT_EQ(
      message_of("points: [[a, [1, 2]]]\n"),
      "s.yaml:1:10: points.0: expected a map or a list [name, position, tags], found 2 values");
  EXPECT_EQ(message_of("points: [[a, 1, [x]]]\n"),
            "s.yaml:1:14: points.0.position: expected two numbers like [x, y], found '1'");
  EXPECT_EQ(message_of("points:\n  - nam: a\n"),
            "s.yaml:2:5: unknown key 'points.0.nam'; did you mean 'points.0.name'?");
  EXPECT_EQ(message_of("inner.eta: 1\n"),
            "s.yaml:1:1: inner.eta: expected nested maps, not a dotted key");
  EXPECT_EQ(message_of("[1]\n"), "s.yaml:1:1: expected a map of settings, found a list");
  EXPECT_EQ(message_of("{[a]: 1}\n"),
            "s.yaml:1:2: top level: expected a name as key, found a list");
}

TEST(YamlConfig, RefusesWhatIsNotOneDocument) {
  EXPECT_EQ(message_of(""), "s.yaml: expected a map of settings, the file is empty");
  EXPECT_EQ(message_of("# nothing\n"), "s.yaml: expected a map of settings, the file is empty");
  EXPECT_EQ(message_of("name: a\n---\nname: b\n"),
            "s.yaml:2:1: expected one YAML document, found another");
  EXPECT_EQ(message_of(","), "s.yaml:1:1: expected one YAML document, found another");
  EXPECT_NE(message_of(std::string("\0{}", 3)), "");
  EXPECT_NE(message_of(std::string("name: a\0", 8)), "");
  EXPECT_TRUE(message_of("inner: {eta: 1\n").starts_with("s.yaml:2:1: not valid YAML: "));
  EXPECT_TRUE(message_of("a: b: c\n").starts_with("s.yaml:1:5: not valid YAML: "));
  EXPECT_NE(message_of("inner: &x {inner: *x}\n"), "");
  EXPECT_NE(message_of(std::string(5000, '[')), "");
}

TEST(YamlConfig, ATabThatIndentsIsCalledATab) {
  const std::string tab = ": a tab; YAML indents by spaces";
  EXPECT_EQ(message_of("inner:\n\teta: 1\n"), "s.yaml:2:1" + tab);
  EXPECT_EQ(message_of("inner:\n\teta: 1\n\tcount: 2\n"), "s.yaml:2:1" + tab);
  EXPECT_EQ(message_of("inner:\n  eta: 1\n  \tcount: 2\n"), "s.yaml:3:3" + tab);
  EXPECT_EQ(message_of("points:\n\t- name: a\n"), "s.yaml:2:1" + tab);
  EXPECT_EQ(message_of("name:\ta\n"), "") << "a tab between key and value is YAML";
  EXPECT_EQ(message_of("inner: {\n\teta: 1}\n"), "") << "and so is one inside braces";
  EXPECT_EQ(message_of("name: a\n\t\nname: b\n"), "s.yaml:2:1" + tab);
  EXPECT_TRUE(message_of("inner: {\n\teta: 1}\n\na: b: c\n").starts_with("s.yaml:4:5: not valid"))
      << "a tab elsewhere is not the cause";
}

TEST(YamlConfig, AnEntryOfAListMayBeItsValuesInOrder) {
  Sample c;
  const auto loaded = load_config_text("points: [[a, [1, 2], [x]], {name: b}]\n", "s.yaml", c);
  ASSERT_TRUE(loaded) << loaded.error().message;
  ASSERT_EQ(c.points.size(), 2U);
  EXPECT_EQ(c.points[0].name, "a");
  EXPECT_EQ(c.points[0].position, Eigen::Vector2d(1.0, 2.0));
  EXPECT_EQ(c.points[0].tags, std::vector<std::string>{"x"});
  EXPECT_EQ(c.points[1].name, "b");
}

TEST(YamlConfig, ABaseMayBeABareName) {
  const TemporaryFolder directory;
  const fs::path shipped = directory.path() / "shipped";
  fs::create_directories(shipped / "deep");
  fs::create_directories(directory.path() / "own");
  write(shipped / "deep" / "plain.yaml", "inner: {eta: 7}\n");
  write(shipped / "deep" / "beside.yaml", "inner: {eta: 8}\n");
  write(directory.path() / "own" / "beside.yaml", "inner: {eta: 9}\n");
  const auto eta_of = [&](const char* name, const char* text) {
    Sample c;
    const auto file = write(directory.path() / "own" / name, text);
    const auto loaded = load_config(file, c, nullptr, YamlFiles(shipped));
    EXPECT_TRUE(loaded) << loaded.error().message;
    return c.inner.eta;
  };
  EXPECT_EQ(eta_of("child.yaml", "base: plain\n"), 7.0);
  EXPECT_EQ(eta_of("child.yaml", "base: beside\n"), 9.0) << "a file beside comes first";
  EXPECT_EQ(eta_of("plain.yaml", "base: plain\n"), 7.0) << "not the file itself";
  Sample c;
  const auto child = write(directory.path() / "own" / "child.yaml", "base: plan\n");
  EXPECT_EQ(
      load_config(child, c, nullptr, YamlFiles(shipped)).error().message,
      fmt::format("{0}/child.yaml:1:7: base: no such file '{0}/plan', and no plan.yaml in {1}",
                  (directory.path() / "own").string(), shipped.string()));
  write(shipped / "plain.yaml", "inner: {eta: 7}\n");
  write(child, "base: plain\n");
  EXPECT_FALSE(eta_of("beside.yaml", "name: x\n") == 9.0);
  fs::remove(directory.path() / "own" / "plain.yaml");
  EXPECT_NE(load_config(child, c, nullptr, YamlFiles(shipped))
                .error()
                .message.find("expected the path of one"),
            std::string::npos);
}

TEST(YamlConfig, RefusesWhatWouldCostTheParserItsMemory) {
  EXPECT_EQ(message_of("name: a\nx: " + std::string(3'000'000, '[')),
            "s.yaml: expected at most 524288 bytes, found 3000011");
  EXPECT_EQ(message_of("name: a\nx: " + std::string(500'000, '[')),
            "s.yaml:2: expected no deeper nesting than 100");
  std::string lists;
  for (int i = 0; i < 100'000; ++i) lists += "- ";
  EXPECT_EQ(message_of("x:\n" + lists), "s.yaml:2: expected no deeper nesting than 100");
  EXPECT_EQ(message_of("# " + std::string(200'000, '-') + "\nname: a\n"), "") << "a ruler";
  EXPECT_EQ(message_of("name: '" + std::string(500, '[') + "'\n"), "") << "a text";
}

TEST(YamlConfig, EchoesAtMostTheStartOfALongValue) {
  EXPECT_EQ(message_of("inner: {eta: " + std::string(100'000, 'a') + "}\n"),
            "s.yaml:1:14: inner.eta: expected a number in [0, 100], found '" +
                std::string(79, 'a') + "... (100002 bytes)");
}

TEST(YamlConfig, MissingFileIsNamed) {
  Sample c;
  const auto loaded = load_config("/nonexistent/s.yaml", c);
  ASSERT_FALSE(loaded);
  EXPECT_TRUE(loaded.error().message.starts_with("/nonexistent/s.yaml: "))
      << loaded.error().message;
}

TEST(YamlConfig, BaseIsReadFirstAndItsListsReplaced) {
  const TemporaryFolder directory;
  write(directory.path() / "base.yaml",
        "name: base\ninner: {eta: 7, count: 8}\npoints: [{}, {}, {name: c}]\n");
  const auto child =
      write(directory.path() / "child.yaml", "inner: {count: 2}\nbase: base.yaml\npoints: [{}]\n");
  Sample c;
  const auto loaded = load_config(child, c);
  ASSERT_TRUE(loaded) << loaded.error().message;
  EXPECT_EQ(c.name, "base");
  EXPECT_EQ(c.inner.eta, 7.0);
  EXPECT_EQ(c.inner.count, 2);
  ASSERT_EQ(c.points.size(), 1U);
  EXPECT_EQ(c.points[0].name, "p");
}

TEST(YamlConfig, ErrorsOfABaseNameTheFileTheyAreIn) {
  const TemporaryFolder directory;
  const auto base = write(directory.path() / "base.yaml", "inner: {eta: -7}\n");
  const auto child = write(directory.path() / "child.yaml", "base: base.yaml\n");
  Sample c;
  EXPECT_EQ(load_config(child, c).error().message,
            base.string() + ":1:14: inner.eta: expected a number in [0, 100], found '-7'");
  const auto orphan = write(directory.path() / "orphan.yaml", "base: gone.yaml\n");
  EXPECT_EQ(load_config(orphan, c).error().message, orphan.string() + ":1:7: base: no such file '" +
                                                        (directory.path() / "gone.yaml").string() +
                                                        "'");
}

TEST(YamlConfig, ATextOpensNoFile) {
  EXPECT_EQ(message_of("base: /dev/zero\n"),
            "s.yaml:1:7: base: expected none; only a file may name another");
  TemporaryFolder directory;
  Sample c;
  const auto child = write(directory.path() / "child.yaml", "base: /dev/zero\n");
  EXPECT_EQ(load_config(child, c).error().message,
            child.string() + ":1:7: base: no such file '/dev/zero'");
}

TEST(YamlConfig, FilesBasedOnThemselvesAreRefused) {
  const TemporaryFolder directory;
  const auto a = write(directory.path() / "a.yaml", "base: b.yaml\n");
  write(directory.path() / "b.yaml", "base: ./a.yaml\n");
  Sample c;
  const auto loaded = load_config(a, c);
  ASSERT_FALSE(loaded);
  EXPECT_NE(loaded.error().message.find("based on itself"), std::string::npos);
  EXPECT_NE(loaded.error().message.find("b.yaml:1:7"), std::string::npos);
}

RC_GTEST_PROP(YamlConfig, AnyTextLoadsOrFailsWithOneLine, ()) {
  std::string text =
      "name: 'two words'\ngravity: [1, 2.5, -3e2]\nestimators: [aims, \"b\"]\n"
      "inner: {eta: 0.5, count: 7}\npoints:\n  - &x name: a\n  - {tags: [x], name: *x}\n";
  const auto mutations = *rc::gen::inRange(0, 6);
  for (int i = 0; i < mutations; ++i) {
    const auto at = *rc::gen::inRange<std::size_t>(0, text.size());
    const auto length = *rc::gen::inRange<std::size_t>(0, 4);
    const auto insert = *rc::gen::container<std::string>(
        rc::gen::oneOf(rc::gen::element(':', '-', '[', ']', '{', '}', '&', '*', '!', '|', '>', '%',
                                        '\n', ' ', '\t', '"', '#', '?', '<', '@', '`'),
                       rc::gen::arbitrary<char>()));
    text.replace(at, length, insert.substr(0, 3));
  }
  Sample c;
  const auto loaded = load_config_text(text, "s.yaml", c);
  if (!loaded) {
    RC_ASSERT(loaded.error().message.starts_with("s.yaml"));
    RC_ASSERT(loaded.error().message.find('\n') == std::string::npos);
  }
}

}  // namespace
}  // namespace aims
