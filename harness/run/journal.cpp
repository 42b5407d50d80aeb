#include "run/journal.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/error.h"
#include "run/files.h"
#include "run/record.h"

namespace penumbra::run {
namespace {

[[noreturn]] void fail_write(const std::filesystem::path& path, int error) {
  throw WriteError(
      fmt::format("{}: cannot be written: {}. Points finished so far are kept; --resume goes on.",
                  path.string(), std::strerror(error)));
}

int open_file(const std::filesystem::path& path, int flags) {
  const int fd = ::open(path.c_str(), flags | O_CLOEXEC, 0644);
  if (fd < 0) fail_write(path, errno);
  return fd;
}

}  // namespace

Journal::Journal(const std::filesystem::path& folder, Mode mode)
    : folder_(folder), file_(folder / "points.jsonl") {
  make_folder(folder_);
  lock();
  try {
    fd_ = open_file(file_, O_RDWR | O_CREAT | O_APPEND);
    read(mode);
  } catch (...) {
    if (fd_ >= 0) ::close(fd_);
    ::close(lock_fd_);
    throw;
  }
}

Journal::~Journal() {
  ::close(fd_);
  // The lock file stays: removing it would let two later runs lock two different files of one name.
  ::close(lock_fd_);
}

void Journal::lock() {
  lock_fd_ = open_file(folder_ / ".lock", O_RDWR | O_CREAT);
  if (::flock(lock_fd_, LOCK_EX | LOCK_NB) == 0) {
    const std::string pid = fmt::format("{}\n", ::getpid());
    if (::ftruncate(lock_fd_, 0) != 0 || ::pwrite(lock_fd_, pid.data(), pid.size(), 0) < 0) {
      // Only the message of a second run would name the process; the lock itself holds.
    }
    return;
  }
  char pid[32] = {};
  const ssize_t n = ::pread(lock_fd_, pid, sizeof pid - 1, 0);
  ::close(lock_fd_);
  const std::string who = n > 1 ? std::string(pid, static_cast<std::size_t>(n) - 1) : "unknown";
  throw InputError(
      fmt::format("{}: another run (process {}) is writing here; wait for it or choose another --out.",
                  folder_.string(), who));
}

void Journal::read(Mode mode) {
  const std::string text = read_text(file_);
  if (!text.empty() && mode == Mode::fresh)
    throw InputError(fmt::format(
        "{}: already holds results. --resume goes on with them; or choose another --out.", folder_.string()));
  std::size_t begin = 0, number = 1;
  for (std::size_t end; (end = text.find('\n', begin)) != std::string::npos; begin = end + 1, ++number)
    take(std::string_view(text).substr(begin, end - begin), begin, number);
  size_ = begin;
  if (begin < text.size()) {
    remarks_.push_back(
        fmt::format("{}:{}: the last line is torn ({} bytes without an end); cut off, its point runs again.",
                    file_.string(), number, text.size() - begin));
    if (::ftruncate(fd_, static_cast<off_t>(begin)) != 0) fail_write(file_, errno);
  }
}

void Journal::take(std::string_view line, uint64_t offset, std::size_t number) {
  const auto json = nlohmann::json::parse(line, nullptr, false);
  const bool valid = json.is_object() && json.contains("id") && json["id"].is_string() &&
                     json.contains("status") && json["status"].is_string() &&
                     (!json.contains("fingerprint") || json["fingerprint"].is_string());
  if (!valid) {
    if (!line.empty())
      remarks_.push_back(
          fmt::format("{}:{}: not a point's record; ignored, its point runs again.", file_.string(), number));
    return;
  }
  JournalEntry entry{json["id"], json["status"], json.value("fingerprint", ""), offset, line.size()};
  entries_[entry.id] = entry;
}

const JournalEntry* Journal::find(const std::string& id) const {
  const auto it = entries_.find(id);
  return it == entries_.end() ? nullptr : &it->second;
}

std::string Journal::line(const JournalEntry& entry) const {
  std::string line(entry.length, '\0');
  for (std::size_t at = 0; at < line.size();) {
    const ssize_t n = ::pread(fd_, line.data() + at, line.size() - at, static_cast<off_t>(entry.offset + at));
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) throw InputError(fmt::format("{}: changed while the run was going on.", file_.string()));
    at += static_cast<std::size_t>(n);
  }
  return line;
}

void Journal::append(const nlohmann::json& record) {
  const std::string line = dump_line(record) + '\n';
  for (std::size_t at = 0; at < line.size();) {
    const ssize_t n = ::write(fd_, line.data() + at, line.size() - at);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) {
      const int error = n < 0 ? errno : ENOSPC;
      if (::ftruncate(fd_, static_cast<off_t>(size_)) != 0) {
        // The torn line stays and is cut off on --resume.
      }
      fail_write(file_, error);
    }
    at += static_cast<std::size_t>(n);
  }
  // A disk that reports "full" only now has the line in memory but not on disk.
  if (::fdatasync(fd_) != 0 && errno != EINVAL) fail_write(file_, errno);
  JournalEntry entry{record.at("id"), record.at("status"), record.value("fingerprint", ""), size_,
                     line.size() - 1};
  entries_[entry.id] = entry;
  size_ += line.size();
}

void for_each_point(const std::filesystem::path& run_folder,
                    const std::function<void(const nlohmann::json&)>& visit) {
  const auto file = run_folder / "points.jsonl";
  std::ifstream in(file, std::ios::binary);
  if (!in)
    throw InputError(
        fmt::format("{}: cannot be read; is {} the folder of a run?", file.string(), run_folder.string()));
  // First the last line of each id, then those lines: a record may be large, their number is not.
  std::map<std::string, std::size_t> last;
  std::string line;
  const auto parse = [&]() -> nlohmann::json {
    auto json = nlohmann::json::parse(line, nullptr, false);
    return json.is_object() && json.contains("id") && json["id"].is_string() && json.contains("status")
               ? json
               : nlohmann::json();
  };
  std::size_t number = 0;
  for (; std::getline(in, line); ++number)
    if (const auto json = parse(); !json.is_null()) last[json["id"]] = number;
  in.clear();
  in.seekg(0);
  for (number = 0; std::getline(in, line); ++number)
    if (const auto json = parse(); !json.is_null() && last[json["id"]] == number) visit(json);
}

}  // namespace penumbra::run
