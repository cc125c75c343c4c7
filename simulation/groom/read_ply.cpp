#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <sstream>

#include "contract/input_error.h"
#include "simulation/groom/read_groom.h"

namespace tress::simulation {
namespace {

constexpr std::string_view ply_remedy = "mend the header, or write the file again";

enum class PlyForm { ascii, little, big };

struct PlyType {
  std::string_view names[2];
  int bytes;
  enum { whole, natural, real } kind;
};
constexpr PlyType ply_types[] = {
    {{"char", "int8"}, 1, PlyType::whole},    {{"uchar", "uint8"}, 1, PlyType::natural},
    {{"short", "int16"}, 2, PlyType::whole},  {{"ushort", "uint16"}, 2, PlyType::natural},
    {{"int", "int32"}, 4, PlyType::whole},    {{"uint", "uint32"}, 4, PlyType::natural},
    {{"float", "float32"}, 4, PlyType::real}, {{"double", "float64"}, 8, PlyType::real}};

struct PlyProperty {
  std::string name;
  const PlyType* type = nullptr;
  const PlyType* count = nullptr;  // of a list
};

struct PlyElement {
  std::string name;
  std::uint64_t count = 0;
  std::vector<PlyProperty> properties;

  int find(std::string_view property) const {
    for (std::size_t i = 0; i < properties.size(); ++i) {
      if (properties[i].name == property && properties[i].count == nullptr)
        return static_cast<int>(i);
    }
    return -1;
  }
};

struct PlyHeader {
  PlyForm form = PlyForm::ascii;
  std::vector<PlyElement> elements;
};

const PlyType& ply_type(ByteStream& from, const std::string& name) {
  for (const PlyType& type : ply_types) {
    if (type.names[0] == name || type.names[1] == name) return type;
  }
  from.refuse_text(fmt::format("'{}' is no type of a property", name),
                   std::string(ply_remedy));
}

PlyHeader ply_header(ByteStream& from) {
  PlyHeader header;
  if (from.text_line() != "ply") {
    throw InputError("the file does not begin with ply", from.file() + ":1",
                     std::string(ply_remedy));
  }
  bool formed = false;
  while (true) {
    if (from.peek() < 0) {
      from.refuse_text("a header without end_header", std::string(ply_remedy));
    }
    const std::string line = from.text_line();
    std::istringstream words(line);
    std::string word, first, second, third;
    words >> word >> first >> second >> third;
    if (word == "end_header") break;
    if (word == "format") {
      formed = true;
      if (first == "ascii") {
        header.form = PlyForm::ascii;
      } else if (first == "binary_little_endian") {
        header.form = PlyForm::little;
      } else if (first == "binary_big_endian") {
        header.form = PlyForm::big;
      } else {
        from.refuse_text(fmt::format("format '{}'", first), std::string(ply_remedy));
      }
    } else if (word == "element") {
      std::uint64_t count = 0;
      const char* const last = second.data() + second.size();
      const auto [end, error] = std::from_chars(second.data(), last, count);
      if (second.empty() || end != last || error != std::errc{}) {
        from.refuse_text(fmt::format("element '{}' of '{}'", first, second),
                         std::string(ply_remedy));
      }
      header.elements.push_back({first, count, {}});
    } else if (word == "property") {
      constexpr std::size_t most_properties = 200;
      if (header.elements.empty() ||
          header.elements.back().properties.size() == most_properties) {
        from.refuse_text("a property of no element", std::string(ply_remedy));
      }
      PlyProperty property;
      if (first == "list") {
        std::string name;
        words >> name;
        property = {name, &ply_type(from, third), &ply_type(from, second)};
      } else {
        property = {second, &ply_type(from, first), nullptr};
      }
      header.elements.back().properties.push_back(std::move(property));
    }
  }
  if (!formed) {
    from.refuse_text("a header without format", std::string(ply_remedy));
  }
  return header;
}

/// One number of the data.
double ply_number(ByteStream& from, PlyForm form, const PlyType& type) {
  if (form == PlyForm::ascii) return from.decimal();
  std::array<char, 8> bytes{};
  const auto size = static_cast<std::size_t>(type.bytes);
  from.take(bytes.data(), size);
  if (form == PlyForm::big) std::reverse(bytes.begin(), bytes.begin() + type.bytes);
  const auto as = [&bytes]<class T>(T) {
    T x;
    std::copy_n(bytes.begin(), sizeof x, reinterpret_cast<char*>(&x));
    return static_cast<double>(x);
  };
  if (type.kind == PlyType::real) return size == 4 ? as(float{}) : as(double{});
  const bool sign = type.kind == PlyType::whole;
  if (size == 1) return sign ? as(std::int8_t{}) : as(std::uint8_t{});
  if (size == 2) return sign ? as(std::int16_t{}) : as(std::uint16_t{});
  return sign ? as(std::int32_t{}) : as(std::uint32_t{});
}

/// Numbers of one item by property, lists skipped.
void ply_item(ByteStream& from, PlyForm form, const PlyElement& element,
              std::vector<double>& values) {
  values.resize(element.properties.size());
  for (std::size_t i = 0; i < element.properties.size(); ++i) {
    const PlyProperty& p = element.properties[i];
    if (p.count == nullptr) {
      values[i] = ply_number(from, form, *p.type);
      continue;
    }
    const double count = ply_number(from, form, *p.count);
    if (!(count >= 0) || count > static_cast<double>(from.left())) {
      from.refuse(fmt::format("a list of {} numbers", count), "");
    }
    for (double k = 0; k < count; ++k) ply_number(from, form, *p.type);
  }
}

std::uint64_t least_bytes(PlyForm form, const PlyElement& element) {
  std::uint64_t bytes = 0;
  for (const PlyProperty& p : element.properties) {
    const PlyType& type = p.count != nullptr ? *p.count : *p.type;
    bytes += form == PlyForm::ascii ? 2 : static_cast<std::uint64_t>(type.bytes);
  }
  // The last number of a file of text may end with it.
  return bytes - (form == PlyForm::ascii && bytes > 0);
}

class PlyReader {
 public:
  PlyReader(ByteStream& from, int strand_points)
      : from_(from), header_(ply_header(from)), each_(strand_points) {}

  GroomFile read() {
    made_.text = header_.form == PlyForm::ascii;
    for (const PlyElement& element : header_.elements) {
      // Items without properties have no bytes, whatever their number.
      if (element.properties.empty() && !has_strands(element)) continue;
      const std::uint64_t each = least_bytes(header_.form, element);
      from_.require(element.count, std::max<std::uint64_t>(each, 1), element.name);
      if (element.name == "vertex") {
        vertices(element);
      } else if (element.name == "strand") {
        counts(element);
      } else if (element.name == "edge") {
        edges(element);
      } else {
        for_items(element, [](const std::vector<double>&) {});
      }
    }
    refuse_more();
    divide();
    return std::move(made_);
  }

 private:
  static bool has_strands(const PlyElement& element) {
    return element.name == "vertex" || element.name == "strand" || element.name == "edge";
  }
  void refuse_more() {
    if (made_.text) from_.skip_blanks();
    if (from_.left() == 0) return;
    const std::string problem =
        fmt::format("{} bytes are left after the last element", from_.left());
    const std::string remedy =
        "correct the counts in the header, or write the file again";
    made_.text ? from_.refuse_text(problem, remedy) : from_.refuse(problem, remedy);
  }
  template <class Use>
  void for_items(const PlyElement& element, const Use& use) {
    std::vector<double> values;
    for (std::uint64_t i = 0; i < element.count; ++i) {
      ply_item(from_, header_.form, element, values);
      use(values);
    }
  }
  std::size_t at(const PlyElement& element, std::string_view property) {
    const int found = element.find(property);
    if (found >= 0) return static_cast<std::size_t>(found);
    from_.refuse_text(fmt::format("element {} without {}", element.name, property),
                      std::string(ply_remedy));
  }
  std::uint64_t place() const {
    return made_.text ? static_cast<std::uint64_t>(from_.line()) : from_.at();
  }

  void vertices(const PlyElement& element) {
    const std::size_t x = at(element, "x"), y = at(element, "y"), z = at(element, "z");
    made_.lines.points.reserve(element.count);
    first_ = place();
    for_items(element, [&](const std::vector<double>& v) {
      made_.lines.points.push_back({v[x], v[y], v[z]});
    });
  }
  void counts(const PlyElement& element) {
    const std::size_t segments = at(element, "nsegs");
    counts_.reserve(element.count);
    for_items(element, [&](const std::vector<double>& v) {
      const double n = v[segments];
      if (!(n >= 0 && n < 1e9 && n == std::floor(n))) {
        from_.refuse(fmt::format("strand {} has {} segments", counts_.size(), n), "");
      }
      counts_.push_back(static_cast<std::size_t>(n) + 1);
    });
  }
  void edges(const PlyElement& element) {
    const std::size_t one = at(element, "vertex1"), two = at(element, "vertex2");
    double last = -1;
    for_items(element, [&](const std::vector<double>& v) {
      if (v[two] != v[one] + 1 || (v[one] != last && v[one] != last + 1)) {
        from_.refuse(fmt::format("an edge from vertex {} to {}", v[one], v[two]),
                     "write each strand as vertices in order, with edges in order");
      }
      if (v[one] != last) counts_.push_back(1);
      ++counts_.back();
      last = v[two];
    });
  }

  void divide() {
    const std::size_t points = made_.lines.points.size();
    if (counts_.empty() && each_ > 0) {
      const auto each = static_cast<std::size_t>(each_);
      if (points % each != 0) {
        throw InputError(fmt::format("{} vertices in strands of {}", points, each),
                         from_.file(), "give another strand_points");
      }
      counts_.assign(points / each, each);
    }
    if (counts_.empty()) {
      throw InputError("vertices without strands", from_.file(),
                       "give strand_points, the number of points of every strand, or "
                       "write an element strand with nsegs");
    }
    std::size_t end = 0;
    for (std::size_t k = 0; k < counts_.size(); ++k) {
      end += counts_[k];
      if (end > points) break;
      made_.lines.ends.push_back(end);
      made_.lines.numbers.push_back(k);
      // Lines are one vertex each in all files that are; else those nearby.
      made_.lines.places.push_back(made_.text ? first_ + end - counts_[k] : first_);
    }
    if (end != points) {
      throw InputError(
          fmt::format("strands of {} points where there are {} vertices", end, points),
          from_.file(), "the file is damaged: write it again");
    }
  }

  ByteStream& from_;
  PlyHeader header_;
  int each_;
  GroomFile made_;
  std::uint64_t first_ = 0;
  std::vector<std::size_t> counts_;
};

}  // namespace

GroomFile read_ply(ByteStream& from, int strand_points) {
  return PlyReader(from, strand_points).read();
}

}  // namespace tress::simulation
