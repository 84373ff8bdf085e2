// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <map>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "core/time.hpp"

namespace aims {

/// How a made-up message is put down.
enum class ByteStyle { kRos1, kCdrLittle, kCdrBig };

/// A made-up message type with one message of it: definition, bytes, and every value by its path.
/// Written apart from the decoder: values are put down as the bytes are.
class RandomMessage {
 public:
  explicit RandomMessage(std::uint32_t seed, ByteStyle style = ByteStyle::kRos1)
      : style_(style), random_(seed) {
    if (is_cdr()) bytes_ = std::string(style == ByteStyle::kCdrBig ? "\0\0\0\0" : "\0\1\0\0", 4);
    const std::string root = make_type(0);
    for (std::size_t i = 1; i < types_.size(); ++i) {
      definition_ += std::string(80, '=') + "\nMSG: test_msgs/T" + std::to_string(i) + "\n" +
                     text_of(types_[i]);
    }
    definition_ = text_of(types_[0]) + definition_;
    for (std::size_t i = 0; is_cdr() && i < types_.size(); ++i) add_idl(i);
    write(types_[0], "");
  }

  std::string type() const { return "test_msgs/T0"; }
  const std::string& definition() const { return definition_; }
  /// The same in OMG IDL, of ROS 2 alone; types of several values by typedef, as ROS 2 has them.
  const std::string& idl() const { return idl_; }
  const std::string& bytes() const { return bytes_; }

  std::vector<std::pair<std::string, double>> numbers;
  std::vector<std::pair<std::string, std::vector<double>>> arrays;
  std::vector<std::pair<std::string, Time>> times;
  std::vector<std::pair<std::string, std::string>> texts;
  std::vector<std::pair<std::string, std::size_t>> sizes;

 private:
  struct Field {
    std::string type;  ///< builtin, or "T3"
    int nested = -1;
    std::string name;
    int count = -1;  ///< -1: single, 0: open array, else fixed
  };
  using Fields = std::vector<Field>;

  bool is_cdr() const { return style_ != ByteStyle::kRos1; }

  std::uint32_t pick(std::uint32_t below) { return static_cast<std::uint32_t>(random_() % below); }

  std::string make_type(int depth) {
    static const char* const kBuiltins[] = {
        "bool",   "int8",  "uint8",  "byte",    "char",    "int16",  "uint16", "int32",
        "uint32", "int64", "uint64", "float32", "float64", "string", "time",   "duration"};
    const std::size_t place = types_.size();
    types_.emplace_back();
    Fields fields;
    const std::uint32_t count = 1 + pick(6);
    for (std::uint32_t i = 0; i < count; ++i) {
      Field field;
      field.name = "f" + std::to_string(i) + "_";
      field.count = pick(3) == 0 ? 0 : (pick(3) == 0 ? static_cast<int>(1 + pick(4)) : -1);
      if (depth < 3 && pick(3) == 0) {
        field.nested = static_cast<int>(types_.size());
        field.type = make_type(depth + 1);
      } else {
        field.type = kBuiltins[pick(16)];
        if (is_cdr() && field.type == "time") field.type = "builtin_interfaces/Time";
        if (is_cdr() && field.type == "duration") field.type = "builtin_interfaces/Duration";
      }
      fields.push_back(field);
    }
    types_[place] = fields;
    return "T" + std::to_string(place);
  }

  std::string text_of(const Fields& fields) {
    std::string text = "# a comment = none\nint32 CONSTANT=5 # five\nstring WORD=a # b\n\n";
    for (const Field& field : fields) {
      const bool full = field.nested >= 0 && pick(2) == 0;
      const std::string brackets =
          field.count < 0
              ? ""
              : (field.count == 0 ? "[" + bound() + "]" : "[" + std::to_string(field.count) + "]");
      const std::string package = !full ? "" : (is_cdr() ? "test_msgs/msg/" : "test_msgs/");
      const std::string length = field.type == "string" ? bound() : "";
      const bool plain = is_cdr() && field.nested < 0 && field.count < 0 && field.type != "string";
      text += "  " + package + field.type + length + brackets + "\t " + field.name +
              (plain && pick(4) == 0 ? " 1" : "") + (pick(2) == 0 ? "# x=1" : "") +
              (pick(4) == 0 ? "\r\n" : "\n");
    }
    return text;
  }

  static std::string idl_name(const Field& field) {
    static const std::map<std::string, std::string> kNames = {
        {"bool", "boolean"},
        {"byte", "octet"},
        {"char", "uint8"},
        {"int16", "short"},
        {"uint16", "unsigned short"},
        {"int32", "long"},
        {"uint32", "unsigned long"},
        {"int64", "long long"},
        {"uint64", "unsigned long long"},
        {"float32", "float"},
        {"float64", "double"},
        {"builtin_interfaces/Time", "builtin_interfaces::msg::Time"},
        {"builtin_interfaces/Duration", "builtin_interfaces::msg::Duration"}};
    if (field.nested >= 0) return "test_msgs::msg::" + field.type;
    const auto found = kNames.find(field.type);
    return found == kNames.end() ? field.type : found->second;
  }

  void add_idl(std::size_t place) {
    std::string aliases, members;
    for (const Field& field : types_[place]) {
      const std::string type = idl_name(field);
      std::string used = type;
      if (field.count == 0) used = "sequence<" + type + (pick(2) == 0 ? ", 9>" : ">");
      if (field.count > 0) {
        std::string base = field.type.substr(field.type.find('/') + 1);
        used = base + "__" + std::to_string(field.count);
        aliases += "    typedef " + type + " " + base + "__;\n    typedef " + base + "__ " + used +
                   "[" + std::to_string(field.count) + "];\n";
      }
      members += "      @default (value=1) // one\n      " + used + " " + field.name + ";\n";
    }
    const std::string name = "T" + std::to_string(place);
    if (place > 0) idl_ += std::string(80, '=') + "\nIDL: test_msgs/msg/" + name + "\n";
    idl_ += "module test_msgs {\n  module msg {\n" + aliases + "    struct " + name + " {\n" +
            members + "    };\n  };\n};\n";
  }

  std::string bound() { return is_cdr() && pick(2) == 0 ? "<=9" : ""; }

  template <class T>
  double put(T value) {
    while (is_cdr() && (bytes_.size() - 4) % sizeof(T) != 0) bytes_ += '?';  // padding is not read
    std::string written(reinterpret_cast<const char*>(&value), sizeof(value));
    if (style_ == ByteStyle::kCdrBig) std::reverse(written.begin(), written.end());
    bytes_ += written;
    return static_cast<double>(value);
  }

  double put_number(const std::string& type) {
    if (type == "bool") return put(static_cast<std::uint8_t>(pick(2)));
    if (type == "byte" && is_cdr()) return put(static_cast<std::uint8_t>(random_()));
    if (type == "int8" || type == "byte") return put(static_cast<std::int8_t>(random_()));
    if (type == "uint8" || type == "char") return put(static_cast<std::uint8_t>(random_()));
    if (type == "int16") return put(static_cast<std::int16_t>(random_()));
    if (type == "uint16") return put(static_cast<std::uint16_t>(random_()));
    if (type == "int32") return put(static_cast<std::int32_t>(random_()));
    if (type == "uint32") return put(static_cast<std::uint32_t>(random_()));
    if (type == "int64") return put(static_cast<std::int64_t>(random_()));
    if (type == "uint64") return put(static_cast<std::uint64_t>(random_()));
    if (type == "float32") return put(static_cast<float>(pick(1000)) / 7.0F);
    return put(static_cast<double>(random_()) / 3.0);
  }

  void put_one(const Field& field, const std::string& path, std::vector<double>* array) {
    if (field.nested >= 0) {
      write(types_[static_cast<std::size_t>(field.nested)], path + ".");
    } else if (field.type == "string") {
      texts.emplace_back(path, std::string(pick(6), 's'));
      const std::string zero(is_cdr() ? 1 : 0, '\0');
      put(static_cast<std::uint32_t>(texts.back().second.size() + zero.size()));
      bytes_ += texts.back().second + zero;
    } else if (field.type == "builtin_interfaces/Time" ||
               field.type == "builtin_interfaces/Duration") {
      const auto seconds = static_cast<std::int32_t>(random_());
      put(seconds);
      put(std::uint32_t{999'999'999});
      times.emplace_back(path, Time{seconds} * kSecond + 999'999'999);
    } else if (field.type == "time") {
      const auto seconds = static_cast<std::uint32_t>(random_());
      put(seconds);
      put(std::uint32_t{999'999'999});
      times.emplace_back(path, Time{seconds} * kSecond + 999'999'999);
    } else if (field.type == "duration") {
      const auto seconds = static_cast<std::int32_t>(random_());
      put(seconds);
      put(std::int32_t{-7});
      times.emplace_back(path, Time{seconds} * kSecond - 7);
    } else {
      numbers.emplace_back(path, put_number(field.type));
      if (array != nullptr) array->push_back(numbers.back().second);
    }
  }

  void write(const Fields& fields, const std::string& prefix) {
    for (const Field& field : fields) {
      const std::string path = prefix + field.name;
      if (field.count < 0) {
        put_one(field, path, nullptr);
        continue;
      }
      const std::uint32_t count =
          field.count == 0 ? pick(4) : static_cast<std::uint32_t>(field.count);
      if (field.count == 0) put(count);
      sizes.emplace_back(path, count);
      std::vector<double> values;
      for (std::uint32_t i = 0; i < count; ++i) {
        put_one(field, path + "[" + std::to_string(i) + "]", &values);
      }
      const bool is_number = field.nested < 0 && field.type != "string" && field.type != "time" &&
                             field.type != "duration" && field.type.find('/') == std::string::npos;
      if (is_number) arrays.emplace_back(path, values);
    }
  }

  ByteStyle style_;
  std::mt19937_64 random_;
  std::vector<Fields> types_;
  std::string definition_;
  std::string idl_;
  std::string bytes_;
};

}  // namespace aims
