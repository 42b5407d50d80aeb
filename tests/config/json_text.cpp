#include "core/json_text.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <functional>

namespace penumbra {
namespace {

JsonDocument parse(const std::string& text) { return JsonDocument::parse(text, "f.json"); }

std::string error_of(const std::function<void()>& f) {
  try {
    f();
  } catch (const InputError& e) {
    return e.what();
  }
  return "no error";
}
std::string syntax_error(const std::string& text) {
  return error_of([&] { parse(text); });
}

TEST(JsonText, CommentsAreBlanksAndTheValueIsKept) {
  const JsonDocument d =
      parse("// head\n{ \"a\": [1, 2.5, \"x//y\"], /* c */ \"b\": {\"c\": null} } // tail");
  EXPECT_EQ(d.json(), nlohmann::json::parse(R"({"a":[1,2.5,"x//y"],"b":{"c":null}})"));
}

TEST(JsonText, LocationIsLineAndColumnOfTheValue) {
  const JsonDocument d = parse("{\n  \"a\": [1,\n     2],\n  \"b/c\": {\"~\": true}\n}");
  EXPECT_EQ(d.location("/a"), "f.json:2:8");
  EXPECT_EQ(d.location("/a/1"), "f.json:3:6");
  EXPECT_EQ(d.location("/b~1c/~0"), "f.json:4:16");
  EXPECT_EQ(d.key_location("/b~1c/~0"), "f.json:4:11");
  EXPECT_EQ(d.location("/a/7"), "f.json:2:8") << "the nearest ancestor";
  EXPECT_EQ(d.location(""), "f.json:1:1");
}

TEST(JsonText, ColumnsCountCharactersNotBytes) {
  EXPECT_EQ(parse("{\"\xc3\xa4\": 1}").location("/\xc3\xa4"), "f.json:1:7");
}

TEST(JsonText, ByteOrderMarkIsSkipped) { EXPECT_EQ(parse("\xef\xbb\xbf[1]").location("/0"), "f.json:1:2"); }

TEST(JsonText, SyntaxErrorsNamePlaceFoundAndExpected) {
  EXPECT_EQ(syntax_error(""), "f.json:1:1: found an empty file, expected a JSON value.");
  EXPECT_EQ(syntax_error("{\n \"a\" 1}"), "f.json:2:6: found '1', expected ':' after the key \"a\".");
  EXPECT_EQ(syntax_error("[1 2]"), "f.json:1:4: found '2', expected ',' or ']'.");
  EXPECT_EQ(syntax_error("{\"a\":1"), "f.json:1:7: found the end of the file, expected ',' or '}'.");
  EXPECT_EQ(syntax_error("{\"a\":1,}"),
            "f.json:1:8: found '}' after a comma, expected another \"key\" (a trailing comma is not JSON).");
  EXPECT_EQ(syntax_error("[1,]"),
            "f.json:1:4: found ']' after a comma, expected another value (a trailing comma is not JSON).");
  EXPECT_EQ(syntax_error("{a:1}"), "f.json:1:2: found 'a', expected a \"key\" or '}'.");
  EXPECT_EQ(syntax_error("[gears]"),
            "f.json:1:2: found gears, expected a value. Strings stand in double quotes.");
  EXPECT_EQ(syntax_error("[01]"), "f.json:1:2: found 01, expected a value.");
  EXPECT_EQ(syntax_error("[NaN]"),
            "f.json:1:2: found NaN, expected a value. Strings stand in double quotes.");
  EXPECT_EQ(syntax_error("[1e999]"), "f.json:1:2: found 1e999, expected a number that a double can hold.");
  EXPECT_EQ(syntax_error("[\"a\n\"]"),
            "f.json:1:2: found a string without an end, expected '\"' on the same line.");
  EXPECT_EQ(syntax_error("[\"\\q\"]"),
            "f.json:1:2: found a string that is not valid, expected valid UTF-8 and escapes.");
  EXPECT_EQ(syntax_error("[\"\xff\"]"),
            "f.json:1:2: found a string that is not valid, expected valid UTF-8 and escapes.");
  EXPECT_EQ(syntax_error("1 2"), "f.json:1:3: found '2' after the end of the JSON value, expected nothing.");
  EXPECT_EQ(syntax_error("/* x"), "f.json:1:1: found a comment without an end, expected '*/'.");
  EXPECT_EQ(syntax_error("[\x01]"), "f.json:1:2: found ?, expected a value.");
}

TEST(JsonText, DuplicateKeysAreErrors) {
  EXPECT_EQ(syntax_error("{\"a\": {\"b\": 1,\n \"b\": 2}}"),
            "f.json:2:2: /a/b: found this key a second time, expected it once (first at line 1).");
  EXPECT_EQ(syntax_error("[{\"b\": 1}, {\"b\": 2}]"), "no error") << "two objects may have the same key";
}

TEST(JsonText, DeepNestingIsAnErrorNotACrash) {
  EXPECT_NE(syntax_error(std::string(100000, '[')).find("levels of nesting"), std::string::npos);
}

TEST(JsonText, EveryTruncationOfAValidTextIsAnError) {
  const std::string text = R"({"a": [1.5e3, true, null, "s\u00e4\n"], "b": {"c": -2}})";
  for (std::size_t n = 0; n < text.size(); ++n)
    EXPECT_NE(syntax_error(text.substr(0, n)), "no error") << text.substr(0, n);
}

TEST(JsonText, MissingFilesAndFoldersAreNamed) {
  EXPECT_EQ(error_of([] { JsonDocument::read("/nowhere/x.json"); }), "/nowhere/x.json: no such file.");
  EXPECT_EQ(error_of([] { JsonDocument::read("/"); }), "/: found a folder, expected a JSON file.");
}

TEST(JsonNode, ReadersRejectOtherTypesAndRanges) {
  const JsonDocument d =
      parse(R"({"i": 7, "f": 2.5, "s": "text", "b": true, "big": 18446744073709551615, "w": 4.0})");
  const auto at = [&](const char* key) { return d.root().require(key, "x"); };
  EXPECT_EQ(at("i").integer(1, 7), 7);
  EXPECT_EQ(at("w").integer(), 4);
  EXPECT_EQ(at("i").number(), 7.0);
  EXPECT_EQ(error_of([&] { at("i").integer(8, 9); }),
            "f.json:1:7: /i: found 7, expected an integer from 8 to 9.");
  EXPECT_EQ(error_of([&] { at("i").integer(8); }),
            "f.json:1:7: /i: found 7, expected an integer of at least 8.");
  EXPECT_EQ(error_of([&] { at("f").integer(); }), "f.json:1:15: /f: found 2.5, expected an integer.");
  EXPECT_EQ(error_of([&] { at("f").number(0, 1); }),
            "f.json:1:15: /f: found 2.5, expected a number from 0 to 1.");
  EXPECT_NE(error_of([&] { at("big").integer(); }), "no error");
  EXPECT_NE(error_of([&] { at("b").number(); }), "no error");
  EXPECT_NE(error_of([&] { at("b").integer(); }), "no error");
  EXPECT_EQ(error_of([&] { at("s").boolean(); }), "f.json:1:25: /s: found \"text\", expected true or false.");
  EXPECT_NE(error_of([&] { at("i").string(); }), "no error");
  EXPECT_NE(error_of([&] { at("i").items(); }), "no error");
  EXPECT_NE(error_of([&] { at("i").members(); }), "no error");
  EXPECT_EQ(at("i").list_or_one().size(), 1u);
}

TEST(JsonNode, NamesAreCheckedAndTheNearestIsOffered) {
  const JsonDocument d = parse("{\"mask_sise\": 1, \"mode\": \"tigth\"}");
  EXPECT_EQ(error_of([&] {
              d.root().allow_only({"mask_size", "mode"}, "the config");
            }),
            "f.json:1:2: /mask_sise: found the key \"mask_sise\", expected a key of the config."
            " Did you mean 'mask_size'?");
  EXPECT_EQ(error_of([&] {
              d.root().require("mode", "x").choice({"none", "tight"}, "a fit");
            }),
            "f.json:1:26: /mode: found \"tigth\", expected a fit. Did you mean 'tight'?");
  EXPECT_EQ(error_of([&] { d.root().require("fit", "a technique"); }),
            "f.json:1:1: /: found no key \"fit\", expected it in a technique.");
}

TEST(JsonSet, ReplacesAddsAndAppends) {
  JsonDocument d = parse(R"({"a": [1, 2], "s": 3})");
  d.set("/a/0=9");
  d.set("/a/-=10");
  d.set("/m/n=word");
  d.set("/s=[true]");
  EXPECT_EQ(d.json(), nlohmann::json::parse(R"({"a":[9,2,10],"m":{"n":"word"},"s":[true]})"));
}

TEST(JsonSet, ErrorsPointToTheAssignment) {
  JsonDocument d = parse(R"({"a": [1, 2], "s": 3})");
  d.set("/s=[\"x\"]");
  EXPECT_EQ(error_of([&] { d.root().require("s", "").items()[0].integer(); }),
            "--set '/s=[\"x\"]': /s/0: found \"x\", expected an integer.");
  EXPECT_EQ(error_of([&] { d.set("a=1"); }),
            "--set 'a=1': expected /pointer=value, for example /mask_size=[8,16].");
  EXPECT_EQ(error_of([&] { d.set("/a/5=1"); }), "--set '/a/5=1': '5' is no index of the array /a of 2.");
  EXPECT_EQ(error_of([&] { d.set("/a=[1"); }), "--set '/a=[1': the value is not JSON.");
  EXPECT_EQ(error_of([&] { d.set("/a/0/x=1"); }), "--set '/a/0/x=1': /a/0 is 1, which has no members.");
}

}  // namespace
}  // namespace penumbra
