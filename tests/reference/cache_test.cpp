#include "reference/cache.h"

#include <gtest/gtest.h>

#include <fstream>

#include "tests/support/host_view.h"

namespace penumbra {
namespace {

namespace fs = std::filesystem;
using testing::HostView;

class Cache : public ::testing::Test {
 protected:
  void SetUp() override {
    testing::add_ground(geometry_, 2);
    testing::add_box(geometry_, {-0.3F, 0.4F, -0.3F}, {0.3F, 0.9F, 0.3F});
    Camera camera;
    camera.eye = {0, 2, 2}, camera.target = {0, 0, 0};
    view_ = testing::see(geometry_, camera, 16, 9);
    folder_ =
        fs::temp_directory_path() /
        ("penumbra_cache_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::remove_all(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  ReferenceScene::Converged converged(int n = 32, uint32_t seed = 1) const {
    return ReferenceScene(geometry_).converged(view_.host(), light_, n, seed, ReferenceOrigin::offset,
                                               folder_);
  }
  std::vector<fs::path> entries() const {
    std::vector<fs::path> found;
    for (const auto& e : fs::directory_iterator(folder_)) found.push_back(e.path());
    return found;
  }
  // Applies `damage` to the one entry's bytes; the next reference must be computed, be right, and mend the
  // entry.
  template <class F>
  void expect_remade_after(F damage) const {
    const auto made = converged();
    ASSERT_EQ(entries().size(), 1U);
    std::ifstream in(entries()[0], std::ios::binary);
    std::string bytes(std::istreambuf_iterator<char>(in), {});
    in.close();
    damage(bytes);
    std::ofstream(entries()[0], std::ios::binary | std::ios::trunc) << bytes;
    ::testing::internal::CaptureStderr();
    const auto remade = converged();
    EXPECT_NE(::testing::internal::GetCapturedStderr().find(entries()[0].string()), std::string::npos);
    EXPECT_FALSE(remade.from_cache);
    EXPECT_EQ(remade.visibility, made.visibility);
    EXPECT_TRUE(converged().from_cache);
  }

  Geometry geometry_;
  HostView view_;
  Light light_ = testing::rectangle_light({0.6F, 3, 0.4F}, {0, 0, 0}, 0.9F, 0.7F);
  fs::path folder_;
};

TEST_F(Cache, ReadsBackWhatWasMade) {
  const auto made = converged();
  EXPECT_FALSE(made.from_cache);
  const auto read = converged();
  EXPECT_TRUE(read.from_cache);
  EXPECT_EQ(read.visibility, made.visibility);
  EXPECT_EQ(read.standard_error, made.standard_error);
  EXPECT_EQ(read.evaluated, made.evaluated);
  EXPECT_EQ(read.mean_standard_error, made.mean_standard_error);
}

TEST_F(Cache, LeavesNothingButTheEntry) {
  converged();
  ASSERT_EQ(entries().size(), 1U);
  EXPECT_EQ(entries()[0].extension(), ".bin");
}

TEST_F(Cache, KeepsDifferentReferencesApart) {
  converged();
  EXPECT_FALSE(converged(33).from_cache);
  EXPECT_FALSE(converged(32, 2).from_cache);
  light_.edge_u = light_.edge_u * 1.01F;
  EXPECT_FALSE(converged().from_cache);
  geometry_.positions[7].x += 0.01F;
  EXPECT_FALSE(converged().from_cache);
  view_.origin[40].x += 1e-6F;
  EXPECT_FALSE(converged().from_cache);
  EXPECT_EQ(entries().size(), 6U);
}

TEST_F(Cache, KeepsTheOriginsApart) {
  const ViewSamplesHost view = view_.host();
  EXPECT_NE(converged_key("", view, light_, 1, 1, ReferenceOrigin::offset),
            converged_key("", view, light_, 1, 1, ReferenceOrigin::exact));
}

TEST_F(Cache, DoesNotDependOnTheLightsNameOrIntensity) {
  const std::string key = converged_key("", view_.host(), light_, 1, 1, ReferenceOrigin::offset);
  light_.name = "key", light_.intensity = 3;
  EXPECT_EQ(converged_key("", view_.host(), light_, 1, 1, ReferenceOrigin::offset), key);
}

TEST_F(Cache, RemakesATruncatedEntry) {
  expect_remade_after([](std::string& bytes) { bytes.resize(bytes.size() - 1); });
}

TEST_F(Cache, RemakesAnEmptyEntry) {
  expect_remade_after([](std::string& bytes) { bytes.clear(); });
}

TEST_F(Cache, RemakesAnEntryWithAChangedByte) {
  expect_remade_after([](std::string& bytes) { bytes[bytes.size() / 2] ^= 1; });
}

TEST_F(Cache, RemakesAnEntryOfAnotherVersion) {
  expect_remade_after([](std::string& bytes) { bytes[8] ^= 1; });
}

TEST_F(Cache, RemakesAnEntryWithBytesPastTheEnd) {
  expect_remade_after([](std::string& bytes) { bytes += "more"; });
}

TEST_F(Cache, RefusesAnEntryOfAnotherSize) {
  converged();
  ::testing::internal::CaptureStderr();
  EXPECT_FALSE(read_cached(entries()[0], 9, 16));
  EXPECT_FALSE(::testing::internal::GetCapturedStderr().empty());
}

TEST_F(Cache, FailingToWriteIsAMessageAndNoError) {
  std::ofstream(folder_) << "a file where the folder should be";
  ::testing::internal::CaptureStderr();
  const auto made = converged();
  EXPECT_NE(::testing::internal::GetCapturedStderr().find(folder_.string()), std::string::npos);
  EXPECT_EQ(made.visibility.size(), view_.triangle.size());
}

TEST_F(Cache, AFailedWriteLeavesNothingBehind) {
  const auto made =
      ReferenceScene(geometry_).converged(view_.host(), light_, 8, 1, ReferenceOrigin::offset, {});
  const fs::path entry = folder_ / "entry.bin";
  fs::create_directories(entry / "occupied");  // the rename cannot replace a folder
  EXPECT_NE(write_cached(entry, 16, 9, made), "");
  EXPECT_EQ(entries().size(), 1U);
}

TEST_F(Cache, WithoutAFolderNothingIsWritten) {
  folder_.clear();
  EXPECT_FALSE(converged().from_cache);
  EXPECT_FALSE(converged().from_cache);
}

}  // namespace
}  // namespace penumbra
