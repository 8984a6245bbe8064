// Repose: the checkpoint file: a magic line, then chunks, each [name, size, checksum] and its bytes, little
// endian.
#include "engine/io/checkpoint.h"

#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <fstream>
#include <functional>
#include <type_traits>
#include <vector>

#include "engine/base/input_file.h"
#include "engine/io/atomic_file.h"

namespace repose {
namespace {

static_assert(std::endian::native == std::endian::little, "checkpoints are written as memory lies");

constexpr char kMagic[16] = "REPOSE STATE 5\n";

struct ChunkHead {
  char name[16] = {};
  std::uint64_t bytes = 0;
  std::uint64_t checksum = 0;
};

/// What the first chunk holds.
struct Head {
  char scene_hash[32] = {};
  std::int32_t precision_bytes = 0;
  std::int32_t sets = 0;
  std::uint64_t particles = 0;
  std::uint64_t occupied = 0;
  Counters counters;
};

/// Visits every field in the order of the file. One by one: a struct as a whole has gaps between its fields
/// that hold whatever was there before, and equal states would not give equal files.
template <class AnyHead, class Visit>
void for_each_field(AnyHead& head, Visit visit) {
  visit(head.scene_hash);
  visit(head.precision_bytes);
  visit(head.sets);
  visit(head.particles);
  visit(head.occupied);
  auto& counters = head.counters;
  visit(counters.frame);
  visit(counters.step);
  visit(counters.time_in_frame);
  visit(counters.time);
  visit(counters.last_dt);
  visit(counters.max_speed);
  visit(counters.max_gradient);
  visit(counters.sort_due);
  visit(counters.segments_when_sorted);
  visit(counters.segments_wasted);
  visit(counters.sorts);
  visit(counters.unseen_motion);
}

std::string bytes_of(const Head& head) {
  std::string bytes;
  for_each_field(head, [&bytes](const auto& field) {
    static_assert(std::is_trivially_copyable_v<std::remove_cvref_t<decltype(field)>>);
    bytes.append(reinterpret_cast<const char*>(&field), sizeof field);
  });
  return bytes;
}

std::uint64_t checksum_of(const void* data, std::size_t bytes) {
  return crc32_z(crc32_z(0, nullptr, 0), static_cast<const Bytef*>(data), bytes);
}

Result<void> write_chunk(const WriteBytes& file, const std::string& name, const void* data, std::size_t bytes) {
  ChunkHead head;
  std::strncpy(head.name, name.c_str(), sizeof head.name - 1);
  head.bytes = bytes;
  head.checksum = checksum_of(data, bytes);
  if (auto written = file(&head, sizeof head); !written) return written;
  return file(data, bytes);
}

/// Reads chunks in the order in which they were written; every error names file and chunk.
class ChunkReader {
 public:
  static Result<ChunkReader> open(std::istream& stream, const std::string& name) {
    ChunkReader reader(stream, name);
    char magic[sizeof kMagic];
    stream.read(magic, sizeof magic);
    if (!stream || std::memcmp(magic, kMagic, sizeof magic) != 0) {
      return Error{ErrorKind::kIo, "is not a checkpoint of this version of Repose", name};
    }
    return reader;
  }

  /// Reads to the end and keeps nothing.
  Result<void> verify() {
    std::vector<char> piece(std::size_t{1} << 20);
    for (ChunkHead head; file_.read(reinterpret_cast<char*>(&head), sizeof head);) {
      head.name[sizeof head.name - 1] = '\0';
      std::uint64_t left = head.bytes;
      uLong sum = crc32_z(0, nullptr, 0);
      while (left > 0) {
        const std::size_t now = static_cast<std::size_t>(std::min<std::uint64_t>(left, piece.size()));
        if (!file_.read(piece.data(), static_cast<std::streamsize>(now)))
          return damaged(head.name, "is cut short");
        sum = crc32_z(sum, reinterpret_cast<const Bytef*>(piece.data()), now);
        left -= now;
      }
      if (sum != head.checksum) return damaged(head.name, "does not have its checksum");
    }
    return file_.gcount() == 0 ? Result<void>() : damaged("?", "is cut short");
  }

  Result<void> read(const std::string& name, void* data, std::size_t bytes) {
    ChunkHead head;
    file_.read(reinterpret_cast<char*>(&head), sizeof head);
    ChunkHead expected;
    std::strncpy(expected.name, name.c_str(), sizeof expected.name - 1);
    const bool named = file_ && std::memcmp(head.name, expected.name, sizeof head.name) == 0;
    if (!named || head.bytes != bytes) return damaged(name, "is missing or has another size");
    file_.read(static_cast<char*>(data), static_cast<std::streamsize>(bytes));
    if (!file_) return damaged(name, "is cut short");
    if (checksum_of(data, bytes) != head.checksum) return damaged(name, "does not have its checksum");
    return {};
  }

 private:
  ChunkReader(std::istream& stream, const std::string& name) : path_(name), file_(stream) {}
  Error damaged(const std::string& chunk, const char* how) const {
    return {ErrorKind::kIo, "chunk '" + chunk + "' " + how + "; use an older checkpoint", path_};
  }

  std::string path_;
  std::istream& file_;
};

Result<std::ifstream> open_file(const std::string& path) {
  std::ifstream file = open_input(path);
  if (!file) return Error{ErrorKind::kNoInput, "cannot be read; is the path right?", path};
  return file;
}

/// Visits every array of a set with the name of its chunk.
template <class Set, class Visit>
Result<void> for_each_array(Set& set, std::size_t k, Visit visit) {
  Result<void> result;
  const std::string prefix = "set" + std::to_string(k) + ".";
  int channel = 0;
  const auto one = [&](const std::string& name, auto& array) {
    if (!result) return;
    result = visit(prefix + name, array.data(), array.size() * sizeof(array[0]));
  };
  one("begin", set.begin);
  one("id", set.id);
  set.for_each_real([&](auto& array) { one(std::to_string(channel++), array); });
  return result;
}

/// Visits what is counted, in the order of the file: how many particles each set holds, and the ledger.
template <class AnyState, class Visit>
void for_each_count(AnyState& state, Visit visit) {
  for (auto& set : state.sets) visit(set.count);
  visit(state.ledger.initial);
  visit(state.ledger.next_id);
  for (auto& count : state.ledger.emitted) visit(count);
  for (auto& count : state.ledger.removed) visit(count);
  for (auto& count : state.ledger.strayed) visit(count);
}

template <class Real>
std::vector<std::uint64_t> counts_of(const State<Real>& state) {
  std::vector<std::uint64_t> counts;
  for_each_count(state, [&counts](std::uint64_t count) { counts.push_back(count); });
  return counts;
}

/// Makes room for as many particles as the file holds: another number than the scene starts with, where they
/// begin and end.
template <class Real>
Result<void> read_counts(ChunkReader& reader, State<Real>& state) {
  std::vector<std::uint64_t> counts = counts_of(state);
  if (auto read = reader.read("counts", counts.data(), counts.size() * sizeof counts[0]); !read) return read;
  for (std::size_t k = 0; k < state.sets.size(); ++k) {
    if (counts[k] != state.sets[k].count) state.sets[k].allocate(counts[k]);
  }
  const std::uint64_t* next = counts.data();
  for_each_count(state, [&next](auto& count) { count = *next++; });
  return {};
}

/// Visits the arrays of State::rest.
template <class AnyRest, class Visit>
Result<void> for_each_rest(AnyRest& rest, Visit visit) {
  if (auto done = visit("rest.asleep", rest.asleep.data(), rest.asleep.size()); !done) return done;
  if (auto done = visit("rest.calm", rest.calm.data(), rest.calm.size() * sizeof(double)); !done) return done;
  return visit("rest.way", rest.way.data(), rest.way.size() * sizeof(rest.way[0]));
}

Result<void> write_rest(const WriteBytes& file, const RestField& rest) {
  return for_each_rest(rest, [&](const std::string& name, const void* data, std::size_t bytes) {
    return write_chunk(file, name, data, bytes);
  });
}

Result<void> read_rest(ChunkReader& reader, RestField& rest) {
  return for_each_rest(rest, [&](const std::string& name, void* data, std::size_t bytes) {
    return reader.read(name, data, bytes);
  });
}

/// Visits the fields of State::last_motion.
template <class AnyMotion, class Visit>
Result<void> for_each_motion(AnyMotion& motion, Visit visit) {
  if (auto done = visit("motion.velocity", motion.velocity.values); !done) return done;
  return visit("motion.rate", motion.acceleration.values);
}

template <class Real>
Result<void> write_motion(const WriteBytes& file, const LastMotion<Real>& motion) {
  const std::uint64_t count = motion.blocks.size();
  if (auto written = write_chunk(file, "motion.count", &count, sizeof count); !written) return written;
  if (auto written = write_chunk(file, "motion.gained", &motion.gained, sizeof motion.gained); !written)
    return written;
  if (auto written = write_chunk(file, "motion.blocks", motion.blocks.data(), count * sizeof(Index3)); !written)
    return written;
  return for_each_motion(motion, [&](const std::string& name, const auto& values) {
    return write_chunk(file, name, values.data(), count * kBlockValues * sizeof(Real));
  });
}

template <class Real>
Result<void> read_motion(ChunkReader& reader, LastMotion<Real>& motion) {
  std::uint64_t count = 0;
  if (auto read = reader.read("motion.count", &count, sizeof count); !read) return read;
  if (auto read = reader.read("motion.gained", &motion.gained, sizeof motion.gained); !read) return read;
  motion.blocks.resize(count);
  if (auto read = reader.read("motion.blocks", motion.blocks.data(), count * sizeof(Index3)); !read)
    return read;
  motion.velocity.resize(count);
  motion.acceleration.resize(count);
  return for_each_motion(motion, [&](const std::string& name, auto& values) {
    return reader.read(name, values.data(), count * kBlockValues * sizeof(Real));
  });
}

Result<Head> read_head(ChunkReader& reader) {
  Head head;
  std::string bytes = bytes_of(head);  // for its size
  if (auto read = reader.read("head", bytes.data(), bytes.size()); !read) return read.error();
  const char* next = bytes.data();
  for_each_field(head, [&next](auto& field) {
    std::memcpy(&field, next, sizeof field);
    next += sizeof field;
  });
  return head;
}

}  // namespace

template <class Real>
Result<void> write_checkpoint(const State<Real>& state, const std::string& scene_hash, const WriteBytes& file) {
  if (auto written = file(kMagic, sizeof kMagic); !written) return written;
  Head head;
  std::strncpy(head.scene_hash, scene_hash.c_str(), sizeof head.scene_hash - 1);
  head.precision_bytes = sizeof(Real);
  head.sets = static_cast<std::int32_t>(state.sets.size());
  head.particles = state.particles();
  head.occupied = state.grid.occupied_blocks().size();
  head.counters = state.counters;
  const std::string head_bytes = bytes_of(head);
  if (auto written = write_chunk(file, "head", head_bytes.data(), head_bytes.size()); !written) return written;
  std::vector<Index3> occupied_blocks;
  for (const std::int32_t occupied : state.grid.occupied_blocks()) {
    occupied_blocks.push_back(state.grid.blocks()[static_cast<std::size_t>(occupied)]);
  }
  if (auto written =
          write_chunk(file, "blocks", occupied_blocks.data(), occupied_blocks.size() * sizeof(Index3));
      !written) {
    return written;
  }
  const std::vector<std::uint64_t> counts = counts_of(state);
  if (auto written = write_chunk(file, "counts", counts.data(), counts.size() * sizeof counts[0]); !written) {
    return written;
  }
  if (state.rest.on) {
    if (auto written = write_rest(file, state.rest); !written) return written;
  }
  if (state.last_motion.on) {
    if (auto written = write_motion(file, state.last_motion); !written) return written;
  }
  const std::size_t tally_bytes = state.tallies.size() * sizeof(double);
  if (auto written = write_chunk(file, "tallies", state.tallies.data(), tally_bytes); !written) return written;
  for (std::size_t k = 0; k < state.sets.size(); ++k) {
    auto written =
        for_each_array(state.sets[k], k, [&](const std::string& name, const void* data, std::size_t bytes) {
          return write_chunk(file, name, data, bytes);
        });
    if (!written) return written;
  }
  return {};
}

template <class Real>
Result<void> save_checkpoint(const State<Real>& state, const std::string& scene_hash, const std::string& path) {
  auto file = AtomicFile::create(path);
  if (!file) return file.error();
  auto written = write_checkpoint(
      state, scene_hash, [&file](const void* data, std::size_t bytes) { return file->write(data, bytes); });
  if (!written) return written;
  return file->commit();
}

Result<void> verify_checkpoint(std::istream& bytes, const std::string& name) {
  auto reader = ChunkReader::open(bytes, name);
  if (!reader) return reader.error();
  return reader->verify();
}

template <class Real>
Result<void> read_checkpoint(std::istream& bytes, const std::string& path, const std::string& scene_hash,
                             State<Real>& state) {
  auto reader = ChunkReader::open(bytes, path);
  if (!reader) return reader.error();
  auto head = read_head(*reader);
  if (!head) return head.error();
  if (scene_hash != head->scene_hash) {
    return Error{
        ErrorKind::kBadScene,
        "belongs to another scene (hash " + std::string(head->scene_hash) + ", this one is " + scene_hash + ")",
        path};
  }
  if (head->precision_bytes != sizeof(Real) || head->sets != static_cast<std::int32_t>(state.sets.size()) ||
      (head->particles != state.particles() && !state.ledger.open())) {
    return Error{ErrorKind::kBadScene, "holds other particles, or another precision, than this scene", path};
  }
  std::vector<Index3> occupied_blocks(head->occupied);
  if (auto read = reader->read("blocks", occupied_blocks.data(), occupied_blocks.size() * sizeof(Index3));
      !read)
    return read;
  if (auto read = read_counts(*reader, state); !read) return read;
  if (state.rest.on) {
    state.rest.resize(head->occupied);
    if (auto read = read_rest(*reader, state.rest); !read) return read;
  }
  if (state.last_motion.on) {
    if (auto read = read_motion(*reader, state.last_motion); !read) return read;
  }
  const std::size_t tally_bytes = state.tallies.size() * sizeof(double);
  if (auto read = reader->read("tallies", state.tallies.data(), tally_bytes); !read) return read;
  for (std::size_t k = 0; k < state.sets.size(); ++k) {
    state.sets[k].begin.resize(head->occupied + 1);
    auto read = for_each_array(state.sets[k], k, [&](const std::string& name, void* data, std::size_t count) {
      return reader->read(name, data, count);
    });
    if (!read) return read;
  }
  state.counters = head->counters;
  state.grid.build(occupied_blocks, state.topology);
  state.list_sets();
  state.nodes.resize(state.grid.size());
  state.rows_touched.assign(state.grid.occupied_blocks().size(), 0);
  return {};
}

template <class Real>
Result<void> load_checkpoint(const std::string& path, const std::string& scene_hash, State<Real>& state) {
  auto file = open_file(path);
  if (!file) return file.error();
  return read_checkpoint(*file, path, scene_hash, state);
}

Result<CheckpointHeader> read_checkpoint_header(const std::string& path) {
  auto file = open_file(path);
  if (!file) return file.error();
  auto reader = ChunkReader::open(*file, path);
  if (!reader) return reader.error();
  auto head = read_head(*reader);
  if (!head) return head.error();
  return CheckpointHeader{head->scene_hash, head->precision_bytes, head->particles, head->counters};
}

#define REPOSE_INSTANTIATE(Real)                                                                              \
  template Result<void> write_checkpoint(const State<Real>&, const std::string&, const WriteBytes&);          \
  template Result<void> save_checkpoint(const State<Real>&, const std::string&, const std::string&);          \
  template Result<void> read_checkpoint(std::istream&, const std::string&, const std::string&, State<Real>&); \
  template Result<void> load_checkpoint(const std::string&, const std::string&, State<Real>&);
REPOSE_INSTANTIATE(float)
REPOSE_INSTANTIATE(double)
#undef REPOSE_INSTANTIATE

}  // namespace repose
