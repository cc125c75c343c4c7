#include "tests/fuzz/pair_tables.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <string_view>

namespace tress::testing_support {
namespace {

constexpr double thermal = 4e-21;  // J, kT at room temperature: less is no motion
constexpr double never = std::numeric_limits<double>::infinity();

bool exact(std::string_view column) {
  return column == "t_s" || column == "failed_strands";
}

/// Numbers of the points of every frame of a .usda file.
std::vector<std::vector<double>> frames_of(const std::string& file) {
  std::ifstream lines(file);
  std::vector<std::vector<double>> frames;
  bool inside = false;
  for (std::string line; std::getline(lines, line);) {
    if (line.find("points.timeSamples") != std::string::npos) {
      inside = true;
    } else if (inside && line.find('}') != std::string::npos) {
      break;
    } else if (inside) {
      std::vector<double>& numbers = frames.emplace_back();
      const char* at = line.data() + line.find('[');
      for (const char* const end = line.data() + line.size(); at < end;) {
        double x = 0;
        const auto read = std::from_chars(at, end, x);
        if (read.ec == std::errc()) numbers.push_back(x);
        at = read.ec == std::errc() ? read.ptr : at + 1;
      }
    }
  }
  return frames;
}

/// Largest difference of some numbers, and the largest of them.
struct Span {
  double off = 0, size = 0;
};

/// Kinds of failures, each with the words of a batch and those of single strands.
constexpr std::array<std::array<std::string_view, 3>, 5> kinds = {{
    {"stretch", "off its length", "off its length"},
    {"energy", "more energy than it can have", "more energy than at the start"},
    {"speed", "faster than its energy allows", "a point moves at"},
    {"solution", "no solution", "no solution"},
    {"numbers", "finite", "finite"},
}};

std::string kind_of(std::string_view message) {
  for (const auto& [kind, of_batch, of_strand] : kinds) {
    for (const std::string_view words : {of_batch, of_strand}) {
      if (message.find(words) != std::string_view::npos) return std::string(kind);
    }
  }
  return "other";
}

/// Whether both are bounds of a guard. One that is judged later may find another one.
bool of_guards(const Failure& one, const Failure& other) {
  const auto guard = [](const Failure& f) {
    return f.kind != "solution" && f.kind != "other";
  };
  return guard(one) && guard(other);
}

}  // namespace

Columns columns(const std::string& file) {
  std::ifstream lines(file);
  std::string line, cell;
  std::vector<std::string> names;
  Columns all;
  while (std::getline(lines, line)) {
    const bool heads = names.empty();
    std::istringstream cells(line);
    for (std::size_t i = 0; std::getline(cells, cell, ','); ++i) {
      if (heads) {
        names.push_back(cell);
      } else {
        all[names.at(i)].push_back(cell.empty() ? std::nan("") : std::stod(cell));
      }
    }
  }
  return all;
}

Apart apart(const Columns& batch, const Columns& strands, std::size_t rows) {
  Apart found;
  double energy = 0, largest = thermal;
  std::map<std::string, Span> places;  // of the means of one vector together
  for (const auto& [name, other] : strands) {
    if (!batch.contains(name)) continue;
    if (name == "gravity_j" && strands.contains("constant_force_j")) continue;
    const std::vector<double>& one = batch.at(name);
    for (std::size_t i = 0; i < rows; ++i) {
      if (i >= one.size() || i >= other.size()) {
        found.unequal = name;
        break;
      }
      if (std::isnan(one[i]) && std::isnan(other[i])) continue;
      const double off = one[i] == other[i] ? 0 : std::abs(one[i] - other[i]);
      if (exact(name)) {
        if (off != 0) found.unequal = name;
      } else if (name.ends_with("_j")) {
        energy = std::max(energy, std::isfinite(off) ? off : never);
        largest = std::max(largest, std::abs(other[i]));
      } else {
        Span& of = places[name.starts_with("tip_") ? "tip" : name];
        of.off = std::max(of.off, std::isfinite(off) ? off : never);
        of.size = std::max(of.size, std::abs(other[i]));
      }
    }
  }
  found.energy = energy / largest;
  for (const auto& [name, of] : places) {
    if (of.off > 0) found.place = std::max(found.place, of.off / of.size);
  }
  return found;
}

double points_apart(const std::string& batch, const std::string& strands) {
  const auto one = frames_of(batch), other = frames_of(strands);
  if (one.size() != other.size()) return never;
  double most = 0, low = never, high = -never;
  bool compared = false;
  for (std::size_t f = 0; f < one.size(); ++f) {
    // A curve's number of points follows its bending, so a frame can have another one.
    if (one[f].size() != other[f].size()) continue;
    compared = true;
    for (std::size_t i = 0; i < one[f].size(); ++i) {
      most = std::max(most, std::abs(one[f][i] - other[f][i]));
      low = std::min(low, other[f][i]);
      high = std::max(high, other[f][i]);
    }
  }
  if (!compared) return std::numeric_limits<double>::quiet_NaN();
  return most > 0 ? most / (high - low) : 0;
}

Failure failure_in(const std::string& message) {
  Failure found;
  const std::size_t t = message.find("at t = "), strand = message.find("strand ");
  if (t == std::string::npos || strand == std::string::npos) return found;
  found.t = std::stod(message.substr(t + 7));
  found.strand = std::stol(message.substr(strand + 7));
  found.kind = kind_of(message);
  return found;
}

std::vector<Failure> failures_of(const std::string& file) {
  std::ifstream lines(file);
  std::vector<Failure> all;
  std::string line;
  std::getline(lines, line);
  while (std::getline(lines, line)) {
    Failure one;
    one.strand = std::stol(line);
    one.t = std::stod(line.substr(line.find(',') + 1));
    one.kind = kind_of(line);
    all.push_back(one);
  }
  return all;
}

std::string different_failures(const std::vector<Failure>& batch,
                               const std::vector<Failure>& strands, double late) {
  for (const Failure& one : strands) {
    if (!one.some()) return "no failed strand is named";
    const auto found = std::ranges::find(batch, one.strand, &Failure::strand);
    if (found == batch.end()) return "other strands fail";
    if (found->kind != one.kind && (late == 0 || !of_guards(*found, one))) {
      return "a strand fails for another reason";
    }
    const double digits = 1e-8 * one.t;  // of a printed time
    if (std::abs(found->t - one.t) > late + digits)
      return "a strand fails at another time";
  }
  return {};
}

}  // namespace tress::testing_support
