#include "apps/repose/child_runs.h"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <thread>

namespace repose {
namespace {

/// In the child: silent but for errors, and gone when its parent is.
[[noreturn]] void become(char* const* words, const char* errors) {
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  std::signal(SIGINT, SIG_DFL);
  std::signal(SIGTERM, SIG_DFL);
  const int nothing = open("/dev/null", O_RDWR), out = open(errors, O_CREAT | O_WRONLY | O_TRUNC, 0666);
  dup2(nothing, STDIN_FILENO);
  dup2(nothing, STDOUT_FILENO);
  dup2(out < 0 ? nothing : out, STDERR_FILENO);
  execv("/proc/self/exe", words);
  _exit(127);
}

std::string last_line(const std::string& path) {
  std::ifstream file(path);
  std::string line, last;
  while (std::getline(file, line)) {
    if (!line.empty()) last = line;
  }
  return last;
}

}  // namespace

std::string status_text(int status) {
  if (WIFEXITED(status)) return "exit code " + std::to_string(WEXITSTATUS(status));
  return "killed by signal " + std::to_string(WTERMSIG(status)) + " (" + strsignal(WTERMSIG(status)) + ")";
}

bool ChildRuns::start(std::size_t job, const std::vector<std::string>& words, const std::string& errors) {
  std::vector<std::string> all{"repose"};
  all.insert(all.end(), words.begin(), words.end());
  std::vector<char*> pointers;
  for (std::string& word : all) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  const pid_t process = fork();
  if (process < 0) return false;
  if (process == 0) become(pointers.data(), errors.c_str());
  running_.push_back({process, job, errors});
  return true;
}

bool ChildRuns::next(ChildEnd& end) {
  for (auto child = running_.begin(); child != running_.end(); ++child) {
    int status = 0;
    if (waitpid(child->process, &status, WNOHANG) != child->process) continue;
    end = {child->job, status, last_line(child->errors)};
    std::error_code ignored;
    std::filesystem::remove(child->errors, ignored);
    running_.erase(child);
    return true;
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  return false;
}

void ChildRuns::stop() {
  for (const Child& child : running_) kill(child.process, SIGKILL);
  for (const Child& child : running_) {
    waitpid(child.process, nullptr, 0);
    std::error_code ignored;
    std::filesystem::remove(child.errors, ignored);
  }
  running_.clear();
}

}  // namespace repose
