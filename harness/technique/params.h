// Parameters described once: default, range, unit, the paper's symbol and meaning stand in one table per
// technique and feed `describe`, validation, the schema and the technique's own struct.
#pragma once
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <variant>
#include <vector>

#include "core/error.h"

namespace penumbra {

using ParamValue = std::variant<bool, int64_t, double, std::string>;
using ParamValues = std::map<std::string, ParamValue>;

enum class ParamType { boolean, integer, number, choice };

struct ParamInfo {
  std::string name;
  ParamType type = ParamType::integer;
  ParamValue fallback;
  double lo = 0, hi = 0;             // integer, number: inclusive range
  std::vector<std::string> choices;  // choice
  std::string unit, symbol, help;    // symbol: as the source writes it, may be empty
  bool axis = false;                 // also a top-level sweep axis of this name (grid_size)
  bool cost = false;                 // larger is dearer: weighs the progress bar
};

std::string to_text(const ParamValue& value);
// The double with the float's shortest decimal text: 0.1f gives 0.1, not 0.10000000149.
double decimal(float value);
// "an integer from 1 to 256", "one of a, b": the middle of an error message.
std::string expectation(const ParamInfo& info);
// The value as `info` types it (an integer is a number too); throws InputError saying what was expected.
ParamValue checked(const ParamInfo& info, const ParamValue& value);
// Defaults filled in, values checked, unknown names rejected with the nearest valid one. `where` opens the
// message.
ParamValues resolve(const std::vector<ParamInfo>& infos, const ParamValues& given, const std::string& where);

// Ties ParamInfo entries to the fields of a technique's parameter struct P.
template <class P>
class ParamTable {
 public:
  struct Text {
    std::string unit, symbol, help;
  };
  ParamTable& boolean(const char* name, bool P::*field, Text t) {
    add({name, ParamType::boolean, ParamValue(P{}.*field), 0, 1, {}, t.unit, t.symbol, t.help},
        [field](P& p, const ParamValue& v) { p.*field = std::get<bool>(v); });
    return *this;
  }
  ParamTable& integer(const char* name, int P::*field, int lo, int hi, Text t) {
    add({name,
         ParamType::integer,
         ParamValue(int64_t{P{}.*field}),
         double(lo),
         double(hi),
         {},
         t.unit,
         t.symbol,
         t.help},
        [field](P& p, const ParamValue& v) { p.*field = static_cast<int>(std::get<int64_t>(v)); });
    return *this;
  }
  ParamTable& number(const char* name, float P::*field, double lo, double hi, Text t) {
    add({name, ParamType::number, ParamValue(decimal(P{}.*field)), lo, hi, {}, t.unit, t.symbol, t.help},
        [field](P& p, const ParamValue& v) { p.*field = static_cast<float>(std::get<double>(v)); });
    return *this;
  }
  // E: an enum class whose values are 0, 1, ... in the order of `choices`.
  template <class E>
  ParamTable& choice(const char* name, E P::*field, std::vector<std::string> choices, Text t) {
    ParamInfo info{name,
                   ParamType::choice,
                   choices.at(static_cast<std::size_t>(P{}.*field)),
                   0,
                   0,
                   choices,
                   t.unit,
                   t.symbol,
                   t.help};
    add(std::move(info), [field, choices](P& p, const ParamValue& v) {
      for (std::size_t i = 0; i < choices.size(); ++i)
        if (choices[i] == std::get<std::string>(v)) p.*field = static_cast<E>(i);
    });
    return *this;
  }
  // Marks the entry added last.
  ParamTable& axis() { return infos_.back().axis = true, *this; }
  ParamTable& cost() { return infos_.back().cost = true, *this; }

  const std::vector<ParamInfo>& infos() const { return infos_; }
  // From resolved values (see resolve()).
  P read(const ParamValues& values) const {
    P p{};
    for (std::size_t i = 0; i < infos_.size(); ++i)
      if (auto it = values.find(infos_[i].name); it != values.end())
        setters_[i](p, checked(infos_[i], it->second));
    return p;
  }

 private:
  void add(ParamInfo info, std::function<void(P&, const ParamValue&)> set) {
    infos_.push_back(std::move(info));
    setters_.push_back(std::move(set));
  }
  std::vector<ParamInfo> infos_;
  std::vector<std::function<void(P&, const ParamValue&)>> setters_;
};

}  // namespace penumbra
