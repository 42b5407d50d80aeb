// The page in a real browser, opened from disk: headless Chromium drives it with selftest.js and hands back
// the document.
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "report/report.h"
#include "scratch_folder.h"
#include "synthetic_run.h"

namespace penumbra {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;
using test::read_file;
using test::ScratchFolder;

std::string browser() {
  if (const char* named = std::getenv("CHROMIUM")) return named;
  for (const char* name :
       {"/usr/bin/chromium", "/usr/bin/chromium-browser", "/snap/bin/chromium", "/usr/bin/google-chrome"})
    if (fs::exists(name)) return name;
  return {};
}

// Runs the browser on `page` and returns what it prints: the document after all scripts.
std::string dump_document(const fs::path& page, const fs::path& profile) {
  const std::string program = browser();
  if (program.empty()) {
    ADD_FAILURE() << "no Chromium: install the package `chromium` (see scripts/packages.list), or name one "
                     "in $CHROMIUM";
    return {};
  }
  const std::string command =
      "timeout 120 " + program +
      " --headless --no-sandbox --disable-gpu --no-first-run --disable-background-networking "
      "--disable-component-update"
      " --disable-sync --disable-dev-shm-usage --virtual-time-budget=30000 --user-data-dir='" +
      profile.string() + "' --dump-dom 'file://" + page.string() + "' 2>'" + profile.string() + ".log'";
  std::FILE* pipe = popen(command.c_str(), "r");
  std::string document;
  std::array<char, 65536> buffer;
  while (const std::size_t n = std::fread(buffer.data(), 1, buffer.size(), pipe))
    document.append(buffer.data(), n);
  const int status = pclose(pipe);
  EXPECT_EQ(WEXITSTATUS(status), 0) << command << "\n" << read_file(profile.string() + ".log");
  return document;
}

// A copy of the report's page that runs selftest.js after the page's own scripts.
void add_selftest(const fs::path& report) {
  std::string page = read_file(report / "index.html");
  const std::string errors =
      "<script>window.page_errors = []; addEventListener('error', (e) => page_errors.push(String(e.message "
      "|| "
      "(e.target.src + ' was not loaded'))), true); addEventListener('unhandledrejection', (e) => "
      "page_errors.push(String(e.reason)));"
      "</script>";
  page.insert(page.find("<meta"), errors);
  page.insert(page.find("</head>"), "<script defer src=\"selftest.js\"></script>");
  std::ofstream(report / "selftest.html") << page;
  fs::copy_file("tests/report/selftest.js", report / "selftest.js");
}

json selftest(const fs::path& report, const fs::path& profile) {
  add_selftest(report);
  const std::string document = dump_document(report / "selftest.html", profile);
  const std::string start = "<pre id=\"selftest\">";
  const std::size_t at = document.find(start);
  if (at == std::string::npos) {
    ADD_FAILURE() << "the page's test did not end; the document begins with\n" << document.substr(0, 2000);
    return {};
  }
  const std::size_t begin = at + start.size();
  return json::parse(document.substr(begin, document.find("</pre>", begin) - begin));
}

void expect_all(const json& outcome) {
  EXPECT_EQ(outcome.value("errors", json()), json::array()) << outcome.dump(2);
  ASSERT_TRUE(outcome.contains("checks"));
  EXPECT_GT(outcome["checks"].size(), 0u);
  for (const json& check : outcome["checks"]) EXPECT_TRUE(check["ok"].get<bool>()) << check.dump();
}

TEST(ReportInBrowser, SortsFiltersFlicksAndZooms) {
  ScratchFolder scratch;
  test::write_synthetic_run(scratch / "run");
  write_report(scratch / "run", scratch / "report");
  const json outcome = selftest(scratch / "report", scratch / "profile");
  expect_all(outcome);
  EXPECT_GE(outcome["checks"].size(), 30u);
}

TEST(ReportInBrowser, ShowsARunWithoutPoints) {
  ScratchFolder scratch;
  test::write_large_run(scratch / "run", 0);
  write_report(scratch / "run", scratch / "report");
  expect_all(selftest(scratch / "report", scratch / "profile"));
}

TEST(ReportInBrowser, HoldsTenThousandPointsWithFewRowsInTheDocument) {
  ScratchFolder scratch;
  test::write_large_run(scratch / "run", 10000);
  write_report(scratch / "run", scratch / "report");
  const json outcome = selftest(scratch / "report", scratch / "profile");
  expect_all(outcome);
  EXPECT_EQ(outcome.value("points", 0), 10000);
  EXPECT_LT(outcome.value("rows_in_document", 10000), 120);
}

}  // namespace
}  // namespace penumbra
