// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "core/files/byte_cursor.hpp"
#include "recordings/messages/message_decoder.hpp"
#include "recordings/messages/message_definition.hpp"

namespace aims {
namespace {

constexpr MessageFormat kIdlFormat{Serialization::kCdr, DefinitionLanguage::kRos2Idl};
const std::string kSeparator(80, '=');

std::string in_module(const std::string& content) {
  return "module p { module msg {\n" + content + "\n}; };\n";
}

std::string refusal(const std::string& content) {
  const auto types = parse_definition("p/msg/T", in_module(content), kIdlFormat.language);
  if (types) return "";
  const std::string start = "definition of 'p/T', ";
  EXPECT_TRUE(types.error().message.starts_with(start)) << types.error().message;
  return types.error().message.substr(start.size());
}

/// The fields of p/T as "type[count] name".
std::vector<std::string> fields_of(const std::string& text) {
  const auto types = parse_definition("p/T", text, kIdlFormat.language);
  EXPECT_TRUE(types) << types.error().message;
  std::vector<std::string> fields;
  if (!types) return fields;
  for (const FieldDefinition& field : types->front().fields) {
    std::string brackets;
    if (field.array == ArrayKind::kVariable) brackets = "[]";
    if (field.array == ArrayKind::kFixed) brackets = "[" + std::to_string(field.count) + "]";
    fields.push_back(field.type + brackets + " " + field.name);
  }
  return fields;
}

using Lines = std::vector<std::string>;

TEST(IdlDefinition, BasicTypesByOldAndNewNames) {
  EXPECT_EQ(
      fields_of(in_module("struct T { boolean a; octet b; char c; int8 d; uint8 e; short f;\n"
                          "unsigned short g; long h; unsigned long i; long long j;\n"
                          "unsigned long long k; float l; double m; string<8> n; int64 o, q; };")),
      (Lines{"bool a", "byte b", "char c", "int8 d", "uint8 e", "int16 f", "uint16 g", "int32 h",
             "uint32 i", "int64 j", "uint64 k", "float32 l", "float64 m", "string n", "int64 o",
             "int64 q"}));
}

TEST(IdlDefinition, ArraysSequencesAndTypedefs) {
  EXPECT_EQ(fields_of(in_module("typedef double double__9[9];\ntypedef p::msg::V p__msg__V;\n"
                                "typedef p__msg__V p__msg__V__2[2];\nconst long kRows = 3;\n"
                                "typedef sequence<float> Floats;\nstruct V { long x; };\n"
                                "struct T { double__9 a; p__msg__V__2 b; sequence<V, 4> c;\n"
                                "sequence<string<5>> d; octet e[kRows][4]; double__9 f[2];\n"
                                "Floats g; ::p::msg::V h; msg::V i; };")),
            (Lines{"float64[9] a", "p/V[2] b", "p/V[] c", "string[] d", "byte[12] e",
                   "float64[18] f", "float32[] g", "p/V h", "p/V i"}));
}

TEST(IdlDefinition, FilesOfOneModuleFollowEachOther) {
  const std::string text =
      "// generated\n#ifndef P_T\n #define P_T 1\n#pragma once\n#endif\n#include "
      "\"q/msg/U.idl\"\n" +
      in_module(
          "typedef float f__2[2];\nstruct T { "
          "f__2 a; q::msg::U u; builtin_interfaces::msg::Time t; };") +
      kSeparator + "\nIDL: p/msg/W\n" + in_module("typedef float f__2[2];\nstruct W { f__2 a; };") +
      kSeparator + "\r\nIDL: q/msg/U\r\nmodule q { module msg { struct U { p::msg::W w; }; }; };\n";
  // As rosbag2 writes it, the first type has its line too.
  for (const std::string& head : {std::string(), kSeparator + "\nIDL: p/msg/T\n"}) {
    EXPECT_EQ(fields_of(head + text),
              (Lines{"float32[2] a", "q/U u", "builtin_interfaces/Time t"}));
    const auto decoder = MessageDecoder::create("p/T", head + text, kIdlFormat);
    ASSERT_TRUE(decoder) << decoder.error().message;
    ASSERT_EQ(decoder->fields().size(), 3U);
    EXPECT_EQ(decoder->fields()[1].path, "u.w.a");
  }
}

TEST(IdlDefinition, AnnotationsAndCommentsAreLeftOut) {
  EXPECT_EQ(fields_of(in_module("@verbatim (language=\"comment\", text=\n  \"a ) struct { \\\" \" "
                                "\"\\n\" \"b\")\n/* struct X\n====\n */ @final struct T { // no\n"
                                "@default (value=-1.5e-3) @unit(\"m/s\") @key double a; };")),
            (Lines{"float64 a"}));
}

TEST(IdlDefinition, ConstantsBelongToTheirType) {
  const auto types = parse_definition(
      "p/T",
      in_module("module T_Constants { const octet kA = 7; @verbatim(text=\"x\") const float kB = "
                "-1.5e-3;\nconst string kC = \"say \\\"hi\\\"\" \" # all\"; const boolean kD = "
                "TRUE; };\nstruct T { octet a; };"),
      kIdlFormat.language);
  ASSERT_TRUE(types) << types.error().message;
  Lines constants;
  for (const ConstantDefinition& each : types->front().constants) {
    constants.push_back(each.type + " " + each.name + "=" + each.value);
  }
  EXPECT_EQ(constants, (Lines{"byte kA=7", "float32 kB=-1.5e-3",
                              "string kC=\"say \\\"hi\\\" # all\"", "bool kD=TRUE"}));
}

TEST(IdlDefinition, AnEnumerationTakesFourBytes) {
  const std::string text = in_module(
      "enum Gait { STAND, TROT, kCount };\n"
      "struct T { octet a; Gait gait; octet b[kCount]; };");
  EXPECT_EQ(fields_of(text), (Lines{"byte a", "uint32 gait", "byte[2] b"}));
  const auto decoder = MessageDecoder::create("p/T", text, kIdlFormat);
  ASSERT_TRUE(decoder) << decoder.error().message;
  const auto view = decoder->decode(bytes_of(std::string("\0\0\0\0\x09\0\0\0\0\0\0\1\5\6", 14)));
  ASSERT_TRUE(view) << view.error().message;
  EXPECT_EQ(view->number("gait"), 1.0);
  EXPECT_EQ(view->numbers("b"), (std::vector<double>{5, 6}));
}

TEST(IdlDefinition, TheInnermostModuleCountsFirst) {
  const std::string text =
      "module p { struct V { octet x; }; module msg { struct V { long x; };\n"
      "struct T { V a; p::V b; p::msg::V c; }; }; };\n";
  const auto types = parse_definition("p/T", text, kIdlFormat.language);
  ASSERT_FALSE(types);  // both are p/V
  EXPECT_EQ(types.error().message, "definition of 'p/T', line 1: 'p/V' is defined twice");
  EXPECT_EQ(fields_of("module V { struct X { octet x; }; };\nmodule p { module V { struct X { long "
                      "x; }; };\nmodule msg { struct T { V::X a; ::V::X b; }; }; };\n"),
            (Lines{"p/V/X a", "V/X b"}));
}

TEST(IdlDefinition, ErrorsNameTheLineAndWhatWasExpected) {
  EXPECT_EQ(refusal("struct T { long a };"), "line 2: expected ';', found '}'");
  EXPECT_EQ(refusal("struct T {\nlong 3a; };"), "line 3: expected a name, found '3a'");
  EXPECT_EQ(refusal("struct T {\nunsigned float a; };"), "line 3: expected 'long', found 'float'");
  EXPECT_EQ(refusal("struct T {\nlong double a; };"),
            "line 3: expected a number of 64 bits or fewer, found 'double'");
  EXPECT_EQ(refusal("union U switch (long) { case 1: long a; };"),
            "line 2: expected module, struct, typedef, const or enum, found 'union'");
  EXPECT_EQ(refusal("struct T { long a[0]; };"),
            "line 2: expected a whole number above 0, found '0'");
  EXPECT_EQ(refusal("struct T { sequence<sequence<long>> a; };"),
            "line 2: expected a type that is no sequence itself, found 'sequence'");
  EXPECT_EQ(refusal("struct T { long a; @key"), "line 3: expected a name, found '}'");
  const auto cut = parse_definition("p/T", "module p {\nstruct T { long a;", kIdlFormat.language);
  EXPECT_EQ(cut.error().message, "definition of 'p/T', line 2: expected a name, found the end");
  EXPECT_EQ(refusal("struct T { long a; };\n/* no end"),
            "line 3: expected module, struct, typedef, const or enum, found '/* no end'");
  EXPECT_EQ(refusal("@verbatim(text=\"no end\nstruct T { long a; };"),
            "line 2: expected ')' of '@verbatim', found '\"no end'");
  EXPECT_EQ(refusal("#if WIDE\nstruct T { long a; };"),
            "line 2: expected module, struct, typedef, const or enum, found '#if WIDE'");
  EXPECT_EQ(refusal(kSeparator + "\nIDL: p/msg/V\nstruct V { long x; };"),
            "line 3: expected module, struct, typedef, const or enum, found 'IDL: p/msg/V'");
  const auto mixed = parse_definition(
      "p/T", in_module("struct T { long a; };") + kSeparator + "\nMSG: p/V\nint32 a\n",
      kIdlFormat.language);
  ASSERT_FALSE(mixed);
  EXPECT_EQ(mixed.error().message,
            "definition of 'p/T', line 5: expected 'IDL: package/msg/Type', found 'MSG: p/V'");
}

TEST(IdlDefinition, ErrorsNameWhatCannotBeMeant) {
  EXPECT_EQ(refusal("struct Own { long a; };"),
            "line 1: expected a struct 'p/msg/T' in its module");
  EXPECT_EQ(refusal("struct T {\nq::msg::U u; };"),
            "line 3: unknown type 'q::msg::U': expected a basic type or one that the definition "
            "holds");
  EXPECT_EQ(refusal("typedef A B;\ntypedef B A;\nstruct T { A a; };"),
            "line 3: 'B' is a typedef of itself, or one of more than 16 others");
  EXPECT_EQ(refusal("typedef long A[2];\nstruct T { sequence<A> a; };"),
            "line 3: a sequence of 'A', which is an array or sequence itself: expected a sequence "
            "of single values or structures");
  EXPECT_EQ(refusal("typedef sequence<long> A;\nstruct T { A a[2]; };"),
            "line 3: an array of sequences: expected an array of single values or structures");
  EXPECT_EQ(refusal("struct T { long a[65536][65536]; };"),
            "line 2: an array of more than 2^32 - 1 entries");
  EXPECT_EQ(refusal("const string kN = \"3\";\nstruct T { long a[kN]; };"),
            "line 3: expected a whole number above 0 or a constant that is one as the size of an "
            "array, found 'kN'");
  EXPECT_EQ(refusal("struct T { long a; };\nstruct T { long b; };"),
            "line 3: 'p::msg::T' is defined twice");
  EXPECT_EQ(refusal("typedef long A[2];\ntypedef long A[3];"),
            "line 3: 'p::msg::A' is defined twice, differently");
  EXPECT_EQ(refusal("struct T { @optional long a; };"),
            "line 2: '@optional' changes how values are serialized: expected a definition without "
            "it");
  EXPECT_EQ(refusal("@extensibility(MUTABLE) struct T { long a; };"),
            "line 2: expected FINAL or APPENDABLE, found 'MUTABLE'");
  const auto wide =
      MessageDecoder::create("p/T", in_module("struct T {\nwstring<4> w; };"), kIdlFormat);
  ASSERT_FALSE(wide);
  EXPECT_NE(wide.error().message.find("line 3: field 'w' is a wstring"), std::string::npos);
}

TEST(IdlDefinition, ExpandingDefinitionsAreRefused) {
  std::string deep, many;
  for (int i = 0; i < 1000; ++i) deep += "module m { ";
  EXPECT_EQ(refusal(deep), "line 2: modules nested deeper than 16");
  for (int i = 0; i < 600; ++i) many += "struct S" + std::to_string(i) + " { long a; };\n";
  EXPECT_EQ(refusal(many), "line 514: too many types");
  std::string wide = "struct T {";
  for (int i = 0; i < 5000; ++i) wide += "long a" + std::to_string(i) + ";\n";
  EXPECT_NE(refusal(wide + "};").find("a type of more than 4096 fields"), std::string::npos);
  const auto itself = MessageDecoder::create(
      "p/T", in_module("struct V { sequence<V> v; };\nstruct T { V v; };"), kIdlFormat);
  ASSERT_FALSE(itself);
  EXPECT_NE(itself.error().message.find("type 'p/V' holds itself"), std::string::npos);
}

}  // namespace
}  // namespace aims
