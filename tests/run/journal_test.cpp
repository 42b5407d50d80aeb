#include "run/journal.h"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "run/files.h"
#include "tests/support/temporary_folder.h"

namespace penumbra::run {
namespace {

namespace fs = std::filesystem;
using Mode = Journal::Mode;

class JournalTest : public testing::Test {
 protected:
  test::TemporaryFolder temporary_;
  fs::path folder_ = temporary_ / "run";
  static nlohmann::json record(const std::string& id, const std::string& status, int value = 0) {
    return {{"id", id}, {"status", status}, {"value", value}, {"fingerprint", "f" + id}};
  }
  void append_raw(const std::string& text) {
    std::ofstream(folder_ / "points.jsonl", std::ios::app | std::ios::binary) << text;
  }
};

TEST_F(JournalTest, GivesBackWhatWasAppended) {
  {
    Journal j(folder_, Mode::fresh);
    j.append(record("a", "ok", 1));
    j.append(record("b", "failed", 2));
  }
  const Journal j(folder_, Mode::resume);
  ASSERT_EQ(j.entries().size(), 2U);
  EXPECT_EQ(j.find("b")->status, "failed");
  EXPECT_EQ(j.find("a")->fingerprint, "fa");
  EXPECT_EQ(nlohmann::json::parse(j.line(*j.find("a")))["value"], 1);
  EXPECT_TRUE(j.remarks().empty());
}

TEST_F(JournalTest, CountsAPointOnceAndItsLastRecordWins) {
  {
    Journal j(folder_, Mode::fresh);
    j.append(record("a", "failed", 1));
    j.append(record("a", "ok", 2));
  }
  const Journal j(folder_, Mode::resume);
  EXPECT_EQ(j.entries().size(), 1U);
  EXPECT_EQ(j.find("a")->status, "ok");
  int seen = 0;
  for_each_point(folder_, [&](const nlohmann::json& p) {
    ++seen;
    EXPECT_EQ(p["value"], 2);
  });
  EXPECT_EQ(seen, 1);
}

TEST_F(JournalTest, CutsATornLastLineAndSaysSo) {
  {
    Journal j(folder_, Mode::fresh);
    j.append(record("a", "ok"));
  }
  append_raw(R"({"id":"b","status":"o)");
  {
    Journal j(folder_, Mode::resume);
    EXPECT_EQ(j.entries().size(), 1U);
    ASSERT_EQ(j.remarks().size(), 1U);
    EXPECT_NE(j.remarks()[0].find("points.jsonl:2"), std::string::npos) << j.remarks()[0];
    j.append(record("b", "ok"));
  }
  const Journal again(folder_, Mode::resume);
  EXPECT_EQ(again.entries().size(), 2U);
  EXPECT_TRUE(again.remarks().empty());
}

TEST_F(JournalTest, PassesOverAGarbledLineInTheMiddle) {
  {
    Journal j(folder_, Mode::fresh);
    j.append(record("a", "ok"));
  }
  append_raw("\x01garbage\n{\"id\": 3, \"status\": \"ok\"}\n");
  {
    Journal j(folder_, Mode::resume);
    j.append(record("b", "ok"));
    EXPECT_EQ(j.remarks().size(), 2U);
  }
  const Journal j(folder_, Mode::resume);
  EXPECT_EQ(j.entries().size(), 2U);
}

TEST_F(JournalTest, RefusesAFolderThatHoldsResultsUnlessResuming) {
  { Journal(folder_, Mode::fresh).append(record("a", "ok")); }
  try {
    Journal j(folder_, Mode::fresh);
    FAIL() << "expected an InputError";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("--resume"), std::string::npos) << e.what();
  }
}

TEST_F(JournalTest, RefusesASecondRunInOneFolderAndNamesTheFirst) {
  const Journal first(folder_, Mode::fresh);
  try {
    Journal second(folder_, Mode::resume);
    FAIL() << "expected an InputError";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("process " + std::to_string(::getpid())), std::string::npos)
        << e.what();
  }
}

TEST_F(JournalTest, SaysWhenTheFolderCannotBeMade) {
  std::ofstream(temporary_ / "a-file") << "x";
  EXPECT_THROW(Journal(temporary_ / "a-file" / "below", Mode::fresh), WriteError);
}

// A file-size limit is the nearest thing to a full disk that needs no rights: write() then stops in mid-line.
TEST_F(JournalTest, TakesATornLineBackWhenTheDiskIsFull) {
  Journal j(folder_, Mode::fresh);
  j.append(record("a", "ok"));
  const auto size = fs::file_size(folder_ / "points.jsonl");
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  rlimit tight = old;
  tight.rlim_cur = size + 20;
  setrlimit(RLIMIT_FSIZE, &tight);
  EXPECT_THROW(j.append(record("b", "ok")), WriteError);
  setrlimit(RLIMIT_FSIZE, &old);
  EXPECT_EQ(fs::file_size(folder_ / "points.jsonl"), size);
  j.append(record("c", "ok"));
  EXPECT_EQ(j.entries().size(), 2U);
  EXPECT_EQ(nlohmann::json::parse(j.line(*j.find("c")))["id"], "c");
}

}  // namespace
}  // namespace penumbra::run
