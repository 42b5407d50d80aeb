// JSON files written by people: `//` and `/* */` comments allowed, duplicate keys are errors, and every value
// remembers where it stands, so that an error names file, line, column and JSON pointer.
#pragma once
#include <cstdint>
#include <filesystem>
#include <limits>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

#include "core/error.h"

namespace penumbra {

class JsonNode;

class JsonDocument {
 public:
  // Throws InputError: a file that cannot be read, or the place and kind of the first syntax error.
  static JsonDocument read(const std::filesystem::path& path);
  // `name` stands for the file in messages.
  static JsonDocument parse(const std::string& text, const std::string& name);

  const std::string& name() const;
  const nlohmann::json& json() const;
  JsonNode root() const;

  // "file:line:column" of the value at `pointer`; of its nearest ancestor when the value itself is not in the
  // text. For values that set() brought in: the assignment itself.
  std::string location(const std::string& pointer) const;
  // The same for the key of a member.
  std::string key_location(const std::string& pointer) const;

  // "/pointer=json": replaces or adds one value. Missing objects on the way are made; `-` appends to an
  // array. A value that is not JSON but a bare word is taken as a string. Nodes handed out before are invalid
  // after it.
  void set(const std::string& assignment);

 private:
  friend class JsonNode;
  struct Impl;
  std::shared_ptr<Impl> impl_;
};

// A value in a document. Readers throw InputError of the form
//   file:line:column: /pointer: found <what>, expected <what>.<hint>
class JsonNode {
 public:
  const nlohmann::json& json() const { return *value_; }
  const std::string& pointer() const { return pointer_; }
  std::string location() const { return document_.location(pointer_); }

  bool is_object() const { return value_->is_object(); }
  bool is_array() const { return value_->is_array(); }
  bool is_string() const { return value_->is_string(); }
  bool is_number() const { return value_->is_number(); }
  bool is_boolean() const { return value_->is_boolean(); }
  bool is_null() const { return value_->is_null(); }

  // Objects. All expect an object and say so. `what` names the object in messages ("a light", "the sweep
  // config").
  void allow_only(const std::vector<std::string>& keys,
                  const std::string& what) const;  // nearest name offered
  bool has(const std::string& key) const;
  std::optional<JsonNode> find(const std::string& key) const;
  JsonNode require(const std::string& key, const std::string& what) const;
  std::vector<std::pair<std::string, JsonNode>> members() const;

  // Arrays. items() expects an array; list_or_one() gives a single value as a list of one.
  std::vector<JsonNode> items() const;
  std::vector<JsonNode> list_or_one() const;

  // Scalars, checked. 4.0 is an integer; true is not a number.
  bool boolean() const;
  int64_t integer(int64_t lo = std::numeric_limits<int64_t>::min(),
                  int64_t hi = std::numeric_limits<int64_t>::max()) const;
  double number(double lo = -std::numeric_limits<double>::max(),
                double hi = std::numeric_limits<double>::max()) const;
  std::string string() const;  // any string, also ""
  std::string choice(const std::vector<std::string>& choices, const std::string& what) const;
  // An array of exactly `count` numbers.
  std::vector<double> numbers(std::size_t count) const;

  // "found <this value>, expected <expected>.<hint>"; hint as suggestion() makes it, may be empty.
  [[noreturn]] void fail(const std::string& expected, const std::string& hint = "") const;
  // Any other complaint about this value: "file:line:column: /pointer: <message>".
  [[noreturn]] void complain(const std::string& message) const;

 private:
  friend class JsonDocument;
  JsonNode(JsonDocument document, const nlohmann::json* value, std::string pointer)
      : document_(std::move(document)), value_(value), pointer_(std::move(pointer)) {}
  JsonNode child(const std::string& token, const nlohmann::json& value) const;
  JsonDocument document_;  // shared: keeps the text's positions alive
  const nlohmann::json* value_;
  std::string pointer_;
};

// One reference token of a JSON pointer, escaped (~ as ~0, / as ~1).
std::string pointer_token(const std::string& key);
// What a value is, for messages: `"abc"`, `12`, `an array of 3`, ... long strings are cut.
std::string describe_json(const nlohmann::json& value);

}  // namespace penumbra
