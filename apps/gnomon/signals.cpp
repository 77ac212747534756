#include "signals.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>
#include <mutex>
#include <thread>

namespace gnomon::app {
namespace {

struct State {
  std::recursive_mutex mutex;  // the thread that stops the program keeps it
  Unfinished unfinished;
  bool published = false;
};

// Never destroyed: a signal may come while main returns.
State& state() {
  static State& s = *new State;
  return s;
}

// Writers are still at work in the folder and may add files while it is being emptied; without a
// folder to write to they soon cannot.
constexpr int kAttempts = 1000;

[[noreturn]] void stop(int signal) {
  state().mutex.lock();
  remove_unfinished(state().unfinished);
  if (isatty(STDERR_FILENO)) std::fputs("\r\x1b[K", stderr);  // a progress bar
  std::fprintf(stderr, "gnomon: stopped by %s; %s\n",
               signal == SIGINT   ? "Ctrl-C"
               : signal == SIGHUP ? "the end of its terminal"
                                  : "a request to end (SIGTERM)",
               state().published ? "its results are complete" : "nothing of this run was written");
  _exit(128 + signal);  // no destructors: other threads use what they would destroy
}

}  // namespace

void stop_on_signals() {
  sigset_t wanted;
  sigemptyset(&wanted);
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction now {};
    if (sigaction(signal, nullptr, &now) == 0 && now.sa_handler != SIG_IGN) {
      sigaddset(&wanted, signal);
    }
  }
  pthread_sigmask(SIG_BLOCK, &wanted, nullptr);  // other threads inherit it
  std::thread([wanted] {
    int signal = 0;
    while (sigwait(&wanted, &signal) != 0) {
    }
    stop(signal);
  }).detach();
}

SignalsWait::SignalsWait() { state().mutex.lock(); }
SignalsWait::~SignalsWait() { state().mutex.unlock(); }

void remove_unfinished(const Unfinished& unfinished) {
  std::error_code ignored;
  for (const auto& path : unfinished.paths) {
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      std::filesystem::remove_all(path, ignored);
      if (!std::filesystem::exists(path, ignored)) break;
    }
  }
  for (auto folder = unfinished.folders.rbegin(); folder != unfinished.folders.rend(); ++folder) {
    if (::rmdir(folder->c_str()) != 0) break;  // not empty: there are results in it
  }
}

void set_unfinished(Unfinished unfinished) {
  const SignalsWait wait;
  state().unfinished = std::move(unfinished);
}

void note_published() {
  const SignalsWait wait;
  state().published = true;
}

void clear_unfinished() {
  const SignalsWait wait;
  remove_unfinished(state().unfinished);
  state().unfinished = {};
}

}  // namespace gnomon::app
