#include "models/mesh/read_ply_mesh.h"

#include <charconv>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

namespace tress::models {
namespace {

enum class Form { text, little, big };

/// A property of an element: a number, or a list of numbers with a count before it.
struct Property {
  std::string name;
  char type = 0, count = 0;  // letters of type_of(); count 0: no list
};
struct Element {
  std::string name;
  std::size_t count = 0;
  std::vector<Property> properties;
};

/// A letter for each type of PLY; 0: there is none of this name.
char type_of(std::string_view name) {
  constexpr std::pair<std::string_view, char> types[] = {
      {"char", 'b'},  {"int8", 'b'},    {"uchar", 'B'},  {"uint8", 'B'},
      {"short", 'h'}, {"int16", 'h'},   {"ushort", 'H'}, {"uint16", 'H'},
      {"int", 'i'},   {"int32", 'i'},   {"uint", 'I'},   {"uint32", 'I'},
      {"float", 'f'}, {"float32", 'f'}, {"double", 'd'}, {"float64", 'd'}};
  for (const auto& [known, letter] : types) {
    if (known == name) return letter;
  }
  return 0;
}

double number(MeshText& from, Form form, char type) {
  if (form == Form::text) return from.number();
  const bool big = form == Form::big;
  switch (type) {
    case 'b':
      return from.binary<std::int8_t>(big);
    case 'B':
      return from.binary<std::uint8_t>(big);
    case 'h':
      return from.binary<std::int16_t>(big);
    case 'H':
      return from.binary<std::uint16_t>(big);
    case 'i':
      return from.binary<std::int32_t>(big);
    case 'I':
      return from.binary<std::uint32_t>(big);
    case 'f':
      return static_cast<double>(from.binary<float>(big));
    default:
      return from.binary<double>(big);
  }
}

/// A whole number of at most `most`.
std::size_t whole(MeshText& from, double x, double most, const char* what) {
  if (!(x >= 0 && x <= most && x == std::floor(x))) {
    from.refuse(std::string(what) + " out of range");
  }
  return static_cast<std::size_t>(x);
}

struct Header {
  Form form = Form::text;
  std::vector<Element> elements;
};

void read_form(MeshText& from, std::string_view name, Header& to) {
  if (name == "binary_little_endian") {
    to.form = Form::little;
  } else if (name == "binary_big_endian") {
    to.form = Form::big;
  } else if (name != "ascii") {
    from.refuse("a format that PLY does not have");
  }
}

void read_property(MeshText& from, std::string_view line, Header& to) {
  if (to.elements.empty()) from.refuse("a property of no element");
  Property made;
  std::string_view type = first_word(line);
  if (type == "list") {
    made.count = type_of(first_word(line));
    if (made.count == 0) from.refuse("a list whose count has no type of PLY");
    type = first_word(line);
  }
  made.type = type_of(type);
  made.name = first_word(line);
  if (made.type == 0) from.refuse("a property without a type of PLY");
  to.elements.back().properties.push_back(std::move(made));
}

Header read_header(MeshText& from) {
  Header to;
  if (from.line() != "ply") from.refuse("the file does not begin with ply");
  while (true) {
    if (from.ended()) from.refuse("a header without end_header");
    std::string_view line = from.line();
    const std::string_view word = first_word(line);
    if (word == "end_header") break;
    if (word == "format") read_form(from, first_word(line), to);
    if (word == "element") {
      Element made{std::string(first_word(line)), 0, {}};
      const std::string_view count = first_word(line);
      const char* const last = count.data() + count.size();
      const auto [end, error] = std::from_chars(count.data(), last, made.count);
      if (count.empty() || end != last || error != std::errc{}) {
        from.refuse("an element without a count");
      }
      to.elements.push_back(std::move(made));
    }
    if (word == "property") read_property(from, line, to);
  }
  if (to.form != Form::text) from.turn_binary();
  return to;
}

/// The items of an element, property by property. A list begins with its length.
class Items {
 public:
  Items(MeshText& from, Form form, const Element& element)
      : from_(from), form_(form), element_(element), values_(element.properties.size()) {
    // An item has a byte and more; without properties it has none.
    const std::size_t most = element.properties.empty() ? 0 : from.left();
    if (element.count > most) {
      from.refuse(std::to_string(element.count) + " of " + element.name +
                  " in the header, and fewer bytes");
    }
  }
  void next() {
    for (std::size_t i = 0; i < values_.size(); ++i) {
      const Property& p = element_.properties[i];
      const std::size_t count =
          p.count == 0 ? 1
                       : whole(from_, number(from_, form_, p.count),
                               static_cast<double>(from_.left()), "the length of a list");
      values_[i].clear();
      for (std::size_t k = 0; k < count; ++k) {
        values_[i].push_back(number(from_, form_, p.type));
      }
    }
  }
  const std::vector<double>& values(std::size_t property) const {
    return values_[property];
  }
  /// The property of this name, or of the other one.
  std::size_t find(std::string_view name, std::string_view other, bool list) const {
    for (std::size_t i = 0; i < element_.properties.size(); ++i) {
      const Property& p = element_.properties[i];
      if ((p.name == name || p.name == other) && (p.count != 0) == list) return i;
    }
    from_.refuse("element " + element_.name + " without " + std::string(name));
  }

 private:
  MeshText& from_;
  Form form_;
  const Element& element_;
  std::vector<std::vector<double>> values_;
};

}  // namespace

void add_polygon(std::span<const std::size_t> corners, TriangleMesh& to) {
  for (std::size_t k = 2; k < corners.size(); ++k) {
    to.triangle.push_back({corners[0], corners[k - 1], corners[k]});
  }
}

TriangleMesh read_ply_mesh(MeshText& from) {
  const Header header = read_header(from);
  TriangleMesh mesh;
  std::vector<std::size_t> corners;
  for (const Element& element : header.elements) {
    Items items(from, header.form, element);
    const bool vertex = element.name == "vertex", face = element.name == "face";
    const std::size_t x = vertex ? items.find("x", "x", false) : 0,
                      y = vertex ? items.find("y", "y", false) : 0,
                      z = vertex ? items.find("z", "z", false) : 0,
                      list =
                          face ? items.find("vertex_indices", "vertex_index", true) : 0;
    for (std::size_t i = 0; i < element.count; ++i) {
      items.next();
      if (vertex) {
        mesh.corner.push_back(
            {items.values(x)[0], items.values(y)[0], items.values(z)[0]});
      }
      if (!face) continue;
      corners.clear();
      for (const double at : items.values(list)) {
        corners.push_back(whole(from, at, static_cast<double>(mesh.corner.size()) - 1,
                                "the index of a vertex"));
      }
      add_polygon(corners, mesh);
    }
  }
  return mesh;
}

}  // namespace tress::models
