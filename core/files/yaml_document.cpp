// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/yaml_document.hpp"

#include <fmt/format.h>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <vector>

#include "core/text.hpp"

namespace aims {
namespace {

namespace fs = std::filesystem;

constexpr int kDeepest = 100;
/// A shorter text costs the parser little, however deep it nests.
constexpr std::size_t kHarmless = std::size_t{128} << 10;

/// Follows how deep a text nests. Brackets in quoted text count too, which no long configuration
/// has by the hundred.
class Nesting {
 public:
  /// False when this character takes it too deep.
  bool add(char c) {
    if (c == '\n') ++line_;
    if (c == '[' || c == '{') ++brackets_;
    if (c == ']' || c == '}') brackets_ = std::max(0, brackets_ - 1);
    const bool blank = c == ' ' || c == '\t';
    const bool mark = c == '-' || c == '?';
    if (blank && last_was_mark_) ++marks_;
    if (!blank && !mark) marks_ = 0;
    last_was_mark_ = mark;
    return brackets_ <= kDeepest && marks_ <= kDeepest;
  }
  int line() const { return line_; }

 private:
  int line_ = 1;
  int brackets_ = 0;  ///< open ones
  int marks_ = 0;     ///< "- - - ": a list in a list in a list
  bool last_was_mark_ = false;
};

}  // namespace

Result<void> check_yaml_size(std::string_view text, const std::string& name) {
  if (text.size() > kLargestYaml) {
    return failure(
        fmt::format("{}: expected at most {} bytes, found {}", name, kLargestYaml, text.size()));
  }
  if (text.size() <= kHarmless) return {};
  Nesting nesting;
  for (const char c : text) {
    if (!nesting.add(c)) {
      return failure(
          fmt::format("{}:{}: expected no deeper nesting than {}", name, nesting.line(), kDeepest));
    }
  }
  return {};
}

namespace {

/// Longest chain of bases that is followed; loading rejects cycles before.
constexpr int kMaxBases = 32;

struct Position {
  fs::path file;
  YAML::Mark mark;
  std::size_t depth = 0;  ///< parts of the key that were found
};

YAML::Node child_of(const YAML::Node& node, const std::string& part) {
  if (node.IsMap()) return node[part];
  const bool index = !part.empty() && part.find_first_not_of("0123456789") == std::string::npos;
  if (node.IsSequence() && index && part.size() < 9) return node[std::stoul(part)];
  return YAML::Node(YAML::NodeType::Undefined);
}

Position deepest(const fs::path& file, const YAML::Node& root,
                 const std::vector<std::string>& parts) {
  Position found{file, YAML::Mark::null_mark(), 0};
  YAML::Node node = root;
  for (const std::string& part : parts) {
    const YAML::Node child = child_of(node, part);
    if (!child.IsDefined()) break;
    node.reset(child);
    found.mark = node.Mark();
    ++found.depth;
  }
  return found;
}

/// The deepest match in the file or its bases; the file itself wins a tie.
Position search(fs::path file, const std::vector<std::string>& parts, const fs::path& named) {
  Position best{file, YAML::Mark::null_mark(), 0};
  for (int i = 0; i < kMaxBases; ++i) {
    const YAML::Node root = YAML::LoadFile(file.string());
    if (!root.IsMap()) break;
    const Position here = deepest(file, root, parts);
    if (here.depth > best.depth) best = here;
    if (!root["base"]) break;
    const auto base = find_base(file, root["base"].as<std::string>(), named);
    if (!base) break;
    file = *base;
  }
  return best;
}

}  // namespace

std::string with_position(const fs::path& file, const std::string& message, const fs::path& named) {
  try {
    const Position at = search(file, split(message.substr(0, message.find(": ")), '.'), named);
    if (at.depth > 0) {
      return fmt::format("{}:{}:{}: {}", at.file.string(), at.mark.line + 1, at.mark.column + 1,
                         message);
    }
  } catch (const YAML::Exception&) {
    // The file changed since it was loaded: the message has no position.
  }
  return fmt::format("{}: {}", file.string(), message);
}

namespace {

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
