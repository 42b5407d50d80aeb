// Writing that fails: one clear WriteError, and nothing left behind.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <csignal>
#include <filesystem>
#include <random>

#include "core/error.h"
#include "image/atomic_file.h"
#include "image/image.h"
#include "tests/support/temporary_folder.h"

namespace penumbra {
namespace {

namespace fs = std::filesystem;
using test::message_of;
using test::TemporaryFolder;

// Files of this process cannot grow beyond `bytes`, which write() reports just as it does a full disk.
class FullDisk {
 public:
  explicit FullDisk(rlim_t bytes) : handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    ::getrlimit(RLIMIT_FSIZE, &before_);
    const rlimit limit{bytes, before_.rlim_max};
    if (::setrlimit(RLIMIT_FSIZE, &limit) != 0) ADD_FAILURE() << "the file size cannot be limited";
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &before_);
    std::signal(SIGXFSZ, handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

 private:
  rlimit before_{};
  void (*handler_)(int);
};

std::vector<float> noise(std::size_t n) {
  std::mt19937 random(3);
  std::vector<float> v(n);
  for (float& f : v) f = static_cast<float>(random()) / 4294967296.0f;
  return v;
}

TEST(WriteErrors, AFullDiskLeavesNothingBehindAtAnyPoint) {
  // Limits that hit the header, the pixels, and the offsets or the last buffer at the very end.
  TemporaryFolder folder;
  const std::vector<float> values = noise(128 * 128);
  write_exr_gray(folder / "whole.exr", 128, 128, values);
  const rlim_t size = fs::file_size(folder / "whole.exr");
  fs::remove(folder / "whole.exr");
  for (rlim_t limit : {rlim_t{0}, rlim_t{100}, size / 2, size - 1}) {
    std::string message;
    {
      FullDisk full(limit);
      message = message_of<WriteError>([&] { write_exr_gray(folder / "a.exr", 128, 128, values); });
    }
    EXPECT_NE(message.find("a.exr: cannot be written: File too large"), std::string::npos) << message;
    EXPECT_TRUE(folder.names().empty()) << "limit " << limit;
  }
  FullDisk enough(size);
  write_exr_gray(folder / "a.exr", 128, 128, values);
  EXPECT_EQ(folder.names(), std::vector<std::string>{"a.exr"});
}

TEST(WriteErrors, AFullDiskKeepsTheFileThatWasThere) {
  TemporaryFolder folder;
  const Rgb8Image old{2, 1, {1, 2, 3, 4, 5, 6}};
  write_png(folder / "a.png", old);
  {
    FullDisk full(20);
    message_of<WriteError>([&] { write_png(folder / "a.png", {1, 1, {7, 8, 9}}); });
  }
  EXPECT_EQ(read_png(folder / "a.png").rgb, old.rgb);
  EXPECT_EQ(folder.names().size(), 1u);
}

TEST(WriteErrors, AMissingFolderAFolderAndADeviceAreRefused) {
  TemporaryFolder folder;
  const std::vector<float> one = {1};
  EXPECT_NE(message_of<WriteError>([&] {
              write_exr_gray(folder / "no/a.exr", 1, 1, one);
            }).find("No such file or directory"),
            std::string::npos);
  EXPECT_NE(
      message_of<WriteError>([&] { write_exr_gray(folder.path(), 1, 1, one); }).find("it is a directory"),
      std::string::npos);
  EXPECT_NE(message_of<WriteError>([&] { write_exr_gray("/dev/full", 1, 1, one); }).find("no regular file"),
            std::string::npos);
  EXPECT_TRUE(folder.names().empty());
}

TEST(WriteErrors, ALinkIsWrittenThrough) {
  TemporaryFolder folder;
  write_exr_gray(folder / "target.exr", 1, 1, std::vector<float>{1});
  fs::create_symlink("target.exr", folder / "link.exr");
  write_exr_gray(folder / "link.exr", 1, 1, std::vector<float>{2});
  EXPECT_TRUE(fs::is_symlink(folder / "link.exr"));
  EXPECT_EQ(read_exr(folder / "target.exr").floats.at(0).values, std::vector<float>{2});
}

TEST(WriteErrors, SizesThatDoNotFitTheValuesAreRefused) {
  TemporaryFolder folder;
  const std::vector<float> six(6);
  EXPECT_NE(message_of<WriteError>([&] { write_exr_gray(folder / "a.exr", 2, 2, six); }).find("6 values"),
            std::string::npos);
  message_of<WriteError>([&] { write_exr_gray(folder / "a.exr", 0, 0, {}); });
  message_of<WriteError>([&] { write_exr(folder / "a.exr", {2, 2, {}, {}}); });
  message_of<WriteError>([&] {
    write_exr_words(folder / "a.exr", 1, 1, std::vector<uint32_t>(3), {"w0", "w1"});
  });
  message_of<WriteError>([&] { write_png(folder / "a.png", {2, 2, {1, 2, 3}}); });
  EXPECT_TRUE(folder.names().empty());
}

TEST(AtomicFile, WithoutACommitThereIsNoFile) {
  TemporaryFolder folder;
  {
    AtomicFile file(folder / "a");
    file.write("abc", 3);
  }
  EXPECT_TRUE(folder.names().empty());
}

TEST(AtomicFile, TwoWritersOfOneNameDoNotMix) {
  TemporaryFolder folder;
  AtomicFile first(folder / "a"), second(folder / "a");
  first.write("first", 5);
  second.write("2", 1);
  second.commit();
  first.commit();
  EXPECT_EQ(test::file_bytes(folder / "a"), (std::vector<char>{'f', 'i', 'r', 's', 't'}));
  EXPECT_EQ(folder.names().size(), 1u);
}

}  // namespace
}  // namespace penumbra
