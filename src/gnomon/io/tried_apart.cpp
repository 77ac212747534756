#include <fcntl.h>
#include <gnomon/io/tried_apart.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <exception>
#include <fstream>

namespace gnomon {
namespace {

constexpr std::size_t kLongestAnswer = 4000;  // bytes; a pipe holds more, so that nobody waits

void set_limit(int resource, rlim_t most) {
  rlimit limit{};
  if (getrlimit(resource, &limit) != 0) return;
  if (limit.rlim_max != RLIM_INFINITY && most > limit.rlim_max) most = limit.rlim_max;
  limit.rlim_cur = most;
  setrlimit(resource, &limit);
}

#ifndef __SANITIZE_ADDRESS__
// Pages of address space now.
std::uint64_t pages_in_use() {
  std::uint64_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  return pages;
}
#endif

[[noreturn]] void run_child(const std::function<std::string()>& work, const TrialLimits& limits,
                            int answer_to) {
  const int nowhere = open("/dev/null", O_WRONLY);
  dup2(nowhere, STDOUT_FILENO);
  dup2(nowhere, STDERR_FILENO);
  // Whoever stops the parent stops its trial: the parent may block signals, or be killed.
  sigset_t none;
  sigemptyset(&none);
  sigprocmask(SIG_SETMASK, &none, nullptr);
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  for (const int s : {SIGABRT, SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGXCPU}) signal(s, SIG_DFL);
  set_limit(RLIMIT_CORE, 0);
  set_limit(RLIMIT_CPU, limits.seconds);
#ifndef __SANITIZE_ADDRESS__
  set_limit(RLIMIT_AS,
            pages_in_use() * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE)) + limits.bytes);
#endif
  std::string answer;
  try {
    answer = work().substr(0, kLongestAnswer);
  } catch (const std::exception& e) {
    answer = e.what();
  }
  const bool written =
      write(answer_to, answer.data(), answer.size()) == static_cast<ssize_t>(answer.size());
  _exit(written ? 0 : 1);  // no destructors and buffers of the parent
}

}  // namespace

std::string tried_apart(const std::function<std::string()>& work, const TrialLimits& limits) {
  const std::string cannot = "no process can be started to try it out";
  int ends[2];
  if (pipe2(ends, O_CLOEXEC) != 0) return cannot;
  const pid_t child = fork();
  if (child == 0) {
    close(ends[0]);
    run_child(work, limits, ends[1]);
  }
  close(ends[1]);
  std::string answer;
  if (child > 0) {
    char block[512];
    while (true) {
      const ssize_t got = read(ends[0], block, sizeof block);
      if (got < 0 && errno == EINTR) continue;
      if (got <= 0) break;
      answer.append(block, static_cast<std::size_t>(got));
    }
  }
  close(ends[0]);
  if (child < 0) return cannot;
  int status = 0;
  while (waitpid(child, &status, 0) < 0) {
    if (errno != EINTR) return cannot;
  }
  if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return answer;
  if (WIFSIGNALED(status) && (WTERMSIG(status) == SIGXCPU || WTERMSIG(status) == SIGKILL)) {
    return "its reader does not come to an end with it";
  }
  return "its reader crashes on it";
}

}  // namespace gnomon
