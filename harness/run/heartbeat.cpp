#include "run/heartbeat.h"

#include <sys/mman.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstring>
#include <system_error>

namespace penumbra::run {
namespace {

int64_t now_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::steady_clock::now().time_since_epoch())
      .count();
}

template <std::size_t N>
void put(char (&field)[N], std::string_view text) {
  const std::size_t n = std::min(text.size(), N - 1);
  std::memcpy(field, text.data(), n);
  field[n] = '\0';
}

// The writer may have died between two stores: never read past the field.
template <std::size_t N>
std::string get(const char (&field)[N]) {
  return std::string(field, strnlen(field, N));
}

}  // namespace

Heartbeat::Heartbeat() : fd_(::memfd_create("penumbra-heartbeat", MFD_CLOEXEC)) {
  if (fd_ < 0 || ::ftruncate(fd_, sizeof(Page)) != 0)
    throw std::system_error(errno, std::generic_category(), "shared page");
  map();
}

Heartbeat::Heartbeat(int fd) : fd_(fd) { map(); }

void Heartbeat::map() {
  void* memory = ::mmap(nullptr, sizeof(Page), PROT_READ | PROT_WRITE, MAP_SHARED, fd_, 0);
  if (memory == MAP_FAILED) throw std::system_error(errno, std::generic_category(), "shared page");
  page_ = static_cast<Page*>(memory);
}

Heartbeat::~Heartbeat() {
  ::munmap(page_, sizeof(Page));
  ::close(fd_);
}

void Heartbeat::enter_point(std::string_view id) {
  limit(0);
  stage("");
  put(page_->point, id);
}

void Heartbeat::stage(std::string_view name) {
  put(page_->pass, "");
  put(page_->stage, name);
}

void Heartbeat::pass(std::string_view name) { put(page_->pass, name); }

void Heartbeat::limit(double seconds) {
  page_->deadline_ns.store(seconds > 0 ? now_ns() + static_cast<int64_t>(seconds * 1e9) : 0,
                           std::memory_order_release);
}

Heartbeat::State Heartbeat::read() const {
  State state{get(page_->point), get(page_->stage), get(page_->pass), 0};
  if (const int64_t deadline = page_->deadline_ns.load(std::memory_order_acquire); deadline > 0)
    state.over_limit_s = static_cast<double>(now_ns() - deadline) * 1e-9;
  return state;
}

void Heartbeat::clear() { enter_point(""); }

}  // namespace penumbra::run
