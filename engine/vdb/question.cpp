#include "engine/vdb/question.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <new>
#include <system_error>

#include "engine/base/memory.h"
#include "engine/vdb/child.h"
#include "engine/vdb/find_reader.h"

namespace repose {
namespace {

using Clock = Child::Clock;

/// What no whole file passes: the most room that a byte of a file comes to is that of an inner node of vectors
/// with none of its own values, 65 times its bytes; where they are tiles of one value, that here is twice as
/// much.
constexpr double kLeastMemory = 512e6, kMemoryPerByte = 128.0;
constexpr double kLeastSeconds = 20.0, kBytesPerSecond = 4e6;

struct Limits {
  double memory, seconds;
};

Limits limits_of(const VdbReader& reader, const std::string& file) {
  std::error_code failure;
  const std::uintmax_t size = std::filesystem::file_size(file, failure);
  const double bytes = failure ? 0.0 : static_cast<double>(size);
  const double machine =
      static_cast<double>(::sysconf(_SC_PHYS_PAGES)) * static_cast<double>(::sysconf(_SC_PAGESIZE));
  const double most = std::min(kLeastMemory + kMemoryPerByte * bytes, 0.5 * machine);
  const double memory = reader.memory > 0.0 ? reader.memory : most;
  const double seconds = reader.seconds > 0.0 ? reader.seconds : kLeastSeconds + bytes / kBytesPerSecond;
  return {std::min(memory, 1e18), std::min(seconds, 1e8)};
}

std::string past_memory(const Limits& limits) {
  return "the reader ran past " + bytes_text(limits.memory);
}

std::string past_time(const Limits& limits) {
  char seconds[32];
  std::snprintf(seconds, sizeof seconds, "%.3g s", limits.seconds);
  return std::string("the reader ran past ") + seconds;
}

/// What became of a program that told no whole answer.
std::string how_it_ended(const std::optional<int>& status, const Limits& limits,
                         const std::string& last_words) {
  const std::string more = last_words.empty() ? "" : ": " + last_words;
  if (!status) return "the reader ended without an answer" + more;
  if (WIFSIGNALED(*status)) {
    const int signal = WTERMSIG(*status);
    if (signal == SIGXCPU) return past_time(limits);
    return "the reader crashed (signal " + std::to_string(signal) + ")" + more;
  }
  return "the reader ended with exit code " + std::to_string(WEXITSTATUS(*status)) + more;
}

std::string why_bad(const BadRecord& bad, Child& child, Clock::time_point until, const Limits& limits) {
  switch (bad.why) {
    case BadRecord::Why::kLate:
      return past_time(limits);
    case BadRecord::Why::kMuch:
      return past_memory(limits);
    case BadRecord::Why::kWrong:
      return "the reader told " + bad.what;
    case BadRecord::Why::kEnds:
      break;
  }
  const std::optional<int> status = child.end(until);
  if (Clock::now() >= until) return past_time(limits);
  return how_it_ended(status, limits, child.last_words());
}

}  // namespace

Result<void> ask_reader(const VdbReader& reader, const VdbQuestion& question,
                        const std::function<void(RecordReader&)>& take) {
  const auto program = find_reader(reader);
  if (!program) return Error{program.error().kind, program.error().text(), question.file};
  const Limits limits = limits_of(reader, question.file);
  const auto unread = [&question](const std::string& why) {
    return Error{question.unread, "cannot be read as a VDB file: " + why, question.file};
  };
  const auto until =
      Clock::now() + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(limits.seconds));
  char memory[32], seconds[32];
  std::snprintf(memory, sizeof memory, "%.0f", limits.memory);
  std::snprintf(seconds, sizeof seconds, "%.0f", std::ceil(limits.seconds));
  auto child = Child::start({*program, memory, seconds, question.what, question.file, question.grid});
  if (!child)
    return Error{child.error().kind, "no VDB file can be read: " + child.error().text(), question.file};
  try {
    RecordReader record(child->out(), until, static_cast<std::uint64_t>(limits.memory));
    if (record.begin() == RecordKind::kAnswer) {
      take(record);
      record.end();
      return {};
    }
    const auto kind = record.value<std::int32_t>();
    const std::string why = record.text();
    record.end();
    if (kind == static_cast<std::int32_t>(ErrorKind::kBadScene))
      return Error{ErrorKind::kBadScene, why, question.file};
    return unread(kind == static_cast<std::int32_t>(ErrorKind::kMemory) ? past_memory(limits) : why);
  } catch (const BadRecord& bad) {
    return unread(why_bad(bad, *child, until, limits));
  } catch (const std::bad_alloc&) {
    return Error{ErrorKind::kMemory, "not enough memory for what is in it", question.file};
  }
}

}  // namespace repose
