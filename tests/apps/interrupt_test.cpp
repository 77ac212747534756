// Runs that are stopped: by Ctrl-C, by SIGTERM, by SIGKILL.
#include <gtest/gtest.h>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <functional>
#include <map>
#include <random>
#include <thread>
#include <vector>

#include <nlohmann/json.hpp>

#include <apps/program.h>

namespace {

namespace fs = std::filesystem;
using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// Content by name relative to the folder; what lies in unfinished folders is nobody's result.
using Files = std::map<std::string, std::string>;

class Interrupt : public gnomon::testing::Program {
 protected:
  void SetUp() override {
    Program::SetUp();
    setenv("OGR_CURRENT_DATE", "2024-01-01T00:00:00Z", 1);  // GeoPackages hold the time
  }
  void TearDown() override {
    unsetenv("OGR_CURRENT_DATE");
    Program::TearDown();
  }

  std::vector<std::string> command(const std::string& title, const std::string& output) const {
    return {GNOMON_PROGRAM,
            "profile",
            GNOMON_SCENES "/vienna/vienna.city.jsonl",
            "--crs",
            "EPSG:31256",
            "--date",
            "2024-09-18",
            "--from",
            "11:00",
            "--to",
            "12:00",
            "--tz",
            "Europe/Vienna",
            "--pixel",
            "16",
            "--title",
            title,
            "--bounds",
            "1150,340600,1350,340800",
            "--no-cast",
            "WallSurface",
            "-o",
            output};
  }

  pid_t start(const std::string& title, const std::string& output) {
    std::vector<std::string> words = command(title, output);
    std::vector<char*> arguments;
    for (std::string& w : words) arguments.push_back(w.data());
    arguments.push_back(nullptr);
    const std::string err = (folder_ / "err").string();
    const pid_t child = fork();
    if (child == 0) {
      for (const int s : {SIGINT, SIGTERM, SIGHUP}) std::signal(s, SIG_DFL);  // as from a terminal
      dup2(open("/dev/null", O_WRONLY), STDOUT_FILENO);
      dup2(open(err.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600), STDERR_FILENO);
      execv(arguments[0], arguments.data());
      _exit(127);
    }
    return child;
  }

  // Exit code, or minus the signal that ended it.
  int wait_for(pid_t child) {
    int status = 0;
    waitpid(child, &status, 0);
    err_ = text(folder_ / "err");
    return WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  }

  int finish(const std::string& title, const std::string& output) {
    return wait_for(start(title, output));
  }

  static bool is_unfinished(const fs::path& path) {
    return path.filename().string().starts_with("unfinished-");
  }
  static std::size_t unfinished(const fs::path& folder) {
    return static_cast<std::size_t>(
        std::count_if(fs::directory_iterator(folder), fs::directory_iterator(),
                      [](const auto& entry) { return is_unfinished(entry.path()); }));
  }

  static Files files(const fs::path& folder) {
    Files found;
    for (auto at = fs::recursive_directory_iterator(folder);
         at != fs::recursive_directory_iterator(); ++at) {
      if (is_unfinished(at->path())) {
        at.disable_recursion_pending();
        continue;
      }
      std::string content = text(at->path());
      if (at->path().extension() == ".json") {  // the times of the run differ each time
        auto json = nlohmann::json::parse(content, nullptr, false);
        EXPECT_FALSE(json.is_discarded()) << at->path() << " is not whole";
        if (json.is_object()) json.erase("timings");
        content = json.dump();
      }
      found[fs::relative(at->path(), folder).string()] = content;
    }
    return found;
  }

  // Waits until `is_so`, at most until the child ends.
  static bool wait_until(pid_t child, const std::function<bool()>& is_so) {
    while (!is_so()) {
      siginfo_t info{};
      if (waitid(P_PID, static_cast<id_t>(child), &info, WEXITED | WNOHANG | WNOWAIT) != 0 ||
          info.si_pid != 0) {
        return is_so();
      }
    }
    return true;
  }
};

TEST_F(Interrupt, StoppedAtAnyMomentItLeavesWholeFilesAndTheNextRunIsComplete) {
  const std::string a = (folder_ / "a").string(), b = (folder_ / "b").string();
  ASSERT_EQ(finish("first", a), 0) << err_;
  const Clock::time_point begin = Clock::now();
  ASSERT_EQ(finish("second", b), 0) << err_;
  const double whole = std::chrono::duration<double>(Clock::now() - begin).count();
  const Files first = files(a), second = files(b);
  ASSERT_EQ(first.size(), 9u);
  ASSERT_NE(first, second);

  ASSERT_EQ(finish("first", results()), 0) << err_;
  std::mt19937 random(20240918);
  constexpr int kMoments = 12;
  int stopped = 0;
  for (int k = 0; k < kMoments; ++k) {
    const int signal = k % 2 == 0 ? SIGINT : SIGKILL;
    // Each twelfth of the run has its moment.
    const double share = (k + std::uniform_real_distribution<>(0, 1)(random)) / kMoments;
    const pid_t child = start("second", results());
    std::this_thread::sleep_for(std::chrono::duration<double>(share * whole));
    kill(child, signal);
    const int code = wait_for(child);
    const Files now = files(results());
    ASSERT_EQ(now.size(), first.size()) << "signal " << signal << " after " << share;
    for (const auto& [name, content] : now) {
      EXPECT_TRUE(content == first.at(name) || content == second.at(name)) << name;
    }
    if (signal == SIGINT) {
      // One that comes before main has begun meets the default.
      EXPECT_TRUE(code == 130 || code == 0 || (code == -SIGINT && err_.empty())) << code;
      stopped += code == 130;
      if (code == 130) {
        EXPECT_NE(err_.find("stopped by Ctrl-C"), std::string::npos) << err_;
        EXPECT_EQ(err_.find("error"), std::string::npos) << err_;
      }
      EXPECT_TRUE(now == first || now == second) << "files of two runs";
    }
    EXPECT_LE(unfinished(results()), 1u);
    if (now != first) {
      ASSERT_EQ(finish("first", results()), 0) << err_;
    }
  }
  EXPECT_GT(stopped, 0);
  ASSERT_EQ(finish("second", results()), 0) << err_;
  EXPECT_EQ(files(results()), second);
  EXPECT_EQ(unfinished(results()), 0u);
}

TEST_F(Interrupt, CtrlCBeforeTheEndLeavesNoFolderThatWasNotThere) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const fs::path output = folder_ / "new" / "folder";
    const pid_t child = start("t", output.string());
    ASSERT_TRUE(wait_until(child, [&] { return fs::exists(output) && unfinished(output) == 1; }));
    kill(child, signal);
    EXPECT_EQ(wait_for(child), 128 + signal);
    EXPECT_NE(err_.find("stopped by"), std::string::npos) << err_;
    EXPECT_NE(err_.find("nothing of this run was written"), std::string::npos) << err_;
    EXPECT_FALSE(fs::exists(folder_ / "new"));
  }
}

TEST_F(Interrupt, CtrlCWhileResultsArePublishedWaitsForTheLastOfThem) {
  ASSERT_EQ(finish("first", results()), 0) << err_;
  const Files first = files(results());
  const auto inode = [&] {
    struct stat s {};
    return stat((results() + "/profile.tif").c_str(), &s) == 0 ? s.st_ino : 0;
  };
  const auto old = inode();
  const pid_t child = start("second", results());
  ASSERT_TRUE(wait_until(child, [&] { return inode() != old; }));
  kill(child, SIGINT);
  const int code = wait_for(child);
  EXPECT_TRUE(code == 130 || code == 0) << code;
  if (code == 130) {
    EXPECT_NE(err_.find("its results are complete"), std::string::npos) << err_;
  }
  const Files now = files(results());
  for (const char* name : {"profile.tif", "plan.png", "view.png", "summary.json"})
    EXPECT_TRUE(fs::exists(fs::path(results()) / name)) << name;
  EXPECT_NE(now.at("plan.png"), first.at("plan.png"));
  EXPECT_NE(now.at("view.png"), first.at("view.png")) << "published late";
  EXPECT_EQ(unfinished(results()), 0u);
}

TEST_F(Interrupt, FoldersOfRunsThatLiveAreKeptAndThoseOfDeadOnesGo) {
  const fs::path alive = fs::path(results()) / "unfinished-1.tmp",
                 dead = fs::path(results()) / "unfinished-999999999.tmp";
  fs::create_directories(alive);
  fs::create_directories(dead / "2024-03-21");
  std::ofstream(alive / "profile.tif") << "half";
  std::ofstream(dead / "2024-03-21" / "profile.tif") << "half";
  const int lock = open(alive.c_str(), O_RDONLY | O_DIRECTORY | O_CLOEXEC);
  ASSERT_GE(lock, 0);
  ASSERT_EQ(flock(lock, LOCK_EX), 0);
  ASSERT_EQ(finish("t", results()), 0) << err_;
  EXPECT_TRUE(fs::exists(alive / "profile.tif"));
  EXPECT_FALSE(fs::exists(dead));
  close(lock);
  ASSERT_EQ(finish("t", results()), 0) << err_;
  EXPECT_FALSE(fs::exists(alive));
}

TEST_F(Interrupt, CtrlCStopsConvertWithoutATemporary) {
  const std::string obj = (folder_ / "v.obj").string();
  const std::string command =
      std::string("\"" GNOMON_PROGRAM "\" convert ") + vienna_ + " -o " + obj;
  for (const int after : {50, 150, 300, 450}) {
    const pid_t child = fork();
    if (child == 0) {
      std::signal(SIGINT, SIG_DFL);
      dup2(open("/dev/null", O_WRONLY), STDOUT_FILENO);
      dup2(open("/dev/null", O_WRONLY), STDERR_FILENO);
      execl("/bin/sh", "sh", "-c", ("exec " + command).c_str(), nullptr);
      _exit(127);
    }
    std::this_thread::sleep_for(milliseconds(after));
    kill(child, SIGINT);
    (void)wait_for(child);
    for (const auto& entry : fs::directory_iterator(folder_))
      EXPECT_EQ(entry.path().filename().string().find(".tmp-"), std::string::npos) << entry.path();
  }
}

}  // namespace
