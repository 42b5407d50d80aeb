// The page's files as text.
#pragma once
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <string_view>

namespace penumbra {

// For HTML text and attribute values.
std::string escape_html(std::string_view text);
// JSON as a JavaScript expression that may stand in any script, inline ones included: ASCII only, no '<'.
// Bytes that are not UTF-8 become U+FFFD.
std::string script_literal(const nlohmann::json& value);

std::string index_html(std::string_view title);
std::string report_script();
// The page of two runs side by side, and its script.
std::string comparison_html(std::string_view title);
std::string comparison_script();
std::string report_style();
// `data`: { "run", "points", "pictures" }; of two runs { "comparison", "points", "pictures" }.
std::string data_script(const nlohmann::json& data);
// True for an index.html that index_html() has made.
bool is_report_page(std::string_view html);

}  // namespace penumbra
