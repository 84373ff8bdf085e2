// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/yaml_document.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <vector>

#include "core/files/yaml_size.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

/// The first tab that indents the line at `last` or the one before (from 0), where a parser fails
/// on it; YAML itself then complains about something else.
std::optional<YAML::Mark> indenting_tab(const std::string& text, int last) {
  std::istringstream lines(text);
  std::string line;
  for (int i = 0; i <= last && std::getline(lines, line); ++i) {
    const std::size_t first = std::min(line.find_first_not_of(" \t\r"), line.size());
    const std::size_t tab = line.find('\t');
    if (i + 1 < last || tab >= first) continue;
    YAML::Mark mark;
    mark.line = i;
    mark.column = static_cast<int>(tab);
    return mark;
  }
  return std::nullopt;
}

/// What is wrong with a text that does not parse.
std::string syntax_message(const std::string& text, const std::string& file,
                           const YAML::Exception& error) {
  if (!error.mark.is_null()) {
    if (const auto tab = indenting_tab(text, error.mark.line)) {
      return fmt::format("{}: a tab; YAML indents by spaces", place(file, *tab));
    }
  }
  return fmt::format("{}: not valid YAML: {}", place(file, error.mark), error.msg);
}

/// Remembers where documents begin.
class Beginnings : public YAML::EventHandler {
 public:
  std::vector<YAML::Mark> marks;

  void OnDocumentStart(const YAML::Mark& mark) override { marks.push_back(mark); }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
  void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
  void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t,
                const std::string&) override {}
  void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                       YAML::EmitterStyle::value) override {}
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t,
                  YAML::EmitterStyle::value) override {}
  void OnMapEnd() override {}
};

/// Where the first two documents of a text begin. There may be no end of them: before a character
/// that begins nothing, such as a comma, the parser finds one empty document after the other.
std::vector<YAML::Mark> first_beginnings(const std::string& text) {
  std::istringstream stream(text);
  YAML::Parser parser(stream);
  Beginnings beginnings;
  while (beginnings.marks.size() < 2 && parser.HandleNextDocument(beginnings)) {
  }
  return beginnings.marks;
}

/// The only document of a text, if it has any.
Result<std::optional<YAML::Node>> parse_only(const std::string& text, const std::string& file) {
  if (auto bounded = check_yaml_size(text, file); !bounded) {
    return tl::unexpected(bounded.error());
  }
  try {
    const std::vector<YAML::Mark> documents = first_beginnings(text);
    if (documents.empty()) return std::nullopt;
    if (documents.size() > 1) {
      return failure(
          fmt::format("{}: expected one YAML document, found another", place(file, documents[1])));
    }
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    return failure(syntax_message(text, file, error));
  } catch (const std::exception& error) {
    return failure(fmt::format("{}: not valid YAML: {}", file, error.what()));
  }
}

/// The files of that name in `folder` and below, in order of their paths.
std::vector<fs::path> files_named(const fs::path& folder, const std::string& name) {
  std::vector<fs::path> found;
  std::error_code ignored;
  for (const auto& entry : fs::recursive_directory_iterator(folder, ignored)) {
    if (entry.path().filename() == name) found.push_back(entry.path());
  }
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace

std::string place(const std::string& file, const YAML::Mark& mark) {
  if (mark.is_null()) return file;
  return fmt::format("{}:{}:{}", file, mark.line + 1, mark.column + 1);
}

std::string kind_of(const YAML::Node& node) {
  if (node.IsMap()) return "a map";
  if (node.IsSequence()) return "a list";
  if (node.IsNull()) return "nothing";
  return fmt::format("'{}'", node.Scalar());
}

Result<YAML::Node> parse_document(const std::string& text, const std::string& file) {
  const auto document = parse_only(text, file);
  if (!document) return tl::unexpected(document.error());
  if (!*document || (*document)->IsNull()) {
    return failure(fmt::format("{}: expected a map of settings, the file is empty", file));
  }
  if ((*document)->IsMap()) return **document;
  return failure(fmt::format("{}: expected a map of settings, found {}",
                             place(file, (*document)->Mark()), kind_of(**document)));
}

Result<YAML::Node> parse_value(const std::string& text, const std::string& setting) {
  const auto document = parse_only(text, setting);
  if (!document) return tl::unexpected(document.error());
  return document->value_or(YAML::Node());
}

Result<fs::path> find_base(const fs::path& file, const std::string& given, const fs::path& named) {
  std::error_code ignored;
  const fs::path beside = file.parent_path() / given;
  if (fs::is_regular_file(beside, ignored)) return beside;
  const auto missing = [&] {
    return failure(fmt::format("base: no such file '{}'", beside.string()));
  };
  if (fs::path(given).has_extension()) return missing();
  const fs::path with_extension = beside.string() + ".yaml";
  const bool itself = fs::equivalent(with_extension, file, ignored);
  if (!itself && fs::is_regular_file(with_extension, ignored)) return with_extension;
  if (named.empty() || given.find('/') != std::string::npos) return missing();
  std::vector<fs::path> found = files_named(named, given + ".yaml");
  std::erase_if(found, [&](const fs::path& each) { return fs::equivalent(each, file, ignored); });
  if (found.size() == 1) return found.front();
  if (found.size() > 1) {
    return failure(fmt::format("base: '{}' is {} and {}; expected the path of one", given,
                               found[0].string(), found[1].string()));
  }
  return failure(fmt::format("base: no such file '{}', and no {}.yaml in {}", beside.string(),
                             given, named.string()));
}

}  // namespace aims
