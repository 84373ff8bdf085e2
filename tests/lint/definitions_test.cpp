// SPDX-License-Identifier: BSD-3-Clause
// One name, one definition: two classes of one name in one namespace are undefined behaviour once
// both are linked into a program, and no compiler has to say so.
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <regex>
#include <string>
#include <vector>

#include "tests/lint/documents.hpp"

namespace aims::lint {
namespace {

namespace fs = std::filesystem;

using Places = std::map<std::string, std::vector<std::string>>;  // by qualified name

const std::regex kNamespace(R"(^namespace ([\w:]+) \{)");
const std::regex kEndOfNamespace(R"(^\}  // namespace)");
const std::regex kType(
    R"(^(?:class|struct|enum class) (?:alignas\(\w+\) )?(\w+)( final)?( : [^;]*)?( \{.*)?$)");
const std::regex kConstant(R"(^inline constexpr [\w:<>, ]+[ &*](\w+)(\[.*\])?( =|\{).*)");

/// Types and constants that `lines` of a header define at the level of a namespace.
void add_definitions(const std::vector<Line>& lines, Places& places) {
  std::vector<std::string> scope;
  for (const Line& line : lines) {
    std::smatch match;
    if (std::regex_search(line.text, match, kNamespace)) {
      scope.push_back(match[1]);
    } else if (std::regex_search(line.text, kEndOfNamespace) && !scope.empty()) {
      scope.pop_back();
    } else if (std::regex_match(line.text, match, kType) ||
               std::regex_match(line.text, match, kConstant)) {
      std::string name;
      for (const std::string& each : scope) name += each + "::";
      places[name + match[1].str()].push_back(place(line));
    }
  }
}

Places definitions_in_headers() {
  Places places;
  const fs::path source = AIMS_SOURCE_DIR;
  for (const fs::directory_entry& folder : fs::directory_iterator(source)) {
    const std::string name = folder.path().filename().string();
    if (!folder.is_directory() || name[0] == '.' || name == "build" || name == "tests") continue;
    for (const fs::directory_entry& file : fs::recursive_directory_iterator(folder)) {
      if (file.path().extension() != ".hpp") continue;
      add_definitions(read_lines(fs::relative(file.path(), source)), places);
    }
  }
  return places;
}

TEST(Definitions, NoNameHasTwoInHeaders) {
  const Places places = definitions_in_headers();
  EXPECT_GT(places.size(), 600U) << "the headers are found";
  for (const auto& [name, where] : places) {
    std::string all;
    for (const std::string& each : where) all += " " + each;
    EXPECT_EQ(where.size(), 1U) << name << " is defined at" << all;
  }
}

TEST(Definitions, OfTypesAndConstantsAreFound) {
  Places places;
  add_definitions(split_lines("a.hpp",
                              "namespace aims {\nclass One {\n};\nstruct Two;\n"
                              "inline constexpr int kThree = 3;\n}  // namespace aims\n"
                              "namespace aims {\nstruct One : Base {\n"),
                  places);
  ASSERT_EQ(places.size(), 2U);
  EXPECT_EQ(places.at("aims::One").size(), 2U);
  EXPECT_EQ(places.count("aims::kThree"), 1U);
}

}  // namespace
}  // namespace aims::lint
