#include "run/latex.h"

#include <fmt/format.h>

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>
#include <set>

namespace penumbra::run {
namespace {

using nlohmann::json;

bool is_result(const json& point) { return !point.at("frame").is_null(); }

std::string value_text(const json& value) {
  if (value.is_null()) return "";
  if (value.is_string()) return value.get<std::string>();
  if (value.is_array() && value.size() == 2) return value_text(value[0]) + " x " + value_text(value[1]);
  return value.dump();
}

std::optional<double> number_of(const json& point, const char* group, const char* name) {
  const auto at = point.find(group);
  if (at == point.end() || !at->is_object() || !at->contains(name) || !at->at(name).is_number())
    return std::nullopt;
  return at->at(name).get<double>();
}

// Three digits, as the eye compares them; exponents as LaTeX has them.
std::string number_text(std::optional<double> value) {
  if (!value) return "--";
  if (*value == 0) return "$0$";
  const double size = std::abs(*value);
  if (size >= 1e-3 && size < 1e5)
    return fmt::format("${:.{}f}$", *value, size >= 100 ? 0 : size >= 10 ? 1 : size >= 1 ? 2 : 4);
  const int exponent = static_cast<int>(std::floor(std::log10(size)));
  return fmt::format("${:.1f} \\cdot 10^{{{}}}$", *value / std::pow(10.0, exponent), exponent);
}

struct Columns {
  bool scene = false, frame = false;
  std::vector<std::string> params;
};

// Parameters that take several values among the points of one technique in one scene: they tell the rows
// apart.
Columns varying_columns(const RecordSource& source) {
  std::map<std::string, std::map<std::string, std::set<std::string>>> seen;
  std::set<std::string> scenes, frames, varying;
  source([&](const json& p) {
    if (!is_result(p)) return;
    scenes.insert(p.at("scene")), frames.insert(p.at("frame").dump());
    const std::string group = p.at("technique").get<std::string>() + '\n' + p.at("scene").get<std::string>();
    for (const auto& [name, value] : p.at("params").items()) seen[group][name].insert(value.dump());
  });
  for (const auto& [group, params] : seen)
    for (const auto& [name, values] : params)
      if (values.size() > 1) varying.insert(name);
  return {scenes.size() > 1, frames.size() > 1, {varying.begin(), varying.end()}};
}

std::string time_text(const json& point) {
  const json& stat = point.at("timing").at("frame_ms");
  const auto text = [](const json& v) {
    const std::string t = number_text(v.get<double>());
    return t.substr(1, t.size() - 2);
  };
  return fmt::format("${}$ & $[{}, {}]$", text(stat.at("median")), text(stat.at("ci95")[0]),
                     text(stat.at("ci95")[1]));
}

std::string row(const json& p, const Columns& columns) {
  std::string text = latex_text(p.at("technique"));
  if (columns.scene) text += " & " + latex_text(p.at("scene"));
  if (columns.frame) text += " & " + p.at("frame").dump();
  for (const std::string& name : columns.params)
    text += " & " + (p.at("params").contains(name) ? latex_text(value_text(p.at("params").at(name))) : "");
  if (p.at("status") != "ok")
    return text +
           fmt::format(" & \\multicolumn{{5}}{{l}}{{\\emph{{{}}}}} \\\\\n", latex_text(p.at("status")));
  return text + fmt::format(" & {} & {} & {} & {} \\\\\n", time_text(p),
                            number_text(number_of(p, "metrics", "rmse")),
                            number_text(number_of(p, "metrics", "flip")),
                            number_text(number_of(p, "metrics_matched", "mask_bit_mismatch")));
}

struct Mark {
  double ms, error;
};

std::string axis(const std::string& scene, const std::map<std::string, std::vector<Mark>>& techniques) {
  std::string text = fmt::format(
      "\\begin{{tikzpicture}}\n\\begin{{axis}}[title={{{}}}, xmode=log, ymode=log, xlabel={{frame time "
      "[ms]}}, "
      "ylabel={{error of visibility}},\n  legend style={{at={{(1.03,1)}}, anchor=north west, font=\\small}}, "
      "cycle list name=color list]\n",
      latex_text(scene));
  for (const auto& [technique, marks] : techniques) {
    text += "\\addplot+[only marks] coordinates {";
    for (const Mark& m : marks) text += fmt::format(" ({:.6g},{:.6g})", m.ms, m.error);
    text += fmt::format(" }};\n\\addlegendentry{{{}}}\n", latex_text(technique));
  }
  return text + "\\end{axis}\n\\end{tikzpicture}\n";
}

}  // namespace

std::string latex_text(const std::string& text) {
  std::string out;
  for (const char c : text) {
    if (std::string("&%$#_{}").find(c) != std::string::npos)
      out += std::string("\\") + c;
    else if (c == '~' || c == '^')
      out += std::string("\\") + c + "{}";
    else if (c == '\\')
      out += "\\textbackslash{}";
    else
      out += static_cast<unsigned char>(c) < 0x20 ? ' ' : c;
  }
  return out;
}

std::string latex_table(const RecordSource& source) {
  const Columns columns = varying_columns(source);
  std::string names = "technique", spec = "l";
  const auto add = [&](const std::string& name, char align) { names += " & " + name, spec += align; };
  if (columns.scene) add("scene", 'l');
  if (columns.frame) add("frame", 'r');
  for (const std::string& name : columns.params) add(latex_text(name), 'r');
  add("frame [ms]", 'r'), add("95\\,\\% interval", 'l'), add("RMSE", 'r'), add("FLIP", 'r'),
      add("mask bits off", 'r');
  std::string text = "% needs \\usepackage{booktabs}\n\\begin{tabular}{" + spec + "}\n\\toprule\n" + names +
                     " \\\\\n\\midrule\n";
  source([&](const json& p) {
    if (is_result(p)) text += row(p, columns);
  });
  return text + "\\bottomrule\n\\end{tabular}\n";
}

std::string pgfplots_figure(const RecordSource& source) {
  std::map<std::string, std::map<std::string, std::vector<Mark>>> scenes;
  source([&](const json& p) {
    if (!is_result(p) || p.at("status") != "ok") return;
    auto error = number_of(p, "metrics", "rmse");
    if (!error) error = number_of(p, "metrics_matched", "mae");
    const double ms = p.at("timing").at("frame_ms").at("median");
    // What is exact has no place on a logarithmic axis.
    if (error && *error > 0 && ms > 0) scenes[p.at("scene")][p.at("technique")].push_back({ms, *error});
  });
  std::string text = "% needs \\usepackage{pgfplots} and \\pgfplotsset{compat=1.16}\n";
  for (const auto& [scene, techniques] : scenes) text += axis(scene, techniques);
  return text;
}

std::string latex_document(const std::string& fragment) {
  return "\\documentclass{article}\n\\usepackage[margin=1cm,landscape]{geometry}\n\\usepackage{booktabs}\n"
         "\\usepackage{pgfplots}\n\\pgfplotsset{compat=1.16}\n\\begin{document}\n\\small\\noindent\n" +
         fragment + "\\end{document}\n";
}

}  // namespace penumbra::run
