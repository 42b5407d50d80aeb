// A worker as the supervisor sees it: a child process, jobs in and events out as JSON lines, its messages,
// its end.
#pragma once
#include <sys/types.h>

#include <cstdint>
#include <nlohmann/json_fwd.hpp>
#include <string>
#include <vector>

#include "run/heartbeat.h"

namespace penumbra::run {

// Descriptors that a worker finds open beside standard input (jobs) and error (messages).
inline constexpr int worker_events_fd = 3, worker_heartbeat_fd = 4;

class WorkerProcess {
 public:
  // `command`: program and arguments. `environment`: "NAME=value", added to our own. The worker leads a
  // process group of its own (the terminal's Ctrl-C reaches the supervisor alone) and dies with the
  // supervisor, however that dies. Throws std::system_error.
  WorkerProcess(const std::vector<std::string>& command, const std::vector<std::string>& environment);
  ~WorkerProcess();  // kills it if it still runs
  WorkerProcess(const WorkerProcess&) = delete;
  WorkerProcess& operator=(const WorkerProcess&) = delete;

  // False when the worker no longer listens.
  bool send(const nlohmann::json& job);
  // Waits at most `timeout_ms` for events, less when a signal arrives. Lines that are no JSON count as
  // messages.
  std::vector<nlohmann::json> wait(int timeout_ms);
  // True once it has ended and everything it wrote has been handed out by wait().
  bool ended();
  void kill();

  const Heartbeat& heartbeat() const { return heartbeat_; }
  uint64_t resident_bytes() const;
  // "killed by signal 6 (Aborted)", "ended with exit code 3": after ended().
  std::string how_it_ended() const;
  int signal() const;     // that killed it; 0: none did
  int exit_code() const;  // -1 when a signal ended it
  // The end of what it wrote to standard output and error, for messages: whole lines, at most about 2 KiB.
  std::string last_messages() const;
  void forget_messages() { messages_.clear(); }

 private:
  void start(const std::vector<std::string>& command, const std::vector<std::string>& environment);
  void read_events(std::vector<nlohmann::json>& events);
  void read_messages();
  Heartbeat heartbeat_;
  pid_t pid_ = -1;
  int jobs_ = -1, events_ = -1, errors_ = -1, status_ = 0;
  bool reaped_ = false;
  std::string partial_, messages_;
};

}  // namespace penumbra::run
