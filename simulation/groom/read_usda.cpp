#include <fmt/format.h>

#include <map>

#include "contract/input_error.h"
#include "simulation/groom/read_groom.h"
#include "simulation/groom/usd_curves.h"
#include "simulation/groom/usd_text.h"

namespace tress::simulation {
namespace {

/// One prim: { ... }.
struct Prim {
  std::string kind;       // BasisCurves, Xform, ...; empty: none is given
  std::size_t first = 0;  // of the curve sets within
  Hidden hidden = Hidden::no;
  std::optional<Hidden> purpose;
  std::map<std::string, std::vector<double>, std::less<>> operations;
  std::vector<std::string> order;  // of the operations
  // Of BasisCurves.
  std::string type = "cubic", basis = "bezier", wrap = "nonperiodic";
  UsdCurveSet curves;

  bool is_curves() const { return kind == "BasisCurves"; }
  /// Only these prims have transforms [OpenUSD, UsdGeomXformable].
  bool is_placed() const { return !kind.empty() && kind != "Scope"; }
};

class UsdReader {
 public:
  UsdReader(ByteStream& from, const GroomReading& reading)
      : from_(from), text_(from), curves_(from, reading) {
    made_.text = true;
    // [OpenUSD, UsdGeomGetStageMetersPerUnit, UsdGeomGetStageUpAxis]
    made_.format_metres = 0.01;
    made_.format_up = FileAxis{1, false};
  }

  GroomFile read() {
    std::string first = from_.text_line();
    if (!first.starts_with("#usda")) {
      throw InputError("the file does not begin with #usda", from_.file() + ":1",
                       first.starts_with("PXR-USDC")
                           ? "write it as text: usdcat -o strands.usda"
                           : "give a USD file in text form");
    }
    if (text_.next() == '(') {
      text_.metadata([this](std::string_view key) { return read_of_layer(key); });
    }
    while (text_.next() >= 0 || !prims_.empty()) read_statement();
    if (curves_.size() == 0) {
      throw InputError("no BasisCurves", from_.file(),
                       "export hair as curves, not as meshes or NURBS");
    }
    if (samples_) made_.notes.emplace_back("of an animation the first frame is read");
    curves_.finish(made_);
    return std::move(made_);
  }

 private:
  bool read_of_layer(std::string_view key) {
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
      return false;
    }
    return true;
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
      begin_prim(word);
    } else {
      name_ = std::move(word);  // the last one before = is the attribute's
    }
  }

  void begin_prim(std::string_view specifier) {
    Prim prim;
    prim.first = curves_.size();
    if (specifier == "over") prim.hidden = Hidden::undefined;
    if (specifier == "class") prim.hidden = Hidden::abstract;
    if (text_.next() != '"') prim.kind = text_.word();
    text_.quoted();
    if (text_.next() == '(') {
      text_.metadata([&](std::string_view key) {
        if (key != "active") return false;
        const std::string value = text_.word();
        if (value == "false" || value == "0") prim.hidden = Hidden::inactive;
        return true;
      });
    }
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
    constexpr std::string_view samples = ".timeSamples";
    const bool sampled = name.ends_with(samples);
    if (sampled) name.resize(name.size() - samples.size());
    if (prims_.empty() || text_.next() == 'N' || !knows(prims_.back(), name)) {
      text_.skip_value();  // also None
      return;
    }
    if (sampled) {
      text_.expect('{');
      if (text_.next() == '}') return text_.expect('}');
      from_.decimal();
      text_.expect(':');
      if (text_.next() == 'N') {
        text_.skip_value();
      } else {
        read_attribute(prims_.back(), name);
      }
      skip_samples();
      samples_ = true;
    } else {
      read_attribute(prims_.back(), name);
    }
  }

  static bool knows(const Prim& prim, std::string_view name) {
    if (name.starts_with("xformOp:")) return name.find('.') == std::string_view::npos;
    if (name == "xformOpOrder" || name == "visibility" || name == "purpose") return true;
    return prim.is_curves() &&
           (name == "type" || name == "basis" || name == "wrap" || name == "points" ||
            name == "curveVertexCounts" || name == "widths");
  }

  void read_attribute(Prim& prim, const std::string& name) {
    if (name.starts_with("xformOp:")) {
      prim.operations[name] = text_.numbers();
    } else if (name == "xformOpOrder") {
      prim.order.clear();
      text_.list([&] { prim.order.push_back(text_.quoted()); });
    } else if (name == "visibility") {
      const bool invisible = text_.quoted() == "invisible";
      if (invisible && prim.hidden == Hidden::no) prim.hidden = Hidden::invisible;
    } else if (name == "purpose") {
      const std::string purpose = text_.quoted();
      prim.purpose = purpose == "guide"   ? Hidden::guide
                     : purpose == "proxy" ? Hidden::proxy
                                          : Hidden::no;
    } else if (name == "points") {
      read_points(prim.curves);
    } else if (name == "widths") {
      prim.curves.widths = text_.numbers();
    } else if (name == "curveVertexCounts") {
      prim.curves.counts.clear();
      text_.list([&] { prim.curves.counts.push_back(from_.whole()); });
    } else {
      (name == "type"    ? prim.type
       : name == "basis" ? prim.basis
                         : prim.wrap) = text_.quoted();
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

  void read_points(UsdCurveSet& curves) {
    curves.points.clear();
    curves.line = from_.line();
    text_.list([&] {
      Vec x;
      text_.expect('(');
      x.x = from_.decimal();
      text_.expect(',');
      x.y = from_.decimal();
      text_.expect(',');
      x.z = from_.decimal();
      text_.expect(')');
      curves.points.push_back(x);
    });
  }

  void end_prim() {
    Prim& prim = prims_.back();
    if (prim.is_curves()) add_curves(prim);
    if (curves_.size() > prim.first) {
      if (prim.is_placed()) place(prim);
      if (prim.purpose) curves_.set_purpose(prim.first, *prim.purpose);
      if (prim.hidden != Hidden::no) curves_.hide(prim.first, prim.hidden);
    }
    prims_.pop_back();
    name_.clear();
  }

  void add_curves(Prim& prim) {
    const auto basis = curve_basis(prim.type, prim.basis);
    if (!basis || (prim.wrap != "nonperiodic" && prim.wrap != "pinned")) {
      from_.refuse_text(
          fmt::format("curves of type {}, basis {}, wrap {}", prim.type, prim.basis,
                      prim.wrap),
          "export linear curves, or bezier, bspline or catmullRom that are open");
    }
    prim.curves.basis = *basis;
    prim.curves.pinned = prim.wrap == "pinned";
    curves_.add(prim.curves);
  }

  /// The operations in their order, of which the first is applied last.
  void place(const Prim& prim) {
    constexpr std::string_view invert = "!invert!";
    Affine all;
    bool reset = false;
    for (std::string_view name : prim.order) {
      if (name == "!resetXformStack!") {
        all = {};
        reset = true;
        continue;
      }
      const bool inverted = name.starts_with(invert);
      if (inverted) name.remove_prefix(invert.size());
      const auto found = prim.operations.find(name);
      std::optional<Affine> one;
      if (found != prim.operations.end()) one = usd_operation(name, found->second);
      if (one && inverted) one = inverse(*one);
      if (!one) {
        from_.refuse_text(fmt::format("curves placed by {}{}, which has no map here",
                                      inverted ? invert : "", name),
                          "apply the transform (Blender: Object > Apply > All "
                          "Transforms) and export again");
      }
      all = all * *one;
    }
    if (!prim.order.empty()) curves_.place(prim.first, all, reset);
  }

  ByteStream& from_;
  UsdText text_;
  UsdCurves curves_;
  GroomFile made_;
  std::vector<Prim> prims_;
  std::string name_;
  bool samples_ = false;
};

}  // namespace

GroomFile read_usda(ByteStream& from, const GroomReading& reading) {
  return UsdReader(from, reading).read();
}

}  // namespace tress::simulation
