// The report's folder: what is written, what is refused.
#include "report/report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "core/error.h"
#include "image/image.h"
#include "report/page.h"
#include "report/pictures.h"
#include "scratch_folder.h"
#include "synthetic_run.h"

namespace penumbra {
namespace {
namespace fs = std::filesystem;
using nlohmann::json;
using test::read_file;
using test::ScratchFolder;

json written_data(const fs::path& report) {
  const std::string script = read_file(report / "assets" / "data.js");
  const std::string start = "window.penumbra_data = JSON.parse('", end = "');";
  const std::size_t at = script.find(start) + start.size();
  std::string text;  // undoes the escapes of the string that holds the JSON
  for (std::size_t i = at, stop = script.rfind(end); i < stop; ++i)
    text += script[i] == '\\' ? script[++i] : script[i];
  return json::parse(text);
}

void write_text(const fs::path& path, const std::string& text) { std::ofstream(path) << text; }

std::string message_of(const fs::path& run, const fs::path& out = {}) {
  try {
    write_report(run, out);
  } catch (const InputError& e) {
    return e.what();
  }
  return "no InputError";
}

TEST(SignedErrorCode, RoundTripsAndTellsOneLightSampleInAThousand) {
  EXPECT_EQ(encode_signed_error(0.f), 128);
  EXPECT_EQ(encode_signed_error(1.f), 255);
  EXPECT_EQ(encode_signed_error(-1.f), 1);
  EXPECT_EQ(encode_signed_error(7.f), 255);
  EXPECT_GT(encode_signed_error(1.f / 1024), 128);
  EXPECT_LT(encode_signed_error(-1.f / 1024), 128);
  for (float e = -1; e <= 1; e += 0.01f) {
    // Half a code step of the root, times twice the root (and the square of the half step).
    const float bound = std::sqrt(std::abs(e)) / 127 + 1.f / (254 * 254);
    EXPECT_NEAR(decode_signed_error(encode_signed_error(e)), e, bound) << e;
  }
}

TEST(ErrorPicture, IsTestMinusReferenceAndRefusesOtherSizes) {
  const ExrImage reference{2, 1, {{"Y", {0.5f, 0.5f}}}, {}}, test{2, 1, {{"Y", {1.f, 0.25f}}}, {}};
  const Rgb8Image picture = error_picture(reference, test);
  EXPECT_NEAR(decode_signed_error(picture.rgb[0]), 0.5f, 0.01f);
  EXPECT_NEAR(decode_signed_error(picture.rgb[3]), -0.25f, 0.01f);
  EXPECT_THROW(error_picture(reference, ExrImage{1, 1, {{"Y", {1.f}}}, {}}), InputError);
}

TEST(Page, EscapesNamesInMarkupAndScript) {
  EXPECT_EQ(escape_html("<a href=\"x\">&'"), "&lt;a href=&quot;x&quot;&gt;&amp;&#39;");
  const std::string literal = script_literal({{"</script>", "<!--\u2028\xff"}});
  EXPECT_EQ(literal.find('<'), std::string::npos);
  EXPECT_EQ(json::parse(literal).begin().key(), "</script>");
  EXPECT_NE(index_html("<i>").find("&lt;i&gt;"), std::string::npos);
}

TEST(Report, HoldsEveryPointAndEveryPicture) {
  ScratchFolder scratch;
  const json results = test::write_synthetic_run(scratch / "run");
  const ReportSummary summary = write_report(scratch / "run", {});
  EXPECT_EQ(summary.index, scratch / "run" / "report" / "index.html");
  EXPECT_EQ(summary.points, results["points"].size());
  EXPECT_TRUE(summary.warnings.empty()) << summary.warnings.front();
  const json data = written_data(scratch / "run" / "report");
  EXPECT_EQ(data["points"], results["points"]);
  EXPECT_EQ(data["run"], results["run"]);
  ASSERT_EQ(data["pictures"].size(), results["points"].size());
  std::size_t shown = 0;
  for (std::size_t i = 0; i < data["pictures"].size(); ++i) {
    if (results["points"][i]["status"] != "ok") continue;
    for (const char* name : {"visibility", "shaded", "error_code", "reference", "reference_shaded"}) {
      const Rgb8Image picture =
          read_png(scratch / "run" / "report" / data["pictures"][i].at(name).get<std::string>());
      EXPECT_EQ(picture.width, 160);
      EXPECT_EQ(picture.height, 120);
      ++shown;
    }
  }
  EXPECT_GT(shown, 100u);
}

TEST(Report, StandsAloneWhenMoved) {
  ScratchFolder scratch;
  test::write_synthetic_run(scratch / "run");
  write_report(scratch / "run", scratch / "out");
  fs::remove_all(scratch / "run");
  fs::rename(scratch / "out", scratch / "elsewhere");
  const json data = written_data(scratch / "elsewhere");
  for (const json& pictures : data["pictures"])
    for (const auto& [name, path] : pictures.items()) {
      EXPECT_TRUE(fs::path(path.get<std::string>()).is_relative());
      EXPECT_NO_THROW(read_png(scratch / "elsewhere" / path.get<std::string>())) << name;
    }
}

TEST(Report, NamesNoAddressOfANetwork) {
  ScratchFolder scratch;
  test::write_synthetic_run(scratch / "run");
  write_report(scratch / "run", {});
  for (const char* file : {"index.html", "assets/report.js", "assets/report.css", "assets/data.js"}) {
    std::string text = read_file(scratch / "run" / "report" / file);
    // A name of the XML vocabulary, which no browser fetches.
    const std::string svg = "http://www.w3.org/2000/svg";
    for (std::size_t at = text.find(svg); at != std::string::npos; at = text.find(svg))
      text.erase(at, svg.size());
    for (const char* address :
         {"http:", "https:", "//cdn", "@import", "fetch(", "import(", "type=\"module\""})
      EXPECT_EQ(text.find(address), std::string::npos) << file << " has " << address;
  }
}

TEST(Report, KeepsPicturesThatAreUpToDate) {
  ScratchFolder scratch;
  const json results = test::write_synthetic_run(scratch / "run");
  write_report(scratch / "run", {});
  const std::string source = results["points"][0]["images"]["visibility"].get<std::string>();
  fs::path picture = scratch / "run" / "report" / source;
  picture.replace_extension(".png");
  const auto before = fs::last_write_time(picture);
  write_report(scratch / "run", {});
  EXPECT_EQ(fs::last_write_time(picture), before);
  fs::last_write_time(scratch / "run" / source, before + std::chrono::seconds(5));
  write_report(scratch / "run", {});
  EXPECT_NE(fs::last_write_time(picture), before);
}

TEST(Report, ReadsTheJournalOfARunThatHasNotEnded) {
  ScratchFolder scratch;
  const json results = test::write_synthetic_run(scratch / "run", {16, 12, false});
  fs::remove(scratch / "run" / "results.json");
  write_text(scratch / "run" / "run.json", results["run"].dump());
  write_text(scratch / "run" / "points.jsonl",
             results["points"][0].dump() + "\n" + results["points"][1].dump() + "\n{\"id\": \"to");
  EXPECT_EQ(write_report(scratch / "run", {}).points, 2u);
  write_text(scratch / "run" / "points.jsonl", "{\"id\": \"to\n" + results["points"][1].dump() + "\n");
  EXPECT_NE(message_of(scratch / "run").find("points.jsonl:1"), std::string::npos);
}

TEST(Report, ShowsWhatItCanOfAbsentAndForeignPictures) {
  ScratchFolder scratch;
  json results = test::write_synthetic_run(scratch / "run", {16, 12, true});
  const std::string lost = results["points"][0]["images"]["visibility"];
  fs::remove(scratch / "run" / lost);
  results["points"][1]["images"]["shaded"] = "../../etc/secret.png";
  write_text(scratch / "run" / "results.json", results.dump());
  const ReportSummary summary = write_report(scratch / "run", {});
  const json data = written_data(scratch / "run" / "report");
  EXPECT_FALSE(data["pictures"][0].contains("visibility"));
  EXPECT_TRUE(data["pictures"][0].contains("shaded"));
  EXPECT_FALSE(data["pictures"][1].contains("shaded"));
  std::string all;
  for (const std::string& warning : summary.warnings) all += warning + "\n";
  EXPECT_NE(all.find(lost), std::string::npos) << all;
  EXPECT_NE(all.find("does not lie inside the run"), std::string::npos) << all;
}

TEST(Report, RefusesWhatIsNoResultsAndSaysWhere) {
  ScratchFolder scratch;
  EXPECT_NE(message_of(scratch / "nowhere").find("no such folder"), std::string::npos);
  EXPECT_NE(message_of(scratch.path()).find("neither results.json nor run.json"), std::string::npos);
  const auto refuses = [&](const std::string& text, const std::string& expected) {
    write_text(scratch / "results.json", text);
    const std::string message = message_of(scratch.path());
    EXPECT_NE(message.find("results.json"), std::string::npos) << message;
    EXPECT_NE(message.find(expected), std::string::npos) << message;
  };
  refuses("{\"schema_version\": 1,", "not JSON");
  refuses("[]", "expected an object");
  refuses("{\"schema_version\": 2, \"points\": []}", "/schema_version: found 2, expected 1");
  refuses("{\"schema_version\": 1}", "/points");
  refuses("{\"schema_version\": 1, \"points\": [3]}", "/points/0");
  refuses("{\"schema_version\": 1, \"points\": [{\"technique\": \"gears\"}]}", "/points/0/scene");
}

TEST(Report, LeavesForeignPagesAlone) {
  ScratchFolder scratch;
  test::write_synthetic_run(scratch / "run", {16, 12, false});
  fs::create_directories(scratch / "site");
  write_text(scratch / "site" / "index.html", "my page");
  EXPECT_NE(message_of(scratch / "run", scratch / "site").find("is not a report"), std::string::npos);
  EXPECT_EQ(read_file(scratch / "site" / "index.html"), "my page");
}

TEST(Report, SaysWhenItsFolderCannotBeWritten) {
  ScratchFolder scratch;
  test::write_synthetic_run(scratch / "run", {16, 12, false});
  write_text(scratch / "file", "");
  EXPECT_THROW(write_report(scratch / "run", scratch / "file"), WriteError);
}

}  // namespace
}  // namespace penumbra
