#include "browser.h"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <array>
#include <cstdio>
#include <cstdlib>

#include "scratch_folder.h"

namespace penumbra::test {
namespace fs = std::filesystem;
using nlohmann::json;
namespace {

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
void add_selftest(const fs::path& report, const fs::path& script) {
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
  fs::copy_file(script, report / "selftest.js");
}

}  // namespace

json selftest(const fs::path& report, const fs::path& profile, const fs::path& script) {
  add_selftest(report, script);
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

}  // namespace penumbra::test
