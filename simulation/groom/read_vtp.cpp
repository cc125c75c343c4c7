#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cstring>
#include <map>

#include "contract/input_error.h"
#include "simulation/groom/read_groom.h"

namespace tress::simulation {
namespace {

constexpr std::string_view vtp_remedy = "mend the file there, or write it again";

struct XmlTag {
  std::string name;  // "/Piece" of one that ends
  std::map<std::string, std::string, std::less<>> attributes;

  std::string_view operator[](std::string_view key) const {
    const auto found = attributes.find(key);
    return found == attributes.end() ? std::string_view{} : found->second;
  }
};

bool xml_blank(char c) { return c == ' ' || c == '\t' || c == '\n' || c == '\r'; }

/// The next tag; none: the file has no more.
std::optional<XmlTag> next_tag(ByteStream& from) {
  int c = from.get();
  while (c >= 0 && c != '<') c = from.get();
  if (c < 0) return std::nullopt;
  std::string text;
  constexpr std::size_t longest = 1 << 16;
  for (c = from.get(); c != '>'; c = from.get()) {
    if (c < 0 || text.size() == longest) {
      from.refuse_text("a tag that is not closed", std::string(vtp_remedy));
    }
    text += static_cast<char>(c);
  }
  XmlTag tag;
  std::size_t i = 0;
  const auto skip = [&] {
    while (i < text.size() && xml_blank(text[i])) ++i;
  };
  while (i < text.size() && !xml_blank(text[i]) && (text[i] != '/' || i == 0)) {
    tag.name += text[i++];
  }
  if (tag.name.starts_with('!') || tag.name.starts_with('?')) return tag;
  for (skip(); i < text.size() && text[i] != '/'; skip()) {
    const std::size_t equals = text.find('=', i);
    const std::size_t quote = equals == std::string::npos ? equals : equals + 1;
    const std::size_t end =
        quote < text.size() && (text[quote] == '"' || text[quote] == '\'')
            ? text.find(text[quote], quote + 1)
            : std::string::npos;
    if (end == std::string::npos) {
      from.refuse_text("an attribute without value", std::string(vtp_remedy));
    }
    tag.attributes[text.substr(i, equals - i)] = text.substr(quote + 1, end - quote - 1);
    i = end + 1;
  }
  return tag;
}

/// Decodes bytes written in base64, from where the file is.
class Base64 {
 public:
  explicit Base64(ByteStream& from) : from_(from) {}

  void take(void* to, std::size_t bytes) {
    auto* out = static_cast<char*>(to);
    for (; bytes > 0; --bytes) {
      while (bits_ < 8) {
        word_ = word_ << 6 | digit();
        bits_ += 6;
      }
      bits_ -= 8;
      *out++ = static_cast<char>(word_ >> bits_ & 255U);
    }
  }

 private:
  std::uint32_t digit() {
    from_.skip_blanks();
    const int c = from_.peek();
    std::uint32_t value = 64;
    if (c >= 'A' && c <= 'Z') value = static_cast<std::uint32_t>(c - 'A');
    if (c >= 'a' && c <= 'z') value = static_cast<std::uint32_t>(c - 'a' + 26);
    if (c >= '0' && c <= '9') value = static_cast<std::uint32_t>(c - '0' + 52);
    if (c == '+') value = 62;
    if (c == '/') value = 63;
    if (value == 64) {
      from_.refuse("base64 data end here", std::string(vtp_remedy));
    }
    from_.get();
    return value;
  }

  ByteStream& from_;
  std::uint32_t word_ = 0;
  int bits_ = 0;
};

struct VtpArray {
  std::string type;
  bool there = false, appended = false;
  std::uint64_t offset = 0;
  std::vector<double> values;
};

struct VtpPiece {
  std::uint64_t points = 0, lines = 0;
  VtpArray places, connectivity, ends;

  bool appended() const {
    return places.appended || connectivity.appended || ends.appended;
  }
};

class VtpReader {
 public:
  explicit VtpReader(ByteStream& from) : from_(from) {}

  GroomFile read() {
    bool begun = false;
    while (const auto tag = next_tag(from_)) {
      if (tag->name == "VTKFile") {
        begun = true;
        begin_file(*tag);
      } else if (!begun && !tag->name.starts_with('?') && !tag->name.starts_with('!')) {
        break;
      } else if (tag->name == "Piece") {
        pieces_.push_back(
            {whole(*tag, "NumberOfPoints"), whole(*tag, "NumberOfLines"), {}, {}, {}});
      } else if (tag->name == "/Piece") {
        if (!pieces_.empty() && !pieces_.back().appended()) add(pieces_.back());
      } else if (tag->name == "Points" || tag->name == "Lines") {
        section_ = tag->name;
      } else if (tag->name == "/Points" || tag->name == "/Lines") {
        section_.clear();
      } else if (tag->name == "DataArray") {
        begin_array(*tag);
      } else if (tag->name == "AppendedData") {
        begin_appended(*tag);
        break;  // what follows may be binary
      }
    }
    if (!begun) {
      throw InputError("no VTKFile", from_.file() + ":1", "give a .vtp file of VTK");
    }
    if (pieces_.empty()) {
      throw InputError("no Piece of PolyData", from_.file(), std::string(vtp_remedy));
    }
    for (VtpPiece& piece : pieces_) add(piece);
    return std::move(made_);
  }

 private:
  std::uint64_t whole(const XmlTag& tag, std::string_view key) {
    const std::string_view text = tag[key];
    std::uint64_t x = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), x);
    if (!text.empty() && end == text.data() + text.size() && error == std::errc{})
      return x;
    from_.refuse_text(fmt::format("{} = '{}' of {}", key, text, tag.name),
                      std::string(vtp_remedy));
  }

  void begin_file(const XmlTag& tag) {
    const auto refuse_unless = [&](bool good, std::string_view key,
                                   std::string_view hint) {
      if (good) return;
      from_.refuse_text(fmt::format("{} = '{}'", key, tag[key]), std::string(hint));
    };
    refuse_unless(tag["type"] == "PolyData", "type", "write the strands as PolyData");
    refuse_unless(tag["byte_order"] != "BigEndian", "byte_order", "write LittleEndian");
    refuse_unless(tag["compressor"].empty(), "compressor",
                  "write without compression (ParaView: Compressor Type None)");
    wide_ = tag["header_type"] == "UInt64";
  }

  VtpArray* array_of(const XmlTag& tag) {
    if (pieces_.empty()) return nullptr;
    if (section_ == "Points") return &pieces_.back().places;
    if (section_ != "Lines") return nullptr;
    if (tag["Name"] == "connectivity") return &pieces_.back().connectivity;
    if (tag["Name"] == "offsets") return &pieces_.back().ends;
    return nullptr;
  }

  void begin_array(const XmlTag& tag) {
    VtpArray* array = array_of(tag);
    if (array == nullptr) return;
    array->there = true;
    array->type = tag["type"];
    if (tag["format"] == "appended") {
      array->appended = true;
      array->offset = whole(tag, "offset");
    } else if (tag["format"] == "binary") {
      Base64 bytes(from_);
      load(*array, bytes);
    } else {
      from_.skip_blanks();
      while (from_.peek() != '<' && from_.peek() >= 0) {
        array->values.push_back(from_.decimal());
        from_.skip_blanks();
      }
    }
  }

  /// Bytes of the array, then the numbers.
  template <class Bytes>
  void load(VtpArray& array, Bytes& bytes) {
    std::uint64_t size = 0;
    bytes.take(&size, wide_ ? 8 : 4);
    from_.require(size, 1, "bytes of an array");
    taken_ += size;
    if (taken_ > from_.size()) {
      from_.refuse("arrays that have more bytes than the file: two share an offset",
                   "write the file again");
    }
    const auto read_as = [&]<class T>(T) {
      array.values.reserve(size / sizeof(T));
      for (std::uint64_t i = 0; i < size / sizeof(T); ++i) {
        T x;
        bytes.take(&x, sizeof x);
        array.values.push_back(static_cast<double>(x));
      }
    };
    if (array.type == "Float32") return read_as(float{});
    if (array.type == "Float64") return read_as(double{});
    if (array.type == "Int32") return read_as(std::int32_t{});
    if (array.type == "Int64") return read_as(std::int64_t{});
    if (array.type == "UInt32") return read_as(std::uint32_t{});
    if (array.type == "UInt64") return read_as(std::uint64_t{});
    from_.refuse(fmt::format("numbers of type '{}'", array.type),
                 "write Float32 or Float64, Int32 or Int64");
  }

  void begin_appended(const XmlTag& tag) {
    int c = from_.get();
    while (c >= 0 && c != '_') c = from_.get();
    const std::uint64_t base = from_.at();
    const bool raw = tag["encoding"] == "raw";
    for (VtpPiece& piece : pieces_) {
      if (!piece.appended()) continue;
      for (VtpArray* array : {&piece.places, &piece.connectivity, &piece.ends}) {
        if (!array->appended) continue;
        array->appended = false;
        if (array->offset > from_.size()) {
          from_.refuse(fmt::format("an array at offset {}", array->offset), "");
        }
        from_.seek(base + array->offset);
        if (raw) {
          load(*array, from_);
        } else {
          Base64 bytes(from_);
          load(*array, bytes);
        }
      }
      add(piece);
    }
  }

  /// Judges the piece and leaves nothing of it but its strands.
  void add(VtpPiece& piece) {
    const auto count = [&](const VtpArray& array, std::string_view name,
                           std::uint64_t wanted, std::size_t each = 1) {
      const std::size_t found = array.values.size();
      if (!array.appended && found / each == wanted && found % each == 0) return;
      throw InputError(fmt::format("{} {} where {} belong", found / each, name, wanted),
                       from_.file(), "the file is damaged: write it again");
    };
    if (piece.lines == 0) {
      piece = {};
      return;
    }
    count(piece.places, "points", piece.points, 3);
    count(piece.ends, "ends of lines", piece.lines);
    count(piece.connectivity, "points of lines",
          piece.ends.values.back() >= 0
              ? static_cast<std::uint64_t>(std::min(piece.ends.values.back(), 1e18))
              : 0);
    double from = 0;
    for (const double end : piece.ends.values) {
      if (!(end >= from &&
            end <= static_cast<double>(piece.connectivity.values.size()))) {
        throw InputError(
            fmt::format("line {} ends at {} after {}", made_.lines.size(), end, from),
            from_.file(), "the file is damaged: write it again");
      }
      for (auto k = static_cast<std::size_t>(from); k < static_cast<std::size_t>(end);
           ++k) {
        const double i = piece.connectivity.values[k];
        if (!(i >= 0 && i < static_cast<double>(piece.points))) {
          throw InputError(fmt::format("line {} has point {} of {}", made_.lines.size(),
                                       i, piece.points),
                           from_.file(), "the file is damaged: write it again");
        }
        made_.lines.points.push_back(
            load3(&piece.places.values[3 * static_cast<std::size_t>(i)]));
      }
      made_.lines.end_strand(made_.lines.size(), 0);
      from = end;
    }
    piece = {};
  }

  ByteStream& from_;
  GroomFile made_;
  std::vector<VtpPiece> pieces_;
  std::string section_;
  std::uint64_t taken_ = 0;  // bytes of all arrays so far
  bool wide_ = false;
};

}  // namespace

GroomFile read_vtp(ByteStream& from) { return VtpReader(from).read(); }

}  // namespace tress::simulation
