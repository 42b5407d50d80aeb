// The real supervisor and real worker processes, with a technique that fails on demand.
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <fstream>
#include <iterator>
#include <thread>

#include "core/error.h"
#include "run/files.h"
#include "tests/run/sweep.h"

namespace penumbra::test {
namespace {

using run::RunOutcome;

// A healthy point before and after each fault: neither may notice it.
Sweep& between_healthy(Sweep& sweep, const ParamValues& faulty) {
  return sweep.add({{"value", 0.25}}).add(faulty).add({{"value", 0.75}});
}

void expect_healthy_neighbours(const Sweep& sweep) {
  for (const char* id : {"p0", "p2"}) {
    const auto record = sweep.record(id);
    ASSERT_FALSE(record.is_null()) << id;
    EXPECT_EQ(record["status"], "ok") << record.dump();
    EXPECT_GE(record["timing"]["frame_ms"]["samples"].size(), 3U);
  }
}

TEST(Run, MeasuresAndJudgesAHealthyPoint) {
  Sweep sweep;
  sweep.plan.images = {"visibility", "shaded", "error", "mask", "position", "normal", "triangle"};
  const RunOutcome outcome = sweep.add({{"value", 1.0}}).run();
  EXPECT_EQ(outcome.ok, 1U);
  const auto r = sweep.record("p0");
  ASSERT_EQ(r["status"], "ok") << r.dump();
  EXPECT_GE(r["timing"]["frame_ms"]["samples"].size(), 3U);
  EXPECT_GT(r["timing"]["passes"]["fake_second"]["median"], 0);
  EXPECT_EQ(r["timing"]["repeatable"], true);
  EXPECT_EQ(r["memory"]["structure_bytes"], 42);
  EXPECT_EQ(r["counters"]["list"], (std::vector<double>{1, 2}));
  // All lit is right but for the box's shadow and the sides that face away.
  EXPECT_GT(r["metrics"]["mae"], 0);
  EXPECT_GT(r["metrics"]["zones"]["lit"]["pixels"], 0);
  EXPECT_EQ(r["metrics"]["zones"]["lit"]["mae"], 0);
  EXPECT_GT(r["metrics"]["leak"], 0);
  EXPECT_GT(r["metrics_matched"]["mask_bit_mismatch"], 0);
  for (const char* name : {"visibility", "shaded", "error", "mask", "position", "normal", "triangle",
                           "reference", "reference_shaded"})
    EXPECT_TRUE(std::filesystem::is_regular_file(sweep.out() / r["images"].value(name, "none"))) << name;
  const auto run = sweep.results()["run"];
  EXPECT_EQ(run["complete"], true);
  EXPECT_FALSE(run["vulkan"]["name"].get<std::string>().empty());
  EXPECT_GT(run["scenes"][0]["view_samples_ms"], 0);
}

TEST(Run, ACrashFailsOnlyItsPoint) {
  for (const char* at : {"setup", "build", "render", "tenth_frame"}) {
    Sweep sweep;
    sweep.plan.measure.repetitions = 12;
    const RunOutcome o =
        between_healthy(sweep, {{"fault", std::string("abort")}, {"at", std::string(at)}}).run();
    EXPECT_EQ(o.ok, 2U) << at;
    EXPECT_EQ(o.failed, 1U) << at;
    expect_healthy_neighbours(sweep);
    const auto r = sweep.record("p1");
    EXPECT_EQ(r["status"], "failed");
    EXPECT_NE(r["message"].get<std::string>().find("signal 6"), std::string::npos) << r["message"];
    EXPECT_EQ(r["signal"], 6);
    EXPECT_EQ(r["worker_messages"], "the fake's last words");
    EXPECT_EQ(r["last_pass"], std::string(at) == "setup"   ? "fake_setup"
                              : std::string(at) == "build" ? "fake_build"
                                                           : "fake_second");
  }
}

TEST(Run, EveryKindOfDeathIsNamed) {
  Sweep sweep;
  sweep.add({{"fault", std::string("segfault")}}).add({{"fault", std::string("exit")}}).add({});
  const RunOutcome o = sweep.run();
  EXPECT_EQ(o.failed, 2U);
  EXPECT_EQ(o.ok, 1U);
  EXPECT_NE(sweep.record("p0")["message"].get<std::string>().find("signal 11"), std::string::npos);
  EXPECT_NE(sweep.record("p1")["message"].get<std::string>().find("exit code 7"), std::string::npos);
}

TEST(Run, AHangPastTheLimitIsATimeout) {
  Sweep sweep;
  sweep.plan.measure.max_time_s = 0.5;
  sweep.options.worker.first_call_grace_s = 0.5;
  const RunOutcome o = between_healthy(sweep, {{"fault", std::string("hang")}}).run();
  EXPECT_EQ(o.timed_out, 1U);
  expect_healthy_neighbours(sweep);
  const auto r = sweep.record("p1");
  EXPECT_EQ(r["status"], "timeout");
  EXPECT_EQ(r["signal"], 9);
  EXPECT_EQ(r["last_pass"], "fake_second");
  EXPECT_EQ(r["worker_messages"], "the fake goes to sleep");
}

TEST(Run, AnAllocationThatIsRefusedFailsOnlyItsPoint) {
#if defined(__SANITIZE_ADDRESS__)
  GTEST_SKIP() << "the address sanitizer ends the process where operator new would throw";
#endif
  Sweep sweep;
  const RunOutcome o = between_healthy(sweep, {{"fault", std::string("too_large")}}).run();
  EXPECT_EQ(o.failed, 1U);
  expect_healthy_neighbours(sweep);
  EXPECT_EQ(sweep.record("p1")["message"], "out of host memory.");
}

TEST(Run, TooMuchMemoryFailsOnlyItsPoint) {
  Sweep sweep;
  sweep.options.memory_limit_bytes = uint64_t{1} << 30;
  const RunOutcome o = between_healthy(sweep, {{"fault", std::string("greedy")}}).run();
  EXPECT_EQ(o.failed, 1U);
  expect_healthy_neighbours(sweep);
  const auto r = sweep.record("p1");
  EXPECT_NE(r["message"].get<std::string>().find("memory"), std::string::npos);
  EXPECT_EQ(r["signal"], 9);
  EXPECT_EQ(r["last_pass"], "fake_second");
}

TEST(Run, AnErrorOfThePointIsItsMessage) {
  Sweep sweep;
  const RunOutcome o = between_healthy(sweep, {{"fault", std::string("throw")}}).run();
  EXPECT_EQ(o.failed, 1U);
  expect_healthy_neighbours(sweep);
  EXPECT_EQ(sweep.record("p1")["message"], "the fake cannot finish this point.");
  EXPECT_EQ(sweep.record("p1")["stage"], "first frame");
}

TEST(Run, AnErrorWhileTimingFailsOnlyItsPoint) {
  Sweep sweep;
  sweep.plan.measure.repetitions = 12;
  const RunOutcome o =
      between_healthy(sweep, {{"fault", std::string("throw")}, {"at", std::string("tenth_frame")}}).run();
  EXPECT_EQ(o.failed, 1U);
  expect_healthy_neighbours(sweep);
  EXPECT_EQ(sweep.record("p1")["stage"], "measure");
}

TEST(Run, UnsupportedIsNoFailureAndHasAReason) {
  Sweep sweep;
  sweep.add({{"fault", std::string("unsupported")}}).add({});
  sweep.add({{"fault", std::string("late_unsupported")}});
  sweep.plan.points[1].light = "sun";  // a kind of light that the fake does not list
  const RunOutcome o = sweep.run();
  EXPECT_EQ(o.unsupported, 3U);
  EXPECT_EQ(o.failed, 0U);
  EXPECT_EQ(sweep.record("p0")["message"], "The fake does not do this case.");
  EXPECT_EQ(sweep.record("p2")["message"], "The fake sees that it cannot do this case.");
  EXPECT_NE(sweep.record("p1")["message"].get<std::string>().find("directional"), std::string::npos);
}

TEST(Run, NaNAndUnwrittenPixelsFailAndNeverReachTheFiles) {
  Sweep sweep;
  sweep.add({{"fault", std::string("nan")}}).add({{"fault", std::string("forget")}});
  const RunOutcome o = sweep.run();
  EXPECT_EQ(o.failed, 2U);
  EXPECT_NE(sweep.record("p1")["message"].get<std::string>().find("pixel (39, 29)"), std::string::npos)
      << sweep.record("p1");
  EXPECT_EQ(run::read_text(sweep.out() / "results.json").find(":nan"), std::string::npos);
}

TEST(Run, ChangingOutputIsFlagged) {
  Sweep sweep;
  sweep.add({{"fault", std::string("unrepeatable")}}).run();
  EXPECT_EQ(sweep.record("p0")["timing"]["repeatable"], false);
  // Judged is the first frame, whatever came after: V = 1.
  EXPECT_EQ(sweep.record("p0")["metrics"]["zones"]["lit"]["mae"], 0);
}

TEST(Run, CountersAreLeftOutOnRequest) {
  Sweep sweep;
  sweep.plan.measure = {1, 2, 0, 1};
  sweep.plan.measure.counters = false;
  sweep.add({}).run();
  EXPECT_EQ(sweep.record("p0")["status"], "ok");
  EXPECT_TRUE(sweep.record("p0")["counters"].empty());
}

TEST(Run, TheTimeLimitEndsMeasuringButKeepsOneSample) {
  Sweep sweep;
  sweep.plan.measure = {1, 100, 0, 0.3};
  sweep.add({{"sleep_ms", int64_t{120}}}).run();
  const auto r = sweep.record("p0");
  ASSERT_EQ(r["status"], "ok") << r.dump();
  EXPECT_EQ(r["timing"]["stopped_by"], "max_time_s");
  EXPECT_GE(r["timing"]["frame_ms"]["samples"].size(), 1U);
  EXPECT_LE(r["timing"]["frame_ms"]["samples"].size(), 4U);
}

TEST(Run, GoesOnUntilTheMediansIntervalIsNarrowEnough) {
  Sweep sweep;
  sweep.plan.measure = {1, 3, 0, 20, 0.25};
  sweep.add({{"sleep_ms", int64_t{4}}}).run();
  const auto timing = sweep.record("p0")["timing"];
  EXPECT_EQ(timing["stopped_by"], "target_interval");
  EXPECT_GE(timing["frame_ms"]["samples"].size(), 6U);
  const double median = timing["frame_ms"]["median"], hi = timing["frame_ms"]["ci95"][1];
  EXPECT_LE(hi, 1.25 * median * (1 + 1e-9));
  EXPECT_LE(timing["interval"], 0.25);
}

TEST(Run, ATargetThatIsNotReachedEndsAtTheTimeLimit) {
  Sweep sweep;
  sweep.plan.measure = {1, 3, 0, 0.3, 1e-9};
  sweep.add({{"sleep_ms", int64_t{4}}}).run();
  const auto timing = sweep.record("p0")["timing"];
  EXPECT_EQ(timing["stopped_by"], "max_time_s");
  EXPECT_GT(timing["frame_ms"]["samples"].size(), 10U);  // it went on as long as it might
}

TEST(Run, MinTimeIsFilledWithSamples) {
  Sweep sweep;
  sweep.plan.measure = {1, 3, 0.3, 5};
  sweep.add({{"sleep_ms", int64_t{5}}}).run();
  const auto frame = sweep.record("p0")["timing"]["frame_ms"];
  EXPECT_GE(frame["mean"].get<double>() * double(frame["samples"].size()), 300 * 0.9);
  EXPECT_GE(frame["median"], 5);
}

TEST(Run, ADynamicPointCountsItsBuildIntoTheFrame) {
  Sweep sweep;
  sweep.add({{"dynamic", true}}).add({{"dynamic", false}}).run();
  EXPECT_TRUE(sweep.record("p0")["timing"]["passes"].contains("fake_build"));
  EXPECT_FALSE(sweep.record("p1")["timing"]["passes"].contains("fake_build"));
  EXPECT_GT(sweep.record("p1")["timing"]["build_ms"]["samples"].size(), 0U);
}

TEST(Run, ResumeRunsOnlyWhatFailedOrIsMissing) {
  Sweep sweep;
  sweep.add({{"value", 0.5}}).add({{"value", 0.625}, {"fault", std::string("throw")}}).run();
  const int before = sweep.frames_begun(0.5), failed_before = sweep.frames_begun(0.625);
  sweep.add({{"value", 0.125}});
  const RunOutcome o = sweep.run(true);
  EXPECT_EQ(o.ok, 2U);
  EXPECT_EQ(o.failed, 1U);
  EXPECT_EQ(o.kept, 1U);
  EXPECT_EQ(sweep.frames_begun(0.5), before);
  EXPECT_GT(sweep.frames_begun(0.625), failed_before);
  EXPECT_GT(sweep.frames_begun(0.125), 0);
  EXPECT_EQ(sweep.results()["points"].size(), 3U);
}

TEST(Run, ResumeRunsAgainWhatTheSceneHasChanged) {
  Sweep sweep;
  sweep.add({{"value", 0.5}}).run();
  const int before = sweep.frames_begun(0.5);
  std::string scene = run::read_text(sweep.folder_ / "still.json");
  scene.replace(scene.find("\"size_x\": 8"), 11, "\"size_x\": 9");
  run::write_text(sweep.folder_ / "still.json", scene);
  EXPECT_EQ(sweep.run(true).kept, 0U);
  EXPECT_GT(sweep.frames_begun(0.5), before);
  EXPECT_EQ(sweep.results()["points"].size(), 1U);
}

TEST(Run, AFolderWithResultsIsNotOverwritten) {
  Sweep sweep;
  sweep.add({}).run();
  EXPECT_THROW(sweep.run(), InputError);
}

TEST(Run, IdenticalRunsGiveIdenticalPicturesAndErrors) {
  Sweep a, b;
  for (Sweep* s : {&a, &b}) {
    s->plan.images = {"visibility", "mask"};
    s->add({{"value", 0.5}}).run();
  }
  const auto ra = a.record("p0"), rb = b.record("p0");
  EXPECT_EQ(ra["metrics"], rb["metrics"]);
  EXPECT_EQ(ra["metrics_matched"], rb["metrics_matched"]);
  for (const char* name : {"visibility", "mask"})
    EXPECT_EQ(run::read_text(a.out() / ra["images"][name]), run::read_text(b.out() / rb["images"][name]))
        << name;
}

// The points of a group share their output: the larger one must not pull it from under the smaller one.
TEST(Run, MasksOfDifferentSizesShareAGroup) {
  Sweep sweep;
  for (int i = 0; i < 4; ++i) {
    sweep.add({{"value", 0.25 * i}});
    sweep.plan.points.back().light_samples.width = 4 << i;
    sweep.plan.points.back().width = 100;
    sweep.plan.points.back().height = 80;
  }
  EXPECT_EQ(sweep.run().ok, 4U);
  for (const char* id : {"p0", "p1", "p2", "p3"})
    EXPECT_EQ(sweep.record(id)["timing"]["repeatable"], true) << id;
}

TEST(Run, NoPointsAreAnError) {
  Sweep sweep;
  EXPECT_THROW(sweep.run(), InputError);
}

TEST(Run, AnUnknownDeviceIsADeviceErrorAndLeavesNoResults) {
  Sweep sweep;
  sweep.options.worker.device = "no such device";
  EXPECT_THROW(sweep.add({}).run(), DeviceError);
  EXPECT_FALSE(std::filesystem::exists(sweep.out() / "results.json"));
}

TEST(Run, AnUnwritablePlaceIsAWriteError) {
  Sweep sweep;
  run::write_text(sweep.folder_ / "file", "x");
  sweep.options.out = sweep.folder_ / "file" / "out";
  EXPECT_THROW(sweep.add({}).run(), WriteError);
}

TEST(Run, AMissingSceneFailsItsPointsAndOthersGoOn) {
  Sweep sweep;
  sweep.add({}, 0, "nowhere").add({});
  const RunOutcome o = sweep.run();
  EXPECT_EQ(o.failed, 1U);
  EXPECT_EQ(o.ok, 1U);
  EXPECT_NE(sweep.record("p0")["message"].get<std::string>().find("nowhere"), std::string::npos);
}

// A signal comes to the supervisor while the second point runs: the first is kept, resume does the rest.
TEST(Run, AnInterruptKeepsWhatIsDone) {
  Sweep sweep;
  sweep.options.worker.group_size = 1;
  sweep.add({{"value", 0.5}}).add({{"value", 0.25}, {"sleep_ms", int64_t{3000}}});
  std::thread ctrl_c([&] {
    for (int i = 0; i < 600 && sweep.frames_begun(0.25) == 0; ++i)
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    ::kill(::getpid(), SIGINT);
  });
  const RunOutcome o = sweep.run();
  ctrl_c.join();
  EXPECT_TRUE(o.interrupted);
  EXPECT_EQ(o.ok, 1U);
  EXPECT_EQ(sweep.results()["run"]["complete"], false);
  sweep.plan.points[1].params["sleep_ms"] = int64_t{0};
  const RunOutcome resumed = sweep.run(true);
  EXPECT_EQ(resumed.ok, 2U);
  EXPECT_EQ(resumed.kept, 1U);
}

// The supervisor dies by SIGKILL in mid-sweep: its worker dies with it and nothing finished is lost or
// doubled.
TEST(Run, ResumesAfterTheSupervisorWasKilled) {
  Sweep sweep;
  sweep.options.worker.group_size = 1;
  for (int i = 0; i < 4; ++i) sweep.add({{"value", 0.125 * (i + 1)}, {"sleep_ms", int64_t{60}}});
  const pid_t child = ::fork();
  if (child == 0) {
    sweep.run();
    ::_exit(0);
  }
  const auto journal_lines = [&sweep] {
    std::ifstream in(sweep.out() / "points.jsonl");
    return std::count(std::istreambuf_iterator<char>(in), {}, '\n');
  };
  for (int i = 0; i < 6000 && journal_lines() < 2; ++i)
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  ::kill(child, SIGKILL);
  ::waitpid(child, nullptr, 0);
  const RunOutcome o = sweep.run(true);
  EXPECT_EQ(o.ok, 4U);
  EXPECT_GE(o.kept, 2U);
  EXPECT_EQ(sweep.results()["points"].size(), 4U);
}

}  // namespace
}  // namespace penumbra::test

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "worker")
    return penumbra::run::worker_main(penumbra::test::fake_registry());
  testing::InitGoogleTest(&argc, argv);
  return RUN_ALL_TESTS();
}
