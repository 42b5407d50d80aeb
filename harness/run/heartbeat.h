// A page of memory that worker and supervisor share. The worker says where it is with plain stores - no
// system call disturbs what is being timed - and the page outlives any death of the worker, so that the
// supervisor can say which point and which pass it was in.
#pragma once
#include <atomic>
#include <cstdint>
#include <string>
#include <string_view>

namespace penumbra::run {

class Heartbeat {
 public:
  // Supervisor: a new page. Worker: the page behind an inherited descriptor. Throws std::system_error.
  Heartbeat();
  explicit Heartbeat(int fd);
  ~Heartbeat();
  Heartbeat(const Heartbeat&) = delete;
  Heartbeat& operator=(const Heartbeat&) = delete;
  int fd() const { return fd_; }

  // Worker's side. A point is active from enter_point() to leave_point().
  void enter_point(std::string_view id);
  void leave_point() { enter_point(""); }
  void stage(std::string_view name);  // "setup", "build", "first frame", "measure", ...; clears the pass
  void pass(std::string_view name);
  // What follows must end within `seconds`; 0: no limit.
  void limit(double seconds);

  // Supervisor's side.
  struct State {
    std::string point, stage, pass;
    double over_limit_s = 0;  // > 0: past its limit by so much
  };
  State read() const;
  void clear();

 private:
  struct Page {
    char point[40], stage[40], pass[80];
    std::atomic<int64_t> deadline_ns;  // of the monotonic clock, which all processes share; 0: none
  };
  void map();
  int fd_ = -1;
  Page* page_ = nullptr;
};

}  // namespace penumbra::run
