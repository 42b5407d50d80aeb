#include "image/atomic_file.h"

#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <string>
#include <utility>

#include "core/error.h"

namespace penumbra {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void throw_write_error(const fs::path& path, const std::string& reason) {
  throw WriteError(path.string() + ": cannot be written: " + reason + ".");
}

// A link is written through; whatever else is no regular file (a folder, a device) must not be renamed away.
fs::path resolve_target(const fs::path& path) {
  std::error_code code;
  fs::path target = path;
  if (fs::is_symlink(fs::symlink_status(path, code))) {
    target = fs::weakly_canonical(path, code);
    if (code) throw_write_error(path, code.message());
  }
  const fs::file_status status = fs::status(target, code);
  if (fs::is_directory(status)) throw_write_error(path, "it is a directory");
  if (fs::exists(status) && !fs::is_regular_file(status)) throw_write_error(path, "it is no regular file");
  return target;
}

fs::path temporary_beside(const fs::path& path) {
  static std::atomic<unsigned> serial{0};
  fs::path name = path;
  // Process and serial number: writers of one file never share a temporary, the last rename wins whole.
  name += "." + std::to_string(::getpid()) + "." + std::to_string(serial++) + ".tmp";
  return name;
}

}  // namespace

AtomicFile::AtomicFile(const fs::path& path)
    : path_(resolve_target(path)), temporary_(temporary_beside(path_)) {
  file_ = std::fopen(temporary_.c_str(), "wbx");
  if (!file_) throw_write_error(path_, std::strerror(errno));
}

AtomicFile::~AtomicFile() {
  if (file_) std::fclose(file_);
  if (!temporary_.empty()) ::unlink(temporary_.c_str());
}

void AtomicFile::fail(int error) {
  if (error_ == 0) error_ = error != 0 ? error : EIO;
  throw_write_error(path_, std::strerror(error_));
}

void AtomicFile::write(const void* data, std::size_t bytes) {
  if (bytes > 0 && std::fwrite(data, 1, bytes, file_) != bytes) fail(errno);
}

uint64_t AtomicFile::position() {
  const off_t at = ::ftello(file_);
  if (at < 0) fail(errno);
  return static_cast<uint64_t>(at);
}

void AtomicFile::seek(uint64_t position) {
  if (::fseeko(file_, static_cast<off_t>(position), SEEK_SET) != 0) fail(errno);
}

void AtomicFile::commit() {
  if (error_ != 0) fail(error_);
  const bool flushed = std::fflush(file_) == 0;
  const int flush_error = errno;
  const bool closed = std::fclose(std::exchange(file_, nullptr)) == 0;
  if (!flushed) fail(flush_error);
  if (!closed) fail(errno);
  if (std::rename(temporary_.c_str(), path_.c_str()) != 0) fail(errno);
  temporary_.clear();
}

}  // namespace penumbra
