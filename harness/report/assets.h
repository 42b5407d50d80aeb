// The files of harness/report/assets, embedded at build time.
#pragma once
#include <span>
#include <string_view>

namespace penumbra {

struct Asset {
  std::string_view name;  // "report.css"
  std::string_view content;
};
std::span<const Asset> report_assets();
// The named asset's content; the name must exist.
std::string_view report_asset(std::string_view name);

}  // namespace penumbra
