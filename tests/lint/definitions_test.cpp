// SPDX-License-Identifier: BSD-3-Clause
// One name, one definition: two classes or inline functions of one name in one namespace are
// undefined behaviour once both are linked into a program, and no compiler has to say so.
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

/// Begins a declaration at the level of a namespace that is none of the above.
const std::regex kDeclaration(R"(^(?!(?:namespace|struct|class|enum|using)\b)\w.*)");
const std::regex kFunction(R"(^[^(={;]*?([\w:]+)(\([^{;]*)\{)");

/// Name and parameters of a function that `declaration` defines, in which overloads differ; else
/// empty.
std::string signature(const std::string& declaration) {
  std::smatch match;
  return std::regex_search(declaration, match, kFunction) ? match[1].str() + match[2].str() : "";
}

/// Types, constants and functions that `lines` of a header define at the level of a namespace.
void add_definitions(const std::vector<Line>& lines, Places& places) {
  std::vector<std::string> scope;
  std::string head, declaration;  // lines so far: of a template, and behind it
  Line first;
  const auto add = [&](const std::string& name, const Line& line) {
    std::string qualified;
    for (const std::string& each : scope) qualified += each + "::";
    places[qualified + name].push_back(place(line));
  };
  for (const Line& line : lines) {
    std::smatch match;
    if (std::regex_search(line.text, match, kNamespace)) {
      scope.push_back(match[1]);
    } else if (std::regex_search(line.text, kEndOfNamespace) && !scope.empty()) {
      scope.pop_back();
    } else if (std::regex_match(line.text, match, kType) ||
               std::regex_match(line.text, match, kConstant)) {
      add(match[1], line);
      head.clear();
    } else if (!declaration.empty() || std::regex_match(line.text, kDeclaration)) {
      if (line.text.starts_with("template") || line.text.starts_with("requires")) {
        head += line.text;
        continue;
      }
      if (declaration.empty()) first = line;
      declaration += line.text;
      if (declaration.find_first_of("{;") == std::string::npos) continue;
      if (const std::string name = signature(declaration); !name.empty()) add(name + head, first);
      declaration.clear();
      head.clear();
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

TEST(Definitions, OfFunctionsAreFoundWithTheirParameters) {
  Places places;
  add_definitions(split_lines("a.hpp",
                              "namespace aims {\ninline int one(int a) { return a; }\n"
                              "int two(int a);\ninline int one(double a) {\n  return 1;\n}\n"
                              "template <class T>\nT three(T a,\n        T b) {\n"
                              "inline int one(int a) {\n}  // namespace aims\n"),
                  places);
  ASSERT_EQ(places.size(), 3U);
  EXPECT_EQ(places.at("aims::one(int a) ").size(), 2U);
  EXPECT_EQ(places.count("aims::one(double a) "), 1U);
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
