#include "run/worker_process.h"

#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>
#include <nlohmann/json.hpp>
#include <system_error>

#include "run/record.h"

extern char** environ;

namespace penumbra::run {
namespace {

struct Pipe {
  int read_end = -1, write_end = -1;
  Pipe() {
    int ends[2];
    if (::pipe2(ends, O_CLOEXEC) != 0) throw std::system_error(errno, std::generic_category(), "pipe");
    read_end = ends[0], write_end = ends[1];
  }
};

void close_if_open(int& fd) {
  if (fd >= 0) ::close(fd);
  fd = -1;
}

// In the child, between fork and exec: only calls that are safe there.
[[noreturn]] void become_worker(char* const* argv, char* const* env, pid_t parent, int jobs, int events,
                                int errors, int heartbeat) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(127);  // it died before the line above
  // When memory runs out the kernel is to take the worker, not the supervisor that holds the sweep together.
  if (const int oom = ::open("/proc/self/oom_score_adj", O_WRONLY); oom >= 0) {
    if (::write(oom, "800", 3) < 0) ::_exit(127);
    ::close(oom);
  }
  sigset_t none;
  ::sigemptyset(&none);
  ::sigprocmask(SIG_SETMASK, &none, nullptr);
  for (int s : {SIGINT, SIGTERM, SIGPIPE}) ::signal(s, SIG_DFL);
  // First out of the way of the numbers that are about to be taken.
  const int from[] = {::fcntl(jobs, F_DUPFD_CLOEXEC, 16), ::fcntl(errors, F_DUPFD_CLOEXEC, 16),
                      ::fcntl(errors, F_DUPFD_CLOEXEC, 16), ::fcntl(events, F_DUPFD_CLOEXEC, 16),
                      ::fcntl(heartbeat, F_DUPFD_CLOEXEC, 16)};
  const int to[] = {STDIN_FILENO, STDOUT_FILENO, STDERR_FILENO, worker_events_fd, worker_heartbeat_fd};
  for (int i = 0; i < 5; ++i)
    if (::dup2(from[i], to[i]) < 0) ::_exit(127);
  ::execve(argv[0], argv, env);
  ::_exit(127);
}

}  // namespace

WorkerProcess::WorkerProcess(const std::vector<std::string>& command,
                             const std::vector<std::string>& environment) {
  ::signal(SIGPIPE, SIG_IGN);  // a dead worker is noticed by send()
  start(command, environment);
}

void WorkerProcess::start(const std::vector<std::string>& command,
                          const std::vector<std::string>& environment) {
  std::vector<char*> argv, env;
  for (const auto& a : command) argv.push_back(const_cast<char*>(a.c_str()));
  argv.push_back(nullptr);
  // The first assignment of a name is the one that getenv() finds.
  for (const auto& e : environment) env.push_back(const_cast<char*>(e.c_str()));
  for (char** e = environ; *e; ++e) env.push_back(*e);
  env.push_back(nullptr);
  Pipe jobs, events, errors;
  const pid_t parent = ::getpid();
  pid_ = ::fork();
  if (pid_ == 0)
    become_worker(argv.data(), env.data(), parent, jobs.read_end, events.write_end, errors.write_end,
                  heartbeat_.fd());
  const int error = errno;
  for (int fd : {jobs.read_end, events.write_end, errors.write_end}) ::close(fd);
  jobs_ = jobs.write_end, events_ = events.read_end, errors_ = errors.read_end;
  if (pid_ < 0) throw std::system_error(error, std::generic_category(), "starting a worker");
  for (int fd : {events_, errors_}) ::fcntl(fd, F_SETFL, O_NONBLOCK);
}

WorkerProcess::~WorkerProcess() {
  kill();
  if (!reaped_) ::waitpid(pid_, &status_, 0);
  close_if_open(jobs_);
  close_if_open(events_);
  close_if_open(errors_);
}

void WorkerProcess::kill() {
  if (reaped_) return;
  ::kill(-pid_, SIGKILL);  // with whatever a driver started in its group
  ::kill(pid_, SIGKILL);
}

bool WorkerProcess::send(const nlohmann::json& job) {
  const std::string line = dump_line(job) + '\n';
  for (std::size_t at = 0; at < line.size();) {
    const ssize_t n = ::write(jobs_, line.data() + at, line.size() - at);
    if (n < 0 && errno == EINTR) continue;
    if (n <= 0) return false;
    at += static_cast<std::size_t>(n);
  }
  return true;
}

void WorkerProcess::read_events(std::vector<nlohmann::json>& events) {
  char buffer[65536];
  ssize_t n;
  while ((n = ::read(events_, buffer, sizeof buffer)) > 0)
    partial_.append(buffer, static_cast<std::size_t>(n));
  if (n == 0) close_if_open(events_);
  std::size_t begin = 0;
  for (std::size_t end; (end = partial_.find('\n', begin)) != std::string::npos; begin = end + 1) {
    const std::string_view line(partial_.data() + begin, end - begin);
    if (auto json = nlohmann::json::parse(line, nullptr, false); json.is_object())
      events.push_back(std::move(json));
    else
      messages_.append(line).append("\n");
  }
  partial_.erase(0, begin);
}

void WorkerProcess::read_messages() {
  char buffer[4096];
  ssize_t n;
  while ((n = ::read(errors_, buffer, sizeof buffer)) > 0)
    messages_.append(buffer, static_cast<std::size_t>(n));
  if (n == 0) close_if_open(errors_);
  if (messages_.size() > 16384) messages_.erase(0, messages_.size() - 8192);
}

std::vector<nlohmann::json> WorkerProcess::wait(int timeout_ms) {
  std::vector<nlohmann::json> events;
  pollfd fds[] = {{events_, POLLIN, 0}, {errors_, POLLIN, 0}};  // poll() skips negative descriptors
  if (::poll(fds, 2, timeout_ms) <= 0) return events;
  if (events_ >= 0 && fds[0].revents) read_events(events);
  if (errors_ >= 0 && fds[1].revents) read_messages();
  return events;
}

bool WorkerProcess::ended() {
  // The event pipe closes with the worker; standard error may be held open by something it left behind.
  if (events_ >= 0) return false;
  if (!reaped_) {
    ::waitpid(pid_, &status_, 0);
    reaped_ = true;
    ::kill(-pid_, SIGKILL);
    if (errors_ >= 0) read_messages();
  }
  return true;
}

uint64_t WorkerProcess::resident_bytes() const {
  std::ifstream statm(fmt::format("/proc/{}/statm", pid_));
  uint64_t total = 0, resident = 0;
  statm >> total >> resident;
  return resident * static_cast<uint64_t>(::sysconf(_SC_PAGESIZE));
}

std::string WorkerProcess::how_it_ended() const {
  if (WIFSIGNALED(status_))
    return fmt::format("killed by signal {} ({})", WTERMSIG(status_), ::strsignal(WTERMSIG(status_)));
  return fmt::format("ended with exit code {}", WEXITSTATUS(status_));
}

int WorkerProcess::signal() const { return WIFSIGNALED(status_) ? WTERMSIG(status_) : 0; }
int WorkerProcess::exit_code() const { return WIFSIGNALED(status_) ? -1 : WEXITSTATUS(status_); }

std::string WorkerProcess::last_messages() const {
  std::size_t begin = messages_.size() > 2048 ? messages_.size() - 2048 : 0;
  if (begin > 0) begin = messages_.find('\n', begin) + 1;  // npos + 1 = 0: one very long line stays whole
  std::size_t end = messages_.size();
  while (end > begin && messages_[end - 1] == '\n') --end;
  return messages_.substr(begin, end - begin);
}

}  // namespace penumbra::run
