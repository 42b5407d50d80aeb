// The report in a real browser, driven by selftest.js.
#include "browser.h"

#include <gtest/gtest.h>

#include "report/report.h"
#include "scratch_folder.h"
#include "synthetic_run.h"

namespace penumbra {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;
using test::expect_all;
using test::ScratchFolder;

json selftest(const fs::path& report, const fs::path& profile) {
  return test::selftest(report, profile, "tests/report/selftest.js");
}

TEST(ReportInBrowser, SortsFiltersFlicksAndZooms) {
  ScratchFolder scratch;
  test::write_synthetic_run(scratch / "run");
  write_report(scratch / "run", scratch / "report");
  const json outcome = selftest(scratch / "report", scratch / "profile");
  expect_all(outcome);
  EXPECT_GE(outcome["checks"].size(), 30u);
}

TEST(ReportInBrowser, PlaysSequencesAndShowsDiagnostics) {
  ScratchFolder scratch;
  test::write_moving_run(scratch / "run", 12);
  write_report(scratch / "run", scratch / "report");
  expect_all(test::selftest(scratch / "report", scratch / "profile", "tests/report/moving_selftest.js"));
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
