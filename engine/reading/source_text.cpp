// Repose: places in a scene file. The JSON library knows where a value starts but not where its key does, and
// a misspelt key is best shown at the key; so a small scanner of tokens goes over the text once more. It has
// to be safe on any bytes, not to judge them: the JSON library does that.
#include "engine/reading/source_text.h"

#include <algorithm>
#include <cstring>
#include <string_view>

namespace repose {
namespace {

/// Steps through the tokens of JSON with comments. Words and numbers count as one token.
class Scanner {
 public:
  explicit Scanner(std::string_view text) : text_(text) {}

  /// Moves to the next token; false at the end.
  bool next() {
    skip_blank();
    start_ = position_;
    if (position_ >= text_.size()) return false;
    if (text_[position_] == '"') {
      skip_string();
    } else if (is_punctuation(text_[position_])) {
      ++position_;
    } else {
      while (position_ < text_.size() && !ends_word(text_[position_])) ++position_;
      if (position_ == start_) ++position_;
    }
    return true;
  }

  char first() const { return text_[start_]; }
  std::ptrdiff_t start() const { return static_cast<std::ptrdiff_t>(start_); }
  std::size_t length() const { return position_ - start_; }

 private:
  static bool is_punctuation(char c) { return std::strchr("{}[],:", c) != nullptr && c != '\0'; }
  static bool is_space(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }
  static bool ends_word(char c) { return is_punctuation(c) || is_space(c) || c == '"' || c == '/'; }

  void skip_blank() {
    while (position_ < text_.size()) {
      if (is_space(text_[position_])) {
        ++position_;
      } else if (text_.substr(position_, 2) == "//") {
        position_ = std::min(text_.find_first_of("\r\n", position_), text_.size());
      } else if (text_.substr(position_, 2) == "/*") {
        const std::size_t end = text_.find("*/", position_ + 2);
        position_ = end == std::string_view::npos ? text_.size() : end + 2;
      } else {
        return;
      }
    }
  }

  void skip_string() {
    for (++position_; position_ < text_.size() && text_[position_] != '"'; ++position_) {
      if (text_[position_] == '\\') ++position_;
    }
    position_ = std::min(position_ + 1, text_.size());
  }

  std::string_view text_;
  std::size_t position_ = 0;
  std::size_t start_ = 0;
};

}  // namespace

SourceText::SourceText(std::string name, std::string text) : name_(std::move(name)), text_(std::move(text)) {
  if (text_.starts_with("\xEF\xBB\xBF")) text_.erase(0, 3);
  find_lines();
  find_keys();
}

void SourceText::find_lines() {
  line_starts_.push_back(0);
  for (std::size_t i = 0; i < text_.size(); ++i) {
    const bool paired = text_[i] == '\r' && i + 1 < text_.size() && text_[i + 1] == '\n';
    const bool ends = text_[i] == '\n' || (text_[i] == '\r' && !paired);
    if (ends) line_starts_.push_back(static_cast<std::ptrdiff_t>(i) + 1);
  }
}

void SourceText::find_keys() {
  // A text before a colon is a key, and what follows the colon is its value.
  std::ptrdiff_t last_string = -1;
  std::ptrdiff_t key = -1;
  for (Scanner scanner(text_); scanner.next();) {
    if (key >= 0) {
      key_of_value_[scanner.start()] = key;
      key = -1;
    }
    if (scanner.first() == ':') key = last_string;
    last_string = scanner.first() == '"' ? scanner.start() : -1;
  }
}

std::optional<std::ptrdiff_t> SourceText::deeper_than(int limit) const {
  int depth = 0;
  for (Scanner scanner(text_); scanner.next();) {
    if (scanner.first() == '{' || scanner.first() == '[') ++depth;
    if (scanner.first() == '}' || scanner.first() == ']') --depth;
    if (depth > limit) return scanner.start();
  }
  return std::nullopt;
}

void SourceText::for_each_word(const std::function<void(std::size_t, std::size_t)>& visit) const {
  for (Scanner scanner(text_); scanner.next();) {
    if (scanner.first() != '"') visit(static_cast<std::size_t>(scanner.start()), scanner.length());
  }
}

std::ptrdiff_t SourceText::add_words(const std::string& words) {
  words_.push_back(words);
  return static_cast<std::ptrdiff_t>(text_.size() + words_.size());
}

std::string SourceText::place(std::ptrdiff_t offset) const {
  const std::ptrdiff_t behind = offset - static_cast<std::ptrdiff_t>(text_.size()) - 1;
  if (behind >= 0) return words_.at(static_cast<std::size_t>(behind));

  const auto after = std::upper_bound(line_starts_.begin(), line_starts_.end(), offset);
  const std::ptrdiff_t line = after - line_starts_.begin();
  const auto start = text_.begin() + *(after - 1);
  // Bytes 10xxxxxx continue a character of UTF-8.
  const auto column =
      1 + std::count_if(start, text_.begin() + offset, [](char c) { return (c & 0xC0) != 0x80; });
  return name_ + ":" + std::to_string(line) + ":" + std::to_string(column);
}

std::ptrdiff_t SourceText::key_of(std::ptrdiff_t value) const {
  const auto found = key_of_value_.find(value);
  return found == key_of_value_.end() ? value : found->second;
}

std::ptrdiff_t SourceText::offset_of(std::ptrdiff_t line, std::ptrdiff_t column) const {
  const auto last = static_cast<std::ptrdiff_t>(line_starts_.size());
  const std::ptrdiff_t start =
      line_starts_[static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(line, 1, last) - 1)];
  return std::clamp<std::ptrdiff_t>(start + column - 1, 0, static_cast<std::ptrdiff_t>(text_.size()));
}

}  // namespace repose
