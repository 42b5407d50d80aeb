#include "report/page.h"

#include <algorithm>
#include <cassert>
#include <nlohmann/json.hpp>

#include "report/assets.h"

namespace penumbra {
namespace {

constexpr std::string_view generator = "<meta name=\"generator\" content=\"penumbra report\">";

void replace_all(std::string& text, std::string_view from, std::string_view to) {
  for (std::size_t at = text.find(from); at != std::string::npos; at = text.find(from, at + to.size()))
    text.replace(at, from.size(), to);
}

std::string titled(std::string_view asset, std::string_view title) {
  std::string page(report_asset(asset));
  assert(is_report_page(page));
  replace_all(page, "{{title}}", escape_html(title));
  return page;
}

std::string script_of(bool (*wanted)(std::string_view name)) {
  std::string script = "\"use strict\";\n";
  for (const Asset& asset : report_assets())  // in the order in which CMakeLists.txt names them
    if (asset.name.ends_with(".js") && wanted(asset.name)) script += asset.content;
  return script;
}

}  // namespace

std::string_view report_asset(std::string_view name) {
  for (const Asset& asset : report_assets())
    if (asset.name == name) return asset.content;
  assert(!"no such asset");
  return {};
}

std::string escape_html(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string script_literal(const nlohmann::json& value) {
  std::string text = value.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
  replace_all(text, "<", "\\u003c");  // '<' occurs in JSON only within strings
  return text;
}

std::string index_html(std::string_view title) { return titled("template.html", title); }
std::string comparison_html(std::string_view title) { return titled("comparison.html", title); }

std::string report_script() {
  return script_of([](std::string_view name) { return !name.starts_with("comparison"); });
}

std::string comparison_script() {
  return script_of([](std::string_view name) {
    constexpr std::string_view shared[] = {"model.js", "format.js", "svg.js", "error_map.js",
                                           "zoom.js",  "stage.js",  "rows.js"};
    return name.starts_with("comparison") || std::ranges::find(shared, name) != std::end(shared);
  });
}

std::string report_style() { return std::string(report_asset("report.css")); }

std::string data_script(const nlohmann::json& data) {
  const nlohmann::json styles = nlohmann::json::parse(report_asset("techniques.json"));
  // Browsers read large data from a string of JSON in half the time of the same data as an expression.
  std::string text = script_literal(data);
  replace_all(text, "\\", "\\\\");
  replace_all(text, "'", "\\'");
  return "window.penumbra_styles = " + script_literal(styles) + ";\nwindow.penumbra_data = JSON.parse('" +
         text + "');\n";
}

bool is_report_page(std::string_view html) { return html.find(generator) != std::string_view::npos; }

}  // namespace penumbra
