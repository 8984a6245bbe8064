// Repose: reads a VDB file and tells what it holds, under limits of memory and time:
//   repose-vdb-reader BYTES SECONDS float|vector|points|figures FILE [GRID]
// Files may be damaged, or made to do harm, and OpenVDB then crashes, hangs or takes all memory: it does so
// here, and the engine goes on. Nothing is for a user: what is told goes to standard output as
// engine/vdb/record.h says.
#include <signal.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <tbb/global_control.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>

#include "apps/vdb_reader/parse.h"
#include "engine/io/vdb_record.h"
#include "engine/vdb/question.h"

namespace {

using namespace repose;

void limit(__rlimit_resource what, rlim_t soft, rlim_t hard) {
  const rlimit both{soft, hard};
  if (::setrlimit(what, &both) != 0) std::_Exit(71);
}

void limit_all(rlim_t memory, rlim_t seconds) {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)  // they reserve terabytes
  limit(RLIMIT_AS, memory, memory);
#else
  static_cast<void>(memory);
#endif
  limit(RLIMIT_CPU, seconds, seconds + 1);
  limit(RLIMIT_CORE, 0, 0);
  limit(RLIMIT_FSIZE, 0, 0);
}

void tell(const std::string& what, const std::string& file, const std::string& grid, RecordWriter& record) {
  if (what == kVdbFloat) return tell_floats(file, grid, record);
  if (what == kVdbVector) return tell_vectors(file, grid, record);
  if (what == kVdbPoints) {
    const PointCloud points = parse_points(file);
    record.begin(RecordKind::kAnswer);
    return tell_points(record, points);
  }
  if (what == kVdbFigures) {
    const auto figures = parse_figures(file);
    record.begin(RecordKind::kAnswer);
    return tell_figures(record, figures);
  }
  throw Refusal{ErrorKind::kUsage, "the reader does not know what \"" + what + "\" is"};
}

/// False where something of an answer has been told already: it then stays without an end.
bool refuse(RecordWriter& record, ErrorKind kind, const std::string& why) {
  if (record.begun()) return false;
  record.begin(RecordKind::kRefusal);
  record.value(static_cast<std::int32_t>(kind));
  record.text(why);
  record.end();
  return true;
}

int answer(int argc, char** argv, RecordWriter& record) {
  try {
    tell(argv[3], argv[4], argc > 5 ? argv[5] : "", record);
    record.end();
    return 0;
  } catch (const Refusal& refusal) {
    return refuse(record, refusal.kind, refusal.why) ? 0 : 1;
  } catch (const std::bad_alloc&) {
    return refuse(record, ErrorKind::kMemory, "out of memory") ? 0 : 1;
  } catch (const std::exception& failure) {
    return refuse(record, ErrorKind::kNoInput, failure.what()) ? 0 : 1;
  }
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 5) {
    std::fprintf(stderr, "repose-vdb-reader is run by Repose, not by hand\n");
    return 64;
  }
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  limit_all(std::strtoull(argv[1], nullptr, 10), std::strtoull(argv[2], nullptr, 10));
  // What libraries print goes beside what is told.
  const int out = ::dup(STDOUT_FILENO);
  if (out < 0 || ::dup2(STDERR_FILENO, STDOUT_FILENO) < 0) return 71;
  // Threads take address space, and nothing here needs them.
  const tbb::global_control one_thread(tbb::global_control::max_allowed_parallelism, 1);
  RecordWriter record(out);
  const int code = answer(argc, argv, record);
  std::fflush(nullptr);
  ::_exit(code);  // freeing a large tree takes long
}
