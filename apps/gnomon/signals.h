// Ctrl-C and other polite requests to stop: what is unfinished is removed, then the program ends.
//
// A thread of its own waits for the signals, which are blocked everywhere else, so that what it
// does need not be async-signal-safe; the computation is not asked and need not answer.
#pragma once

#include <filesystem>
#include <vector>

namespace gnomon::app {

// To be removed when the program is stopped.
struct Unfinished {
  std::vector<std::filesystem::path> paths = {};    // files, or folders with all that is in them
  std::vector<std::filesystem::path> folders = {};  // made for them, the outermost first; those
                                                    // that are empty then go as well
};

// Call at the start of main, before there are other threads. On SIGINT, SIGTERM or SIGHUP (where
// not ignored, as under nohup): removes what is unfinished, prints a line and exits with 128 + the
// signal's number.
void stop_on_signals();

// While one lives, a signal waits. May be nested within a thread.
class SignalsWait {
 public:
  SignalsWait();
  ~SignalsWait();
  SignalsWait(const SignalsWait&) = delete;
  SignalsWait& operator=(const SignalsWait&) = delete;
};

void remove_unfinished(const Unfinished& unfinished);
void set_unfinished(Unfinished unfinished);  // replaces what was set
void clear_unfinished();                     // removes it, too
void note_published();                       // the results are complete

}  // namespace gnomon::app
