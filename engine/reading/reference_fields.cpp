// Repose: the visitor that writes the reference of scene keys: one Markdown section per object, in the order
// of declaration, with one row per key. Sections of nested objects follow the object that holds them.
#include <cmath>
#include <vector>

#include "engine/base/wording.h"
#include "engine/reading/reader.h"
#include "engine/study/study.h"

namespace repose {
namespace {

/// A cell of a Markdown table: a bar in the text would end it.
std::string cell(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '|') escaped += '\\';
    escaped += c == '\n' ? ' ' : c;
  }
  return escaped.empty() ? " |" : " " + escaped + " |";
}

std::string code(const std::string& text) {
  return text.empty() ? "" : "`" + text + "`";
}

std::string joined(const std::string& path, const std::string& key) {
  return path.empty() ? key : path + "." + key;
}

class ReferenceFields final : public Fields {
 public:
  ReferenceFields(std::string path, std::string meaning)
      : path_(std::move(path)), meaning_(std::move(meaning)) {}

  /// This section and those of the objects within.
  std::string markdown() const {
    std::string text = "## " + (path_.empty() ? "The scene" : code(path_)) + "\n\n" + meaning_ + "\n\n";
    if (rows_.empty()) return text + "No keys.\n\n" + nested_;
    text += "| Key | Unit | Default | Range | Meaning |\n| --- | --- | --- | --- | --- |\n";
    for (const Row& row : rows_) {
      text += "|" + cell(code(row.key)) + cell(row.unit) + cell(row.standard) + cell(row.range) +
              cell(row.meaning) + "\n";
    }
    return text + "\n" + nested_;
  }

  void number(const char* key, double& value, const Quantity& quantity) override {
    add(key, quantity, std::isfinite(value) ? number_text(value) : "none", "");
  }

  void integer(const char* key, std::int64_t& value, const Quantity& quantity) override {
    add(key, quantity, std::to_string(value), "whole numbers");
  }

  void flag(const char* key, bool& value, const char* meaning) override {
    row(key, "", value ? "true" : "false", "true, false", meaning);
  }

  void text(const char* key, std::string& value, const char* meaning, bool required) override {
    row(key, "", required ? "required" : value, "text", meaning);
  }

  void vector(const char* key, Vec3& value, const Quantity& quantity) override {
    add(key, quantity, list_of(value), "3 numbers");
  }

  void integers(const char* key, std::array<std::int64_t, 3>& value, const Quantity& quantity) override {
    add(key, quantity, list_of(value), "3 whole numbers");
  }

  void rows(const char* key, std::vector<std::vector<double>>&, int width, const Quantity& quantity) override {
    add(key, quantity, "[]", "lists of " + std::to_string(width) + " numbers");
  }

  void choice(const char* key, int& index, std::span<const Choice> choices, const char* meaning) override {
    row(key, "", code(choices[static_cast<std::size_t>(index)].name), names_of(choices), meaning);
  }

  void choices(const char* key, std::vector<int>& chosen, std::span<const Choice> choices,
               const char* meaning) override {
    std::string standard;
    for (const int index : chosen) {
      standard += (standard.empty() ? "" : ", ") + std::string(choices[static_cast<std::size_t>(index)].name);
    }
    row(key, "", "[" + standard + "]", "list of any of " + names_of(choices), meaning);
  }

  void object(const char* key, bool&, bool required, const char* meaning,
              const std::function<void(Fields&)>& describe) override {
    nest(key, joined(path_, key), required, "object", meaning, describe);
  }

  void list(const char* key, bool required, const char* meaning,
            const std::function<void(Fields&)>& item) override {
    nest(key, joined(path_, key) + "[]", required, "list of objects", meaning, item);
  }

  void dictionary(const char* key, bool required, const char* meaning,
                  const std::function<void(const std::string&, Fields&)>& item) override {
    nest(key, joined(path_, key) + ".NAME", required, "object of named objects", meaning,
         [&](Fields& fields) { item("NAME", fields); });
  }

  void alternatives(int&, std::span<const Alternative> alternatives, const char* meaning) override {
    std::string range;
    for (const Alternative& alternative : alternatives) {
      range += (range.empty() ? "" : "; ") + code(alternative.name) + ": " + alternative.meaning;
    }
    row("type", "", "required", range, meaning);
    for (const Alternative& alternative : alternatives) {
      ReferenceFields fields(path_, "");
      alternative.describe(fields);
      for (Row& row : fields.rows_) {
        row.meaning = code(alternative.name) + ": " + row.meaning;
        rows_.push_back(row);
      }
      nested_ += fields.nested_;
    }
  }

  void parameters(const char* key, const char* meaning) override {
    row(key, "", "optional", "object of numbers", meaning);
  }

  void check(bool, const char*, const std::string&) override {}  // messages of the reader state it

 private:
  struct Row {
    std::string key, unit, standard, range, meaning;
  };

  static std::string names_of(std::span<const Choice> choices) {
    std::string names;
    for (const Choice& choice : choices) {
      names += (names.empty() ? "" : "; ") + code(choice.name) + ": " + choice.meaning;
    }
    return names;
  }

  template <class List>
  static std::string list_of(const List& list) {
    std::string text;
    for (const auto x : list) text += (text.empty() ? "[" : ", ") + number_text(static_cast<double>(x));
    return text + "]";
  }

  void add(const char* key, const Quantity& quantity, const std::string& standard, const std::string& kind) {
    const std::string range = range_text(quantity);
    const std::string both = kind + (kind.empty() || range.empty() ? "" : ", ") + range;
    row(key, quantity.unit, quantity.required ? "required" : standard, both, quantity.meaning);
  }

  void row(const std::string& key, const std::string& unit, const std::string& standard,
           const std::string& range, const std::string& meaning) {
    rows_.push_back({key, unit, standard, range, meaning});
  }

  void nest(const char* key, const std::string& path, bool required, const char* kind, const char* meaning,
            const std::function<void(Fields&)>& describe) {
    row(key, "", required ? "required" : "optional", std::string(kind) + ", see " + code(path), meaning);
    ReferenceFields fields(path, meaning);
    describe(fields);
    nested_ += fields.markdown();
  }

  std::string path_;
  std::string meaning_;
  std::vector<Row> rows_;
  std::string nested_;
};

}  // namespace

std::string scene_reference() {
  Scene scene;
  ReferenceFields fields("", "Every number may be text that begins with `=`, an expression over `parameters`.");
  describe(fields, scene);
  StudyDescription study;
  describe(fields, study);
  return "# Scene keys\n\n" + fields.markdown();
}

}  // namespace repose
