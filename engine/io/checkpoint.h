// Repose: a state on disk, bit for bit: every channel in the order in which it lies, the blocks, and the
// counters. Loading never sorts and saving never orders, since re-blocking rounds: when it happens would change
// bits.
#pragma once

#include <functional>
#include <istream>
#include <string>

#include "engine/base/result.h"
#include "engine/state/state.h"

namespace repose {

/// What a checkpoint says of itself.
struct CheckpointHeader {
  std::string scene_hash;  ///< of the scene that the state belongs to
  int precision_bytes = 4;
  std::uint64_t particles = 0;
  Counters counters;
};

/// Writes a temporary, syncs, renames. Errors: 73, 74.
template <class Real>
Result<void> save_checkpoint(const State<Real>& state, const std::string& scene_hash, const std::string& path);

/// Takes the bytes of a checkpoint, piece by piece.
using WriteBytes = std::function<Result<void>(const void* data, std::size_t bytes)>;

/// The same to wherever `write` brings it. Errors: those of `write`.
template <class Real>
Result<void> write_checkpoint(const State<Real>& state, const std::string& scene_hash, const WriteBytes& write);

/// Whether all chunks are whole and have their checksums. `name` stands for the file in errors. Error: 74,
/// naming the chunk.
Result<void> verify_checkpoint(std::istream& bytes, const std::string& name);

/// Fills a state that was compiled from the same scene. Errors: 66 no such file; 74 damaged, naming the chunk;
/// 65 of another scene, precision or version, naming both.
template <class Real>
Result<void> load_checkpoint(const std::string& path, const std::string& scene_hash, State<Real>& state);

/// The same from a stream, which stands at its beginning.
template <class Real>
Result<void> read_checkpoint(std::istream& bytes, const std::string& name, const std::string& scene_hash,
                             State<Real>& state);

/// Reads only the header.
Result<CheckpointHeader> read_checkpoint_header(const std::string& path);

}  // namespace repose
