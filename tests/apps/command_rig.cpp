#include "tests/apps/command_rig.h"
#include "tests/file_bytes.h"

#include <fcntl.h>
#include <json/reader.h>
#include <sys/wait.h>
#include <unistd.h>

#include <fstream>

namespace repose {
namespace {

/// In the child: standard output into the pipe, standard error into a file, then the program.
[[noreturn]] void become(const std::vector<std::string>& words, int out, const std::string& err) {
  const int errors = open(err.c_str(), O_CREAT | O_WRONLY | O_TRUNC, 0666);
  dup2(out, STDOUT_FILENO);
  dup2(errors, STDERR_FILENO);
  std::vector<char*> arguments;
  for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
  arguments.push_back(nullptr);
  execvp(arguments[0], arguments.data());
  _exit(127);
}

}  // namespace

void CommandTest::SetUp() {
  unsetenv("REPOSE_TARGET");
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  folder_ = std::filesystem::temp_directory_path() /
            ("repose_" + std::string(test->name()) + "_" + std::to_string(::getpid()));
  std::filesystem::create_directories(folder_);
}

void CommandTest::TearDown() {
  std::filesystem::remove_all(folder_);
}

std::string CommandTest::write(const std::string& name, const std::string& text) const {
  std::ofstream(path(name), std::ios::binary) << text;
  return path(name);
}

std::string CommandTest::tiny_scene(const std::string& more) const {
  return write("tiny.json", R"({"repose": 1, "name": "tiny", "grid": {"spacing": 0.02},
  "time": {"frames": 10, "frames_per_second": 100},
  "materials": {"sand": {"type": "drucker_prager"}},
  "bodies": [{"name": "box", "material": "sand",
              "shape": {"type": "box", "lower": [0, 0.02, 0], "upper": [0.1, 0.12, 0.1]}}],
  "colliders": [{"name": "ground", "shape": {"type": "plane"}, "friction": 0.4}])" +
                                more + "}\n");
}

Finished CommandTest::repose(const std::vector<std::string>& words, const LineCallback& each_line) const {
  std::vector<std::string> all{REPOSE_COMMAND};
  all.insert(all.end(), words.begin(), words.end());
  return run_program(all, each_line);
}

Finished CommandTest::run_program(std::vector<std::string> words, const LineCallback& each_line) const {
  int ends[2] = {-1, -1};
  EXPECT_EQ(pipe2(ends, O_CLOEXEC), 0);
  const pid_t process = fork();
  if (process == 0) become(words, ends[1], path("stderr"));
  close(ends[1]);
  Finished finished;
  std::size_t line = 0;
  char buffer[4096];
  for (ssize_t count; (count = read(ends[0], buffer, sizeof buffer)) > 0;) {
    finished.out.append(buffer, static_cast<std::size_t>(count));
    for (std::size_t end; (end = finished.out.find('\n', line)) != std::string::npos; line = end + 1) {
      if (each_line) each_line(process, finished.out.substr(line, end - line));
    }
  }
  close(ends[0]);
  int status = 0;
  waitpid(process, &status, 0);
  finished.code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  finished.err = bytes_of(path("stderr"));
  return finished;
}

std::string CommandTest::refusal(int code, const std::vector<std::string>& words) const {
  const Finished finished = repose(words);
  EXPECT_EQ(finished.code, code) << finished.err;
  EXPECT_EQ(finished.out, "");
  EXPECT_EQ(finished.err.rfind("repose: error: ", 0), 0u) << finished.err;
  EXPECT_EQ(finished.err.find('\n'), finished.err.size() - 1) << "one line, not: " << finished.err;
  return finished.err;
}

std::string CommandTest::refused_override(int code, const std::string& override) const {
  return refusal(code, {"run", tiny_scene(), "--out", path("out"), "--set", override});
}

Json::Value CommandTest::read_json(const std::string& file) const {
  std::ifstream stream(file);
  Json::Value json;
  std::string errors;
  EXPECT_TRUE(Json::parseFromStream(Json::CharReaderBuilder(), stream, &json, &errors))
      << file << ": " << errors;
  return json;
}

std::string CommandTest::hash_of_last_frame(const std::string& folder) const {
  const Json::Value frames = read_json(folder + "/run.json")["frames"];
  return frames.empty() ? "no frames" : frames[frames.size() - 1]["hash"].asString();
}

}  // namespace repose
