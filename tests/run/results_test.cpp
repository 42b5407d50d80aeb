#include "run/results.h"

#include <gtest/gtest.h>

#include <limits>
#include <nlohmann/json.hpp>

#include "run/files.h"
#include "run/judge.h"
#include "run/processors.h"
#include "run/record.h"
#include "run/statistics.h"
#include "run/table.h"
#include "tests/support/temporary_folder.h"

namespace penumbra::run {
namespace {

using nlohmann::json;

Point some_point() {
  Point p;
  p.id = "0123456789abcdef";
  p.technique = "gears";
  p.params = {{"grid_size", int64_t{128}}, {"length", 2.0}, {"fit", std::string("tight")}, {"on", true}};
  p.scene = "bunny";
  p.light = "key";
  p.camera = "front";
  p.sampled = true;
  p.light_samples = {16, 8, 0, LightPattern::regular, 1};
  p.frame = 3;
  return p;
}

json ok_record(const std::string& id, int frame, double ms) {
  json r = record_of(some_point());
  r["id"] = id;
  r["frame"] = frame;
  r["status"] = "ok";
  r["message"] = "";
  r["timing"] = {{"frame_ms", to_json(summarize({ms, ms + 1, ms + 2}))},
                 {"build_ms", to_json(summarize({1}))},
                 {"setup_ms", to_json(summarize({2}))},
                 {"passes", {{"a", to_json(summarize({ms}))}}}};
  r["metrics"] = {{"mae", 0.5 * frame},
                  {"max", 0.1 * frame},
                  {"flicker", frame ? json(0.25) : json()},
                  {"zones", {{"umbra", {{"pixels", 0}, {"mae", nullptr}}}}}};
  r["memory"] = {{"device_bytes", 100 * frame}};
  return r;
}

RecordSource source_of(std::vector<json> all) {
  return [all](const auto& visit) {
    for (const json& r : all) visit(r);
  };
}

TEST(Record, APointSurvivesTheTripToTheWorker) {
  const Point p = some_point();
  const Point q = point_from_json(json::parse(dump_line(to_json(p))));
  EXPECT_EQ(to_json(q), to_json(p));
  EXPECT_TRUE(std::holds_alternative<double>(q.params.at("length")));  // 2.0 stays a number, no integer
  EXPECT_EQ(q.key(), p.key());
  EXPECT_EQ(q.light_samples.height, 8);
}

TEST(Record, NeverHoldsNaNOrInfinityAndMendsForeignBytes) {
  const std::string line =
      dump_line({{"a", std::numeric_limits<double>::quiet_NaN()}, {"b", INFINITY}, {"c", "bad \xff byte"}});
  const json back = json::parse(line);
  EXPECT_TRUE(back["a"].is_null());
  EXPECT_TRUE(back["b"].is_null());
  EXPECT_EQ(line.find('\n'), std::string::npos);
}

TEST(Record, FramesOfASequenceShareItsKeyAndNothingElseDoes) {
  Point a = some_point(), b = some_point();
  b.frame = 4;
  b.id = "other";
  EXPECT_EQ(sequence_key(a), sequence_key(b));
  EXPECT_NE(view_key(a), view_key(b));
  b.params["grid_size"] = int64_t{64};
  EXPECT_NE(sequence_key(a), sequence_key(b));
}

TEST(Results, TheFileIsOneJsonDocument) {
  const test::TemporaryFolder folder;
  write_results_json(folder / "results.json", {{"name", "x"}},
                     source_of({ok_record("a", 0, 1), ok_record("b", 1, 2)}));
  const json r = json::parse(read_text(folder / "results.json"));
  EXPECT_EQ(r["schema_version"], schema_version);
  EXPECT_EQ(r["run"]["name"], "x");
  ASSERT_EQ(r["points"].size(), 2U);
  EXPECT_EQ(r["points"][1]["id"], "b");
}

TEST(Csv, EveryRowHasEveryColumnAndQuotesWhatNeedsIt) {
  json failed = record_without_result(some_point(), "failed", "said \"no\", twice\nand again");
  std::string text;
  write_csv(source_of({ok_record("a", 1, 5), failed}), [&](const std::string& s) { text += s; });
  const std::string header = text.substr(0, text.find("\r\n"));
  EXPECT_EQ(header.rfind("id,technique,scene,frame,status,message,width,height", 0), 0U) << header;
  for (const char* column : {"param.grid_size", "frame_ms_median", "frame_ms_ci95_lo", "pass.a_ms",
                             "metrics.mae", "metrics.zones.umbra.mae", "setup_ms"})
    EXPECT_NE(("," + header + ",").find(std::string(",") + column + ","), std::string::npos) << column;
  EXPECT_NE(text.find("\"said \"\"no\"\", twice\nand again\""), std::string::npos);
  EXPECT_NE(text.find(",16x8,"), std::string::npos);
  const std::string first_row =
      text.substr(header.size() + 2, text.find("\r\n", header.size() + 2) - header.size() - 2);
  EXPECT_EQ(std::ranges::count(first_row, ','), std::ranges::count(header, ','));
}

TEST(SequenceSummary, AveragesFramesAndTakesTheWorst) {
  const json s = sequence_summary({ok_record("a", 0, 10), ok_record("b", 1, 20), ok_record("c", 2, 60)});
  EXPECT_TRUE(s["frame"].is_null());
  EXPECT_EQ(s["status"], "ok");
  EXPECT_DOUBLE_EQ(s["metrics"]["mae"], 0.5);
  EXPECT_DOUBLE_EQ(s["metrics"]["max"], 0.2);
  EXPECT_DOUBLE_EQ(s["metrics"]["flicker"], 0.25);  // the first frame has none
  EXPECT_EQ(s["timing"]["frame_ms"]["samples"], (std::vector<double>{11, 21, 61}));
  EXPECT_EQ(s["memory"]["device_bytes"], 200);
}

TEST(SequenceSummary, IsNotOkWhenAFrameIsNot) {
  json failed = record_without_result(some_point(), "failed", "why");
  const json s = sequence_summary({ok_record("a", 0, 10), failed});
  EXPECT_EQ(s["status"], "failed");
  EXPECT_EQ(s["message"], "frame 3: why");
}

TEST(Table, ShowsTheParametersThatDifferAndTheMessageOfAFailure) {
  json other = ok_record("b", 3, 7);
  other["params"]["grid_size"] = 64;
  const std::string t = table(
      source_of({ok_record("a", 3, 5), other, record_without_result(some_point(), "timeout", "too slow")}));
  EXPECT_NE(t.find("grid_size=64"), std::string::npos) << t;
  EXPECT_EQ(t.find("fit="), std::string::npos) << t;
  EXPECT_NE(t.find("timeout: too slow"), std::string::npos) << t;
}

TEST(Table, SaysWhatSpeaksAgainstTheTimes) {
  json steady = ok_record("a", 3, 5), drifting = ok_record("b", 3, 7), beside_others = ok_record("c", 3, 9);
  EXPECT_EQ(table(source_of({steady})).find("note:"), std::string::npos);
  drifting["timing"]["drifts"] = true, drifting["timing"]["drift"] = -0.12;
  beside_others["other_programs"] = 0.35;
  beside_others["timing"]["repeatable"] = false;
  const std::string t = table(source_of({steady, drifting, beside_others}));
  EXPECT_NE(t.find("drifted while they were taken, in 1 points"), std::string::npos) << t;
  EXPECT_NE(t.find("-12 %"), std::string::npos) << t;
  EXPECT_NE(t.find("up to 35 % of the processors"), std::string::npos) << t;
  EXPECT_NE(t.find("changes from frame to frame in 1 points"), std::string::npos) << t;
}

TEST(OthersShare, IsWhatIsNeitherIdleNorOurs) {
  const ProcessorUse before{100, 50, 10};
  EXPECT_NEAR(*others_share(before, ProcessorUse{104, 51, 12}), 0.25,
              1e-12);  // 3 of 4 s busy, 2 of them ours
  EXPECT_EQ(*others_share(before, ProcessorUse{104, 52, 12}), 0);
  EXPECT_EQ(*others_share(before, ProcessorUse{104, 52, 13}), 0);  // clocks of different steps
  EXPECT_FALSE(others_share(before, ProcessorUse{100.1, 50, 10}).has_value());
  EXPECT_FALSE(others_share(std::nullopt, before).has_value());
  const auto now = processor_use();
  ASSERT_TRUE(now.has_value());
  EXPECT_GT(now->all, now->idle);
}

TEST(GoogleBenchmark, HasOneEntryForEachSample) {
  const json j = google_benchmark_json({{"started", "t"}}, source_of({ok_record("a", 1, 5)}));
  ASSERT_EQ(j["benchmarks"].size(), 3U);
  EXPECT_EQ(j["benchmarks"][2]["real_time"], 7.0);
  EXPECT_EQ(j["benchmarks"][2]["time_unit"], "ms");
  EXPECT_TRUE(j["context"].contains("date"));
}

TEST(FinishOutput, SetsWhatIsNotEvaluatedAndRefusesNaN) {
  Output o;
  o.visibility = {NAN, 0.5f};
  o.mask = {7, 8};
  finish_output(o, std::vector<uint8_t>{0, 1}, 2);
  EXPECT_EQ(o.visibility[0], 1);
  EXPECT_EQ(o.mask[0], 0U);
  EXPECT_EQ(o.mask[1], 8U);
  o.visibility = {1, NAN};
  const std::string message = test::message_of<PointError>([&] {
    finish_output(o, std::vector<uint8_t>{0, 1}, 2);
  });
  EXPECT_NE(message.find("(1, 0)"), std::string::npos) << message;
}

}  // namespace
}  // namespace penumbra::run
