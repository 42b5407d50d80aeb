#include "technique/params.h"

#include <fmt/format.h>

#include <cmath>

namespace penumbra {

double decimal(float value) { return std::stod(fmt::format("{}", value)); }

std::string expectation(const ParamInfo& info) {
  switch (info.type) {
    case ParamType::boolean:
      return "true or false";
    case ParamType::integer:
      return fmt::format("an integer from {} to {}", info.lo, info.hi);
    case ParamType::number:
      return fmt::format("a number from {} to {}", info.lo, info.hi);
    case ParamType::choice:
      return fmt::format("one of {}", fmt::join(info.choices, ", "));
  }
  return "";
}

namespace {

[[noreturn]] void reject(const ParamInfo& info, const ParamValue& value) {
  std::string message =
      fmt::format("parameter '{}' is {}, expected {}.", info.name, to_text(value), expectation(info));
  if (const auto* text = std::get_if<std::string>(&value); text && info.type == ParamType::choice)
    if (const std::string near = nearest_name(*text, info.choices); !near.empty())
      message += " Did you mean '" + near + "'?";
  throw InputError(message);
}

}  // namespace

std::string to_text(const ParamValue& value) {
  if (const bool* b = std::get_if<bool>(&value)) return *b ? "true" : "false";
  if (const int64_t* i = std::get_if<int64_t>(&value)) return fmt::format("{}", *i);
  if (const double* d = std::get_if<double>(&value)) return fmt::format("{}", *d);
  return std::get<std::string>(value);
}

ParamValue checked(const ParamInfo& info, const ParamValue& value) {
  ParamValue v = value;
  if (info.type == ParamType::number)
    if (const int64_t* i = std::get_if<int64_t>(&v)) v = static_cast<double>(*i);
  if (info.type == ParamType::integer)
    if (const double* d = std::get_if<double>(&v); d && *d == std::floor(*d) && std::abs(*d) < 9e15)
      v = static_cast<int64_t>(*d);
  const auto in_range = [&](double x) { return x >= info.lo && x <= info.hi; };  // false for NaN
  bool ok = false;
  switch (info.type) {
    case ParamType::boolean:
      ok = std::holds_alternative<bool>(v);
      break;
    case ParamType::integer:
      ok = std::holds_alternative<int64_t>(v) && in_range(double(std::get<int64_t>(v)));
      break;
    case ParamType::number:
      ok = std::holds_alternative<double>(v) && in_range(std::get<double>(v));
      break;
    case ParamType::choice:
      if (const auto* s = std::get_if<std::string>(&v))
        for (const std::string& c : info.choices) ok = ok || c == *s;
      break;
  }
  if (!ok) reject(info, value);
  return v;
}

ParamValues resolve(const std::vector<ParamInfo>& infos, const ParamValues& given, const std::string& where) {
  std::vector<std::string> names;
  for (const ParamInfo& info : infos) names.push_back(info.name);
  for (const auto& [name, value] : given) {
    bool known = false;
    for (const std::string& n : names) known = known || n == name;
    if (!known)
      throw InputError(fmt::format("{}: unknown parameter '{}'.{}", where, name, suggestion(name, names)));
  }
  ParamValues out;
  for (const ParamInfo& info : infos) {
    const auto it = given.find(info.name);
    try {
      out[info.name] = it == given.end() ? info.fallback : checked(info, it->second);
    } catch (const InputError& e) {
      throw InputError(where + ": " + e.what());
    }
  }
  return out;
}

}  // namespace penumbra
