#include "core/json_text.h"

#include <fmt/format.h>

#include <cmath>
#include <fstream>
#include <map>
#include <sstream>

#include "core/json_scan.h"

namespace penumbra {

using nlohmann::json;

struct JsonDocument::Impl {
  std::string name;
  nlohmann::json root;
  PositionMap positions;
  std::map<std::string, std::string> assignments;  // pointer -> the `--set` text that brought it in

  std::string place(TextPosition p) const { return fmt::format("{}:{}:{}", name, p.line, p.column); }
  std::string find(std::string pointer, bool key) const;
};

namespace {

std::string parent(const std::string& pointer) { return pointer.substr(0, pointer.rfind('/')); }

std::vector<std::string> split(const std::string& pointer) {
  std::vector<std::string> tokens;
  for (std::size_t at = 0; at < pointer.size();) {
    const std::size_t end = std::min(pointer.find('/', at + 1), pointer.size());
    std::string token = pointer.substr(at + 1, end - at - 1), plain;
    for (std::size_t i = 0; i < token.size(); ++i)
      if (token[i] == '~' && i + 1 < token.size() && (token[i + 1] == '0' || token[i + 1] == '1'))
        plain += token[++i] == '0' ? '~' : '/';
      else
        plain += token[i];
    tokens.push_back(plain);
    at = end;
  }
  return tokens;
}

json bare_or_json(const std::string& text) {
  json value = json::parse(text, nullptr, false);
  if (!value.is_discarded()) return value;
  const bool word = !text.empty() && text.find_first_of("[]{}\",:") == std::string::npos;
  return word ? json(text) : json(json::value_t::discarded);
}

std::string quoted(const std::string& s) {
  const std::string shown = s.size() > 60 ? s.substr(0, 57) + "..." : s;
  return json(shown).dump(-1, ' ', false, json::error_handler_t::replace);
}

}  // namespace

std::string pointer_token(const std::string& key) {
  std::string out;
  for (const char c : key) out += c == '~' ? "~0" : c == '/' ? "~1" : std::string(1, c);
  return out;
}

std::string describe_json(const json& value) {
  if (value.is_object())
    return value.empty() ? "an empty object" : fmt::format("an object of {}", value.size());
  if (value.is_array()) {
    const std::string text = value.dump(-1, ' ', false, json::error_handler_t::replace);
    return value.empty()       ? "an empty array"
           : text.size() <= 40 ? text
                               : fmt::format("an array of {}", value.size());
  }
  if (value.is_string()) return quoted(value.get_ref<const std::string&>());
  return value.dump();
}

std::string JsonDocument::Impl::find(std::string pointer, bool key) const {
  for (;; pointer = parent(pointer), key = false) {
    if (const auto it = assignments.find(pointer); it != assignments.end())
      return "--set '" + it->second + "'";
    if (const auto it = positions.find(pointer); it != positions.end())
      return place(key ? it->second.key : it->second.value);
    if (pointer.empty()) return name;
  }
}

JsonDocument JsonDocument::read(const std::filesystem::path& path) {
  std::error_code error;
  if (!std::filesystem::exists(path, error)) throw InputError(path.string() + ": no such file.");
  if (std::filesystem::is_directory(path, error))
    throw InputError(path.string() + ": found a folder, expected a JSON file.");
  std::ifstream in(path, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw InputError(path.string() + ": cannot be read.");
  return parse(text.str(), path.string());
}

JsonDocument JsonDocument::parse(const std::string& text, const std::string& name) {
  JsonDocument document;
  document.impl_ = std::make_shared<Impl>();
  document.impl_->name = name;
  document.impl_->root = scan_json(text, name, document.impl_->positions);
  return document;
}

const std::string& JsonDocument::name() const { return impl_->name; }
const json& JsonDocument::json() const { return impl_->root; }
JsonNode JsonDocument::root() const { return {*this, &impl_->root, ""}; }
std::string JsonDocument::location(const std::string& pointer) const { return impl_->find(pointer, false); }
std::string JsonDocument::key_location(const std::string& pointer) const {
  return impl_->find(pointer, true);
}

void JsonDocument::set(const std::string& assignment) {
  const auto reject = [&](const std::string& why) { throw InputError("--set '" + assignment + "': " + why); };
  const std::size_t equals = assignment.find('=');
  if (equals == std::string::npos || assignment.empty() || assignment[0] != '/')
    reject("expected /pointer=value, for example /mask_size=[8,16].");
  const std::string pointer = assignment.substr(0, equals);
  const nlohmann::json value = bare_or_json(assignment.substr(equals + 1));
  if (value.is_discarded()) reject("the value is not JSON.");
  nlohmann::json* at = &impl_->root;
  std::string path;
  for (const std::string& token : split(pointer)) {
    if (at->is_null()) *at = nlohmann::json::object();
    if (at->is_object()) {
      at = &(*at)[token];
    } else if (at->is_array()) {
      const bool digits =
          !token.empty() && token.size() < 9 && token.find_first_not_of("0123456789") == std::string::npos;
      const std::size_t index = token == "-" ? at->size() : digits ? std::stoul(token) : at->size() + 1;
      if (index > at->size())
        reject(fmt::format("'{}' is no index of the array {} of {}.", token, path, at->size()));
      if (index == at->size()) at->push_back(nullptr);
      at = &(*at)[index];
      path += fmt::format("/{}", index);
      continue;
    } else {
      reject(fmt::format("{} is {}, which has no members.", path.empty() ? "the root" : path,
                         describe_json(*at)));
    }
    path += "/" + pointer_token(token);
  }
  *at = value;
  // What stood below the replaced value is gone, and its places with it.
  std::erase_if(impl_->positions, [&](const auto& entry) { return entry.first.starts_with(path + "/"); });
  std::erase_if(impl_->assignments, [&](const auto& entry) { return entry.first.starts_with(path + "/"); });
  impl_->assignments[path] = assignment;
}

JsonNode JsonNode::child(const std::string& token, const nlohmann::json& value) const {
  return {document_, &value, pointer_ + "/" + pointer_token(token)};
}

void JsonNode::complain(const std::string& message) const {
  throw InputError(fmt::format("{}: {}: {}", location(), pointer_.empty() ? "/" : pointer_, message));
}

void JsonNode::fail(const std::string& expected, const std::string& hint) const {
  complain(fmt::format("found {}, expected {}.{}", describe_json(*value_), expected, hint));
}

void JsonNode::allow_only(const std::vector<std::string>& keys, const std::string& what) const {
  if (!is_object()) fail("an object: " + what);
  for (const auto& [key, value] : value_->items()) {
    bool known = false;
    for (const std::string& k : keys) known = known || k == key;
    if (known) continue;
    const std::string at = pointer_ + "/" + pointer_token(key);
    throw InputError(fmt::format("{}: {}: found the key {}, expected a key of {}.{}",
                                 document_.key_location(at), at, quoted(key), what, suggestion(key, keys)));
  }
}

bool JsonNode::has(const std::string& key) const { return find(key).has_value(); }

std::optional<JsonNode> JsonNode::find(const std::string& key) const {
  if (!is_object()) fail("an object");
  const auto it = value_->find(key);
  if (it == value_->end()) return std::nullopt;
  return child(key, *it);
}

JsonNode JsonNode::require(const std::string& key, const std::string& what) const {
  if (auto node = find(key)) return *node;
  complain(fmt::format("found no key \"{}\", expected it in {}.", key, what));
}

std::vector<std::pair<std::string, JsonNode>> JsonNode::members() const {
  if (!is_object()) fail("an object");
  std::vector<std::pair<std::string, JsonNode>> out;
  for (const auto& [key, value] : value_->items()) out.emplace_back(key, child(key, value));
  return out;
}

std::vector<JsonNode> JsonNode::items() const {
  if (!is_array()) fail("an array");
  std::vector<JsonNode> out;
  for (std::size_t i = 0; i < value_->size(); ++i) out.push_back(child(std::to_string(i), (*value_)[i]));
  return out;
}

std::vector<JsonNode> JsonNode::list_or_one() const {
  return is_array() ? items() : std::vector<JsonNode>{*this};
}

bool JsonNode::boolean() const {
  if (!value_->is_boolean()) fail("true or false");
  return value_->get<bool>();
}

int64_t JsonNode::integer(int64_t lo, int64_t hi) const {
  const auto reject = [&] {
    const bool bounded =
        lo != std::numeric_limits<int64_t>::min() || hi != std::numeric_limits<int64_t>::max();
    fail(!bounded                                    ? std::string("an integer")
         : hi == std::numeric_limits<int64_t>::max() ? fmt::format("an integer of at least {}", lo)
                                                     : fmt::format("an integer from {} to {}", lo, hi));
  };
  int64_t v = 0;
  if (value_->is_number_unsigned() && value_->get<uint64_t>() > uint64_t(std::numeric_limits<int64_t>::max()))
    reject();
  if (value_->is_number_integer()) {
    v = value_->get<int64_t>();
  } else {
    const double d = value_->is_number_float() ? value_->get<double>() : 0.5;
    if (d != std::floor(d) || std::abs(d) > 9e15) reject();
    v = static_cast<int64_t>(d);
  }
  if (v < lo || v > hi) reject();
  return v;
}

double JsonNode::number(double lo, double hi) const {
  constexpr double most = std::numeric_limits<double>::max();
  if (const double v = value_->is_number() ? value_->get<double>() : NAN; v >= lo && v <= hi) return v;
  fail(lo == -most && hi == most ? std::string("a number")
       : hi == most              ? fmt::format("a number of at least {}", lo)
                                 : fmt::format("a number from {} to {}", lo, hi));
}

std::string JsonNode::string() const {
  if (!value_->is_string()) fail("a string");
  return value_->get<std::string>();
}

std::string JsonNode::choice(const std::vector<std::string>& choices, const std::string& what) const {
  if (is_string())
    for (const std::string& c : choices)
      if (c == value_->get_ref<const std::string&>()) return c;
  fail(what,
       is_string() ? suggestion(string(), choices) : fmt::format(" Valid: {}.", fmt::join(choices, ", ")));
}

std::vector<double> JsonNode::numbers(std::size_t count) const {
  if (!is_array() || value_->size() != count) fail(fmt::format("an array of {} numbers", count));
  std::vector<double> out;
  for (const JsonNode& n : items()) out.push_back(n.number());
  return out;
}

}  // namespace penumbra
