#include <fmt/format.h>

#include <algorithm>

#include "contract/input_error.h"
#include "simulation/groom/curve_basis.h"
#include "simulation/groom/read_groom.h"
#include "simulation/groom/usd_text.h"

namespace tress::simulation {
namespace {

/// One prim: { ... }.
struct Prim {
  bool curves = false;
  std::string moved;  // the transform that is not the identity; empty: none
  std::string type = "cubic", basis = "bezier", wrap = "nonperiodic";
  std::vector<std::size_t> counts;
  std::vector<Vec> points;
  int line = 0;  // of the points
};

bool is_identity(std::string_view op, const std::vector<double>& x) {
  const auto all = [&x](double value) {
    return std::ranges::all_of(x, [value](double y) { return y == value; });
  };
  if (op.starts_with("xformOp:translate") || op.starts_with("xformOp:rotate")) {
    return all(0);
  }
  if (op.starts_with("xformOp:scale")) return all(1);
  if (op.starts_with("xformOp:orient")) {
    return x == std::vector<double>{1, 0, 0, 0};
  }
  if (!op.starts_with("xformOp:transform") || x.size() != 16) return false;
  for (std::size_t i = 0; i < 16; ++i) {
    if (x[i] != (i % 5 == 0 ? 1 : 0)) return false;
  }
  return true;
}

class UsdReader {
 public:
  explicit UsdReader(ByteStream& from) : from_(from), text_(from) { made_.text = true; }

  GroomFile read() {
    std::string first = from_.text_line();
    if (!first.starts_with("#usda")) {
      throw InputError("the file does not begin with #usda", from_.file() + ":1",
                       first.starts_with("PXR-USDC")
                           ? "write it as text: usdcat -o strands.usda"
                           : "give a USD file in text form");
    }
    if (text_.next() == '(') read_layer();
    while (text_.next() >= 0 || !prims_.empty()) read_statement();
    if (curves_ == 0) {
      throw InputError("no BasisCurves", from_.file(),
                       "export hair as curves, not as meshes or NURBS");
    }
    if (samples_) made_.note = "of an animation the first frame is read";
    return std::move(made_);
  }

 private:
  /// The layer's metadata.
  void read_layer() {
    text_.expect('(');
    while (text_.next() != ')') {
      const int c = text_.next();
      if (c == '"' || c == '\'') {
        text_.quoted();
        continue;
      }
      if (c == ';' || c == ',') {
        from_.get();
        continue;
      }
      const std::string key = text_.word();
      if (key.empty()) text_.expect(')');
      if (text_.next() != '=') continue;
      text_.expect('=');
      text_.next();
      if (key == "metersPerUnit") {
        const double metres = from_.decimal();
        if (!(metres > 0 && metres < 1e6)) {
          from_.refuse_text(fmt::format("metersPerUnit = {}", metres),
                            "give a number of metres > 0");
        }
        made_.metres = metres;
      } else if (key == "upAxis") {
        const std::string axis = text_.quoted();
        if (axis.size() != 1 || axis[0] < 'X' || axis[0] > 'Z') {
          from_.refuse_text(fmt::format("upAxis = \"{}\"", axis), "give X, Y or Z");
        }
        made_.up = FileAxis{axis[0] - 'X', false};
      } else {
        text_.skip_value();
      }
    }
    text_.expect(')');
  }

  void read_statement() {
    const int c = text_.next();
    if (c == ';' || c == ',') {
      from_.get();
      return;
    }
    if (c == '(') {  // metadata of the value before
      text_.skip_value();
      return;
    }
    if (c == '"' || c == '\'') {
      text_.quoted();
      return;
    }
    if (c == '}') {
      if (prims_.empty()) text_.expect('d');  // of def, which alone may follow
      from_.get();
      end_prim();
      return;
    }
    if (c == '=') {
      from_.get();
      read_value();
      return;
    }
    std::string word = text_.word();
    if (word.empty()) text_.expect('}');
    if (word == "def" || word == "over" || word == "class") {
      begin_prim();
    } else {
      name_ = std::move(word);  // the last one before = is the attribute's
    }
  }

  void begin_prim() {
    Prim prim;
    if (text_.next() != '"') prim.curves = text_.word() == "BasisCurves";
    text_.quoted();
    if (text_.next() == '(') text_.skip_value();
    text_.expect('{');
    constexpr std::size_t most_depth = 100;
    if (prims_.size() == most_depth) {
      from_.refuse_text("prims nested more than 100 deep", "flatten the file");
    }
    prims_.push_back(std::move(prim));
    name_.clear();
  }

  void read_value() {
    std::string name = std::move(name_);
    name_.clear();
    const bool sampled = name.ends_with(".timeSamples");
    if (sampled) name.resize(name.size() - std::string_view(".timeSamples").size());
    if (prims_.empty() || text_.next() == 'N') {  // None
      text_.skip_value();
      return;
    }
    Prim& prim = prims_.back();
    if (name.starts_with("xformOp:")) {
      if (!is_identity(name, text_.numbers()) || sampled) prim.moved = name;
      return;
    }
    const bool of_curves = name == "points" || name == "curveVertexCounts";
    if (!prim.curves || (sampled && !of_curves)) {
      text_.skip_value();
      return;
    }
    if (name == "type") {
      prim.type = text_.quoted();
    } else if (name == "basis") {
      prim.basis = text_.quoted();
    } else if (name == "wrap") {
      prim.wrap = text_.quoted();
    } else if (of_curves) {
      if (sampled) {
        text_.expect('{');
        text_.next();
        from_.decimal();
        text_.expect(':');
        samples_ = true;
      }
      name == "points" ? read_points(prim) : read_counts(prim);
      if (sampled) skip_samples();
    } else {
      text_.skip_value();
    }
  }

  /// All samples after the first.
  void skip_samples() {
    while (text_.next() == ',') {
      from_.get();
      if (text_.next() == '}') break;
      from_.decimal();
      text_.expect(':');
      text_.skip_value();
    }
    text_.expect('}');
  }

  void read_points(Prim& prim) {
    prim.points.clear();
    prim.line = from_.line();
    text_.list([&] {
      Vec x;
      text_.expect('(');
      x.x = from_.decimal();
      text_.expect(',');
      x.y = from_.decimal();
      text_.expect(',');
      x.z = from_.decimal();
      text_.expect(')');
      prim.points.push_back(x);
    });
  }
  void read_counts(Prim& prim) {
    prim.counts.clear();
    text_.list([&] { prim.counts.push_back(from_.whole()); });
  }

  void end_prim() {
    if (prims_.back().curves) add_curves(prims_.back());
    prims_.pop_back();
    name_.clear();
  }

  void add_curves(const Prim& prim) {
    ++curves_;
    for (const Prim& above : prims_) {
      if (above.moved.empty()) continue;
      from_.refuse_text(
          fmt::format("curves moved by {}, which is not applied here", above.moved),
          "apply the transform (Blender: Object > Apply > All Transforms) and export "
          "again");
    }
    const auto basis = curve_basis(prim.type, prim.basis);
    if (!basis || prim.wrap == "periodic") {
      from_.refuse_text(
          fmt::format("curves of type {}, basis {}, wrap {}", prim.type, prim.basis,
                      prim.wrap),
          "export linear curves, or bezier, bspline or catmullRom that are open");
    }
    std::size_t from = 0;
    const bool pinned = prim.wrap == "pinned";
    for (const std::size_t count : prim.counts) {
      if (count > prim.points.size() - from) {
        from_.refuse_text(fmt::format("curves of more than the {} points that there are",
                                      prim.points.size()),
                          "the file is damaged: write it again");
      }
      const std::span control = std::span(prim.points).subspan(from, count);
      const std::vector<Vec> on = points_on(control, *basis, pinned);
      made_.lines.points.insert(made_.lines.points.end(), on.begin(), on.end());
      made_.lines.end_strand(made_.lines.size(), static_cast<std::uint64_t>(prim.line));
      from += count;
    }
    if (from != prim.points.size()) {
      from_.refuse_text(
          fmt::format("curves of {} points where there are {}", from, prim.points.size()),
          "the file is damaged: write it again");
    }
  }

  ByteStream& from_;
  UsdText text_;
  GroomFile made_;
  std::vector<Prim> prims_;
  std::string name_;
  int curves_ = 0;
  bool samples_ = false;
};

}  // namespace

GroomFile read_usda(ByteStream& from) { return UsdReader(from).read(); }

}  // namespace tress::simulation
