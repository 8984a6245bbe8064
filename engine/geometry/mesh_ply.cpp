// Repose: Stanford PLY, ASCII and binary little-endian. The header says what each row holds; every count in
// the file is checked against the bytes that are left before it is believed.
#include <algorithm>
#include <array>
#include <bit>
#include <cstring>

#include "engine/geometry/mesh_reader.h"
#include "engine/geometry/mesh_text.h"
#include "engine/geometry/polygon.h"

namespace repose {
namespace {

static_assert(std::endian::native == std::endian::little, "binary PLY is read by copying bytes");

enum class Scalar { kInt8, kUint8, kInt16, kUint16, kInt32, kUint32, kFloat32, kFloat64 };

struct ScalarName {
  std::string_view name;
  std::string_view alias;
};
constexpr std::array<ScalarName, 8> kScalarNames{{{"char", "int8"},
                                                  {"uchar", "uint8"},
                                                  {"short", "int16"},
                                                  {"ushort", "uint16"},
                                                  {"int", "int32"},
                                                  {"uint", "uint32"},
                                                  {"float", "float32"},
                                                  {"double", "float64"}}};

struct Property {
  std::string name;
  Scalar type = Scalar::kFloat32;
  bool is_list = false;
  Scalar count_type = Scalar::kUint8;
};

struct Element {
  std::string name;
  std::uint64_t count = 0;
  std::vector<Property> properties;
};

struct Header {
  bool binary = false;
  std::vector<Element> elements;
};

bool parse_scalar(std::string_view word, Scalar& type) {
  for (std::size_t k = 0; k < kScalarNames.size(); ++k) {
    if (word != kScalarNames[k].name && word != kScalarNames[k].alias) continue;
    type = static_cast<Scalar>(k);
    return true;
  }
  return false;
}

bool parse_property(std::string_view line, Header& header) {
  if (header.elements.empty()) return false;
  Property property;
  std::string_view word = take_word(line);
  if (word == "list") {
    property.is_list = true;
    if (!parse_scalar(take_word(line), property.count_type)) return false;
    word = take_word(line);
  }
  if (!parse_scalar(word, property.type)) return false;
  property.name = take_word(line);
  header.elements.back().properties.push_back(property);
  return !property.name.empty();
}

bool parse_format(std::string_view line, Header& header) {
  const std::string_view word = take_word(line);
  header.binary = word == "binary_little_endian";
  return header.binary || word == "ascii";
}

/// Reads values one after another from what follows the header, text or binary.
class Values {
 public:
  Values(std::string_view bytes, bool binary, std::int64_t line) : rest_(bytes), binary_(binary), line_(line) {}

  bool next(Scalar type, double& value) { return binary_ ? next_binary(type, value) : next_word(value); }
  std::size_t left() const { return rest_.size(); }
  std::int64_t line() const { return binary_ ? 0 : line_; }

 private:
  template <class T>
  bool copy(double& value) {
    T held;
    if (rest_.size() < sizeof(T)) return false;
    std::memcpy(&held, rest_.data(), sizeof(T));
    rest_.remove_prefix(sizeof(T));
    value = static_cast<double>(held);
    return true;
  }

  bool next_binary(Scalar type, double& value) {
    switch (type) {
      case Scalar::kInt8:
        return copy<std::int8_t>(value);
      case Scalar::kUint8:
        return copy<std::uint8_t>(value);
      case Scalar::kInt16:
        return copy<std::int16_t>(value);
      case Scalar::kUint16:
        return copy<std::uint16_t>(value);
      case Scalar::kInt32:
        return copy<std::int32_t>(value);
      case Scalar::kUint32:
        return copy<std::uint32_t>(value);
      case Scalar::kFloat32:
        return copy<float>(value);
      case Scalar::kFloat64:
        return copy<double>(value);
    }
    return false;
  }

  bool next_word(double& value) {
    const std::string_view before = rest_;
    const std::string_view word = take_word(rest_);
    line_ += std::count(before.begin(), before.end() - static_cast<std::ptrdiff_t>(rest_.size()), '\n');
    return parse(word, value);
  }

  std::string_view rest_;
  bool binary_;
  std::int64_t line_;
};

Result<Header> read_header(std::string_view& bytes, const std::string& name, std::int64_t& number) {
  Header header;
  const auto bad = [&](const std::string& message) { return mesh_error(name, number, message); };
  if (take_line(bytes) != "ply") return bad("does not begin with the line \"ply\"");
  bool formatted = false;
  while (!bytes.empty()) {
    std::string_view line = take_line(bytes);
    ++number;
    const std::string_view word = take_word(line);
    if (word == "end_header") {
      if (!formatted) return bad("the header has no \"format\" line");
      return header;
    }
    if (word == "format") {
      formatted = parse_format(line, header);
      if (!formatted) return bad("the format must be ascii or binary_little_endian");
    } else if (word == "element") {
      Element element{std::string(take_word(line)), 0, {}};
      if (!parse(take_word(line), element.count)) return bad("an element must be: element NAME COUNT");
      header.elements.push_back(element);
    } else if (word == "property" && !parse_property(line, header)) {
      return bad(
          "a property must follow an element and be: property TYPE NAME, or property list TYPE TYPE NAME");
    }
  }
  return bad("the header has no \"end_header\" line");
}

/// Reads the list or scalar of one property of one row; false where the file ends or a value is no number.
bool read_property(Values& values, const Property& property, std::vector<double>& row) {
  double count = 1;
  if (property.is_list && !values.next(property.count_type, count)) return false;
  if (!(count >= 0) || count > static_cast<double>(values.left())) return false;
  row.resize(static_cast<std::size_t>(count));
  for (double& value : row) {
    if (!values.next(property.type, value)) return false;
  }
  return true;
}

int coordinate_of(const Property& property) {
  if (property.is_list || property.name.size() != 1) return -1;
  const std::size_t place = std::string_view("xyz").find(property.name[0]);
  return place == std::string_view::npos ? -1 : static_cast<int>(place);
}

Result<void> read_vertices(Values& values, const Element& element, const std::string& name,
                           TriangleMesh& mesh) {
  std::array<int, 3> seen{};
  for (const Property& property : element.properties) {
    if (const int k = coordinate_of(property); k >= 0) ++seen[k];
  }
  if (seen != std::array<int, 3>{1, 1, 1})
    return mesh_error(name, 0, "vertices must have properties x, y and z");
  if (element.count > kMostVertices) return mesh_error(name, 0, "more than 2^31 vertices");
  std::vector<double> row;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    Vec3 vertex;
    for (const Property& property : element.properties) {
      if (!read_property(values, property, row)) {
        return mesh_error(name, values.line(), "vertex " + std::to_string(i) + " is cut short or not a number");
      }
      if (const int k = coordinate_of(property); k >= 0) vertex[k] = row[0];
    }
    if (!vertex.allFinite()) {
      return mesh_error(name, values.line(), "vertex " + std::to_string(i) + " is not finite");
    }
    mesh.vertices.push_back(vertex);
  }
  return {};
}

Result<void> read_faces(Values& values, const Element& element, const std::string& name, TriangleMesh& mesh) {
  const auto is_index = [](double value) { return value == std::floor(value) && std::abs(value) < 1e15; };
  std::vector<double> row;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    const auto bad = [&](const std::string& message) {
      return mesh_error(name, values.line(), "face " + std::to_string(i) + " " + message);
    };
    for (const Property& property : element.properties) {
      if (!read_property(values, property, row)) return bad("is cut short or not a number");
      if (property.name != "vertex_indices" && property.name != "vertex_index") continue;
      if (row.size() < 3) return bad("must have three or more vertices");
      const PolygonEnd end = std::all_of(row.begin(), row.end(), is_index)
                                 ? append_polygon({row.begin(), row.end()}, mesh)
                                 : PolygonEnd::kNoVertex;
      if (end == PolygonEnd::kNoVertex) {
        return bad("names a vertex that does not stand before it; there are " +
                   std::to_string(mesh.vertices.size()) + ", counted from 0");
      }
      if (end == PolygonEnd::kNotSimple)
        return bad("has an outline that crosses itself; cut it into triangles");
    }
  }
  return {};
}

Result<void> skip_rows(Values& values, const Element& element, const std::string& name) {
  std::vector<double> row;
  for (std::uint64_t i = 0; i < element.count; ++i) {
    for (const Property& property : element.properties) {
      if (!read_property(values, property, row)) {
        return mesh_error(name, values.line(), "\"" + element.name + "\" is cut short or not a number");
      }
    }
  }
  return {};
}

}  // namespace

Result<TriangleMesh> read_ply(std::string_view bytes, const std::string& name) {
  std::int64_t line = 1;
  auto header = read_header(bytes, name, line);
  if (!header) return header.error();

  TriangleMesh mesh;
  Values values(bytes, header->binary, line + 1);
  for (const Element& element : header->elements) {
    // A row takes a byte at least, so no loop runs longer than the file.
    if (element.properties.empty() || element.count > values.left()) {
      return mesh_error(name, 0,
                        "\"" + element.name + "\" has more rows than the file has room for, or no property");
    }
    const Result<void> done = element.name == "vertex" ? read_vertices(values, element, name, mesh)
                              : element.name == "face" ? read_faces(values, element, name, mesh)
                                                       : skip_rows(values, element, name);
    if (!done) return done.error();
  }
  return mesh;
}

}  // namespace repose
