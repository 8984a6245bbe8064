// Repose: a file that appears whole or not at all. It is written beside its final name, synced and renamed,
// so a crash, a kill or a full disk leaves the old file or the new one and never a torn one. What is no regular
// file, such as a pipe or /dev/null, is written as it is, and at the end.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "engine/base/result.h"

namespace repose {

/// One write-only file in the making. Destroyed without commit(), it removes what it wrote.
/// Every error names the final path and the reason that the system gave.
class AtomicFile {
 public:
  /// Starts the temporary in the folder of `path`; an existing file at `path` stays until commit(). Where
  /// `path` is a link, the file it leads to. Error: 73 when the folder is missing or refuses, or `path` is a
  /// folder.
  static Result<AtomicFile> create(const std::string& path);

  AtomicFile(AtomicFile&& other) noexcept;
  AtomicFile& operator=(AtomicFile&&) = delete;
  ~AtomicFile();

  /// Appends. Error: 74 when the disk gives out; the file is then lost and every later call repeats the error.
  Result<void> write(const void* data, std::size_t bytes);

  /// Replaces bytes that were appended before. Error: as write().
  Result<void> overwrite(std::uint64_t offset, const void* data, std::size_t bytes);

  /// The name of the file of which one called `file` is the temporary; empty where it is none.
  static std::string final_name(const std::string& file);

  /// Syncs file and folder and gives the file its name. Errors: 74; 73 when the name is taken by a folder.
  Result<void> commit();

 private:
  AtomicFile(std::string path, std::string temporary, int descriptor);
  Result<void> flush();
  Result<void> put(std::uint64_t offset, const std::byte* data, std::size_t bytes);
  Result<void> fail(ErrorKind kind, const char* doing);
  bool in_place() const { return temporary_.empty(); }
  void discard();

  std::string path_;
  std::string temporary_;
  int descriptor_ = -1;
  std::uint64_t flushed_ = 0;  // bytes handed to the system; what buffer_ holds comes after them
  std::vector<std::byte> buffer_;
  Result<void> state_;
};

/// The whole of a small file. Errors as above.
Result<void> write_text(const std::string& path, const std::string& text);

}  // namespace repose
