// Repose: the text of a scene, and where in it a value stands. A place is an offset in bytes; the words
// of the command line are laid end to end behind the file, so that one number names a place in either.
#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace repose {

class SourceText {
 public:
  /// `name` is what places are prefixed with. A UTF-8 byte order mark at the start is dropped.
  SourceText(std::string name, std::string text);

  const std::string& text() const { return text_; }

  /// Registers words of the command line, such as "--set a.b=v", and gives the offset that stands for what they
  /// put into the scene.
  std::ptrdiff_t add_words(const std::string& words);

  /// "file:line:col", both from 1, columns in characters; the words for the offset of words.
  std::string place(std::ptrdiff_t offset) const;

  /// Offset of the key of the value that starts at `value`; `value` itself where it has no key in the file.
  std::ptrdiff_t key_of(std::ptrdiff_t value) const;

  /// Offset of a line and a column in bytes, both from 1, as the JSON library counts them.
  std::ptrdiff_t offset_of(std::ptrdiff_t line, std::ptrdiff_t column) const;

  /// Calls visit(offset, length) for each word, number and punctuation mark outside texts and comments.
  void for_each_word(const std::function<void(std::size_t, std::size_t)>& visit) const;

  /// Where braces and brackets first nest deeper than `limit`.
  std::optional<std::ptrdiff_t> deeper_than(int limit) const;

 private:
  void find_lines();
  void find_keys();

  std::string name_;
  std::string text_;
  std::vector<std::ptrdiff_t> line_starts_;
  std::map<std::ptrdiff_t, std::ptrdiff_t> key_of_value_;
  std::vector<std::string> words_;
};

}  // namespace repose
