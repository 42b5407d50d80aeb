// The scanner behind JsonDocument: structure and places by hand, strings and numbers by nlohmann's parser.
#pragma once
#include <map>
#include <nlohmann/json.hpp>
#include <string>

namespace penumbra {

struct TextPosition {
  int line = 1, column = 1;  // columns count characters, not bytes
};
struct JsonPlaces {
  TextPosition key, value;  // key: of a member's name; the value's own place elsewhere
};
using PositionMap = std::map<std::string, JsonPlaces>;  // by JSON pointer

// Throws InputError "name:line:column: ..." at the first syntax error or duplicate key.
nlohmann::json scan_json(const std::string& text, const std::string& name, PositionMap& positions);

}  // namespace penumbra
