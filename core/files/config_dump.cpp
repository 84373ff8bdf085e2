// SPDX-License-Identifier: BSD-3-Clause
#include "core/files/config_dump.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <vector>

namespace aims {
namespace {

/// A key of the nested document with its children, in the order of description.
struct Entry {
  std::string name = {};
  const Parameter* parameter = nullptr;
  bool is_list = false;
  std::vector<Entry> children = {};
};

Entry& child(Entry& parent, const std::string& name) {
  const auto found = std::find_if(parent.children.begin(), parent.children.end(),
                                  [&name](const Entry& each) { return each.name == name; });
  if (found != parent.children.end()) return *found;
  parent.children.push_back({.name = name});
  return parent.children.back();
}

/// The entry of a dotted key under `root`, made when missing.
Entry& entry_at(Entry& root, const std::string& key) {
  Entry* entry = &root;
  std::size_t start = 0;
  while (start <= key.size()) {
    const std::size_t dot = std::min(key.find('.', start), key.size());
    entry = &child(*entry, key.substr(start, dot - start));
    start = dot + 1;
  }
  return *entry;
}

/// Whether the list has entries and none of them has an effect.
bool is_idle(const ListField& list, const Fields& fields) {
  if (list.size() == 0) return false;
  const std::string start = list.key + ".";
  return std::ranges::none_of(fields.parameters(), [&](const Parameter& each) {
    return each.key.starts_with(start) && each.idle.empty();
  });
}

Entry tree_of(const Fields& fields) {
  Entry root;
  for (const Parameter& parameter : fields.parameters()) {
    if (parameter.idle.empty()) entry_at(root, parameter.key).parameter = &parameter;
  }
  for (const ListField& list : fields.lists()) {
    // Written as items without keys, it would be read back with the defaults of an entry.
    if (is_idle(list, fields)) continue;
    entry_at(root, list.key).is_list = true;
    for (std::size_t i = 0; i < list.size(); ++i) {
      entry_at(root, fmt::format("{}.{}", list.key, i));
    }
  }
  return root;
}

/// Whether YAML reads the text back unchanged without quotes, even in a flow sequence.
bool is_plain(const std::string& text) {
  const auto plain = [](unsigned char c) {
    return std::isalnum(c) != 0 || c == '_' || c == '.' || c == '/' || c == '-' || c == '+';
  };
  if (text.empty() || text == "-" || text == "---" || text == "...") return false;
  for (const char* null : {"null", "Null", "NULL"}) {
    if (text == null) return false;
  }
  return std::all_of(text.begin(), text.end(), plain);
}

std::string in_quotes(const std::string& text) {
  std::string out = "\"";
  for (const char c : text) {
    const auto code = static_cast<unsigned char>(c);
    if (c == '"' || c == '\\') {
      out += '\\';
      out += c;
    } else if (code < 0x20 || code == 0x7f) {
      out += fmt::format("\\x{:02x}", code);
    } else {
      out += c;
    }
  }
  return out + "\"";
}

std::string yaml_value(const Parameter& parameter) {
  const std::string text = parameter.text();
  if (!is_sequence(parameter)) return is_plain(text) ? text : in_quotes(text);
  std::vector<std::string> entries = sequence_entries(text).value_or(std::vector<std::string>());
  for (std::string& entry : entries) {
    if (!is_plain(entry)) entry = in_quotes(entry);
  }
  return fmt::format("[{}]", fmt::join(entries, ", "));
}

std::string note_of(const Parameter& parameter) {
  const Spec& spec = parameter.spec;
  std::string note = spec.unit.empty() ? "" : fmt::format("[{}] ", spec.unit);
  note += parameter.expected;
  if (!spec.meaning.empty()) note += "; " + spec.meaning;
  if (!spec.source.empty()) note += "; " + spec.source;
  std::replace(note.begin(), note.end(), '\n', ' ');
  return note;
}

/// Writes the entries of a tree as YAML lines.
class Writer {
 public:
  explicit Writer(bool annotated) : annotated_(annotated) {}

  /// The children of `parent`, the first one after `lead` (for a list item: "- ").
  void write_children(const Entry& parent, std::size_t indent, std::string lead) {
    for (const Entry& entry : parent.children) {
      out_ += lead.empty() ? std::string(indent, ' ') : lead;
      lead.clear();
      write(entry, indent);
    }
  }

  std::string take() { return std::move(out_); }

 private:
  void write(const Entry& entry, std::size_t indent) {
    out_ += entry.name + ":";
    if (entry.parameter != nullptr) {
      out_ += fmt::format(" {}", yaml_value(*entry.parameter));
      if (annotated_) out_ += fmt::format("  # {}", note_of(*entry.parameter));
      out_ += "\n";
    } else if (!entry.is_list) {
      out_ += "\n";
      write_children(entry, indent + 2, "");
    } else if (entry.children.empty()) {
      out_ += " []\n";
    } else {
      out_ += "\n";
      for (const Entry& item : entry.children) write_item(item, indent + 2);
    }
  }

  void write_item(const Entry& item, std::size_t indent) {
    const std::string lead = std::string(indent, ' ') + "- ";
    if (item.children.empty()) {
      out_ += lead + "{}\n";
    } else {
      write_children(item, indent + 2, lead);
    }
  }

  bool annotated_;
  std::string out_;
};

std::string written(const Fields& fields, bool annotated) {
  Writer writer(annotated);
  writer.write_children(tree_of(fields), 0, "");
  return writer.take();
}

}  // namespace

std::string dump_config(const Fields& fields) { return written(fields, false); }

std::string dump_annotated_config(const Fields& fields) { return written(fields, true); }

}  // namespace aims
