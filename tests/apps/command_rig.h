// Repose tests: what the tests of the command share: they run the real program in a folder of their own and
// look at what it prints, how it ends and what it leaves.
#pragma once

#include <gtest/gtest.h>
#include <json/value.h>
#include <sys/types.h>

#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace repose {

/// How a program ended.
struct Finished {
  int code = -1;  ///< exit code; 128 + signal if one killed it
  std::string out, err;
};

/// Called with each line that the program prints, as it comes.
using LineCallback = std::function<void(pid_t process, const std::string& line)>;

class CommandTest : public ::testing::Test {
 protected:
  void SetUp() override;
  void TearDown() override;

  /// A path below the test's folder.
  std::string path(const std::string& name) const { return (folder_ / name).string(); }
  /// Writes a file below the test's folder and gives its path.
  std::string write(const std::string& name, const std::string& text) const;
  /// A box of 1000 particles of sand that falls 2 cm on a plane and slumps: 10 frames of about 15 steps. `more`
  /// is put before the closing brace.
  std::string tiny_scene(const std::string& more = "") const;

  /// Runs `repose` with these words, or another program.
  Finished repose(const std::vector<std::string>& words, const LineCallback& each_line = {}) const;
  Finished run_program(std::vector<std::string> words, const LineCallback& each_line = {}) const;

  /// Runs a command that must fail with `code` and one message of one line; returns the message.
  std::string refusal(int code, const std::vector<std::string>& words) const;
  /// The same for `run` of the tiny scene with an override.
  std::string refused_override(int code, const std::string& override) const;

  Json::Value read_json(const std::string& file) const;
  std::string hash_of_last_frame(const std::string& folder) const;

  std::filesystem::path folder_;
};

}  // namespace repose
