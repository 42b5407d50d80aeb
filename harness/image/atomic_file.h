// A file that is either wholly there or not at all: written beside its place and renamed into it.
#pragma once
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <filesystem>

namespace penumbra {

// Every failure is a WriteError that names the file and the system's reason. The first one is remembered and
// thrown again by commit(), so that a caller in between which swallows exceptions (a destructor of an image
// library) cannot turn half a file into a good one. Without a commit() nothing is left behind.
class AtomicFile {
 public:
  // The temporary stands in the same folder, so that the rename stays within one file system.
  explicit AtomicFile(const std::filesystem::path& path);
  ~AtomicFile();
  AtomicFile(const AtomicFile&) = delete;
  AtomicFile& operator=(const AtomicFile&) = delete;

  void write(const void* data, std::size_t bytes);
  uint64_t position();
  void seek(uint64_t position);
  // True once any of the above has failed.
  bool failed() const { return error_ != 0; }
  // Flushes, closes and renames. No fsync: results must survive a crash of the program, not of the machine.
  void commit();

 private:
  [[noreturn]] void fail(int error);
  std::filesystem::path path_, temporary_;
  std::FILE* file_ = nullptr;
  int error_ = 0;
};

}  // namespace penumbra
