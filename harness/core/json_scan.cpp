#include "core/json_scan.h"

#include <fmt/format.h>

#include <cctype>

#include "core/error.h"
#include "core/json_text.h"

namespace penumbra {
namespace {

using nlohmann::json;

constexpr int max_depth = 256;  // recursion: a hostile file must not end in a stack overflow

class Scanner {
 public:
  Scanner(const std::string& text, const std::string& name, PositionMap& positions)
      : text_(text), name_(name), positions_(positions) {}

  json document() {
    if (text_.starts_with("\xef\xbb\xbf")) at_ = 3;  // a byte order mark is no content
    skip_blank();
    if (done()) fail("found an empty file, expected a JSON value.");
    json value = this->value("", position(), 0);
    skip_blank();
    if (!done()) fail(fmt::format("found {} after the end of the JSON value, expected nothing.", here()));
    return value;
  }

 private:
  bool done() const { return at_ >= text_.size(); }
  char peek() const { return done() ? '\0' : text_[at_]; }

  // Line and column are carried along, each byte looked at once.
  TextPosition position() {
    for (; counted_ < at_; ++counted_) {
      const auto byte = static_cast<unsigned char>(text_[counted_]);
      if (byte == '\n')
        ++line_, column_ = 1;
      else if ((byte & 0xc0U) != 0x80U && !(byte == 0xef && text_.compare(counted_, 3, "\xef\xbb\xbf") == 0))
        ++column_;
    }
    return {line_, column_};
  }

  [[noreturn]] void fail_at(TextPosition p, const std::string& message) const {
    throw InputError(fmt::format("{}:{}:{}: {}", name_, p.line, p.column, message));
  }
  [[noreturn]] void fail(const std::string& message) { fail_at(position(), message); }

  std::string here() const {
    if (done()) return "the end of the file";
    const auto byte = static_cast<unsigned char>(peek());
    return byte >= 0x20 && byte < 0x7f ? fmt::format("'{}'", peek()) : fmt::format("the byte 0x{:02x}", byte);
  }

  void skip_blank() {
    while (!done()) {
      if (std::string_view(" \t\r\n").find(peek()) != std::string_view::npos) {
        ++at_;
      } else if (text_.compare(at_, 2, "//") == 0) {
        at_ = std::min(text_.find('\n', at_), text_.size());
      } else if (text_.compare(at_, 2, "/*") == 0) {
        const std::size_t end = text_.find("*/", at_ + 2);
        if (end == std::string::npos) fail("found a comment without an end, expected '*/'.");
        at_ = end + 2;
      } else {
        return;
      }
    }
  }

  json value(const std::string& pointer, TextPosition key, int depth) {
    if (depth > max_depth) fail(fmt::format("found more than {} levels of nesting.", max_depth));
    const TextPosition p = position();
    positions_[pointer] = {depth == 0 ? p : key, p};
    if (peek() == '{') return object(pointer, depth);
    if (peek() == '[') return array(pointer, depth);
    if (peek() == '"') return string();
    return word();
  }

  json object(const std::string& pointer, int depth) {
    json out = json::object();
    ++at_;
    for (bool first = true;; first = false) {
      skip_blank();
      if (first && peek() == '}') break;
      const TextPosition p = position();
      if (peek() == '}')
        fail("found '}' after a comma, expected another \"key\" (a trailing comma is not JSON).");
      if (peek() != '"') fail(fmt::format("found {}, expected a \"key\"{}.", here(), first ? " or '}'" : ""));
      const std::string name = string().get<std::string>(), member = pointer + "/" + pointer_token(name);
      if (const auto it = positions_.find(member); it != positions_.end())
        fail_at(p, fmt::format("{}: found this key a second time, expected it once (first at line {}).",
                               member, it->second.key.line));
      skip_blank();
      if (peek() != ':') fail(fmt::format("found {}, expected ':' after the key \"{}\".", here(), name));
      ++at_;
      skip_blank();
      out[name] = value(member, p, depth + 1);
      skip_blank();
      if (peek() == '}') break;
      if (peek() != ',') fail(fmt::format("found {}, expected ',' or '}}'.", here()));
      ++at_;
    }
    ++at_;
    return out;
  }

  json array(const std::string& pointer, int depth) {
    json out = json::array();
    ++at_;
    for (bool first = true;; first = false) {
      skip_blank();
      if (first && peek() == ']') break;
      if (peek() == ']')
        fail("found ']' after a comma, expected another value (a trailing comma is not JSON).");
      const std::string element = pointer + "/" + std::to_string(out.size());
      out.push_back(value(element, position(), depth + 1));
      skip_blank();
      if (peek() == ']') break;
      if (peek() != ',') fail(fmt::format("found {}, expected ',' or ']'.", here()));
      ++at_;
    }
    ++at_;
    return out;
  }

  json string() {
    const TextPosition p = position();
    std::size_t end = at_ + 1;
    while (end < text_.size() && text_[end] != '"' && text_[end] != '\n') end += text_[end] == '\\' ? 2U : 1U;
    if (end >= text_.size() || text_[end] != '"')
      fail_at(p, "found a string without an end, expected '\"' on the same line.");
    json out = scalar(text_.substr(at_, end + 1 - at_), p, "a string", "valid UTF-8 and escapes");
    at_ = end + 1;
    return out;
  }

  // A number or true, false, null: everything up to the next delimiter.
  json word() {
    const TextPosition p = position();
    std::size_t end = at_;
    while (end < text_.size() &&
           std::string_view(" \t\r\n,:[]{}\"/").find(text_[end]) == std::string_view::npos)
      ++end;
    if (end == at_) fail(fmt::format("found {}, expected a value.", here()));
    json out = scalar(text_.substr(at_, end - at_), p, "", "a value");
    at_ = end;
    return out;
  }

  json scalar(const std::string& token, TextPosition p, const std::string& what,
              const std::string& expected) const {
    json out = json(json::value_t::discarded);
    try {
      out = json::parse(token);
    } catch (const json::out_of_range&) {  // 1e999
      fail_at(p, fmt::format("found {}, expected a number that a double can hold.", token));
    } catch (const json::parse_error&) {
    }
    if (out.is_discarded())
      fail_at(p, fmt::format("found {}, expected {}.{}",
                             what.empty() ? printable(token) : what + " that is not valid", expected,
                             what.empty() && std::isalpha(static_cast<unsigned char>(token[0])) != 0
                                 ? " Strings stand in double quotes."
                                 : ""));
    return out;
  }

  static std::string printable(const std::string& token) {
    std::string out;
    for (const char c : token.substr(0, 40)) out += c >= 0x20 && c < 0x7f ? c : '?';
    return out;
  }

  const std::string& text_;
  const std::string& name_;
  PositionMap& positions_;
  std::size_t at_ = 0, counted_ = 0;
  int line_ = 1, column_ = 1;
};

}  // namespace

json scan_json(const std::string& text, const std::string& name, PositionMap& positions) {
  return Scanner(text, name, positions).document();
}

}  // namespace penumbra
