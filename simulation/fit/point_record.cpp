#include "simulation/fit/point_record.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

#include "contract/decimal.h"
#include "contract/input_error.h"
#include "contract/read_file.h"
#include "simulation/files/csv.h"

namespace tress::simulation {
namespace {

constexpr std::array<std::string_view, 3> coordinates{"x_m", "y_m", "z_m"};
constexpr std::string_view others[] = {"strand", "point", "time_s", "sigma_m"};
constexpr std::size_t fewest = 3;  // coordinates
constexpr std::size_t most_index = 10'000'000;
constexpr const char* header_remedy =
    "give time_s, x_m, y_m, z_m, and where needed strand, point, sigma_m";

std::string text_of(const std::string& file, const CellPlace& at) {
  return fmt::format("{}:{}:{}", file, at.line, at.column);
}

class Reader {
 public:
  Reader(std::string_view text, const std::string& file)
      : table_(parse_csv(text, file)), file_(file) {
    refuse_if(table_.header.empty(), "the file is empty", file + ":1:1", header_remedy);
    for (std::size_t c = 0; c < table_.header.size(); ++c) {
      const std::string& name = table_.header[c];
      const bool known = std::ranges::count(coordinates, name) > 0 ||
                         std::ranges::count(others, name) > 0;
      refuse_if(!known, fmt::format("unknown column '{}'", name), place(0, c),
                header_remedy);
    }
    refuse_if(!has("time_s"), "no column 'time_s'", place(0, 0), header_remedy);
    refuse_if(!has_points(table_.header), "no column 'x_m', 'y_m' or 'z_m'", place(0, 0),
              header_remedy);
  }

  void read(PointRecord& record) const {
    for (std::size_t i = 0; i < table_.rows.size(); ++i) add_row(record, i);
    refuse_if(record.observations.size() < fewest,
              fmt::format("measured coordinates: {}", record.observations.size()),
              place(0, 0), fmt::format("give at least {}", fewest));
  }

 private:
  bool has(std::string_view name) const {
    return std::ranges::count(table_.header, name) > 0;
  }
  std::string place(std::size_t line, std::size_t c) const {
    return text_of(file_, table_.places[line][c]);
  }
  const CellPlace& cell_place(std::size_t i, std::string_view name) const {
    const auto c = std::ranges::find(table_.header, name) - table_.header.begin();
    return table_.places[i + 1][static_cast<std::size_t>(c)];
  }
  std::string place(std::size_t i, std::string_view name) const {
    return text_of(file_, cell_place(i, name));
  }
  /// Of a column that the table may lack: empty.
  std::string_view cell(std::size_t i, std::string_view name) const {
    return has(name) ? table_.rows[i].text(name) : std::string_view();
  }

  double number(std::size_t i, std::string_view name,
                const char* remedy = "give a number, or leave out the line") const {
    const std::string_view text = cell(i, name);
    const double x = decimal(text).value_or(std::nan(""));
    refuse_if(!std::isfinite(x),
              fmt::format("{} = '{}' is not a finite number", name, text), place(i, name),
              remedy);
    return x;
  }
  std::size_t index(std::size_t i, std::string_view name) const {
    const double x = number(i, name);
    refuse_if(x < 0 || x != std::floor(x) || x > static_cast<double>(most_index),
              fmt::format("{} = {} is no index", name, cell(i, name)), place(i, name),
              "count from 0");
    return static_cast<std::size_t>(x);
  }

  void add_row(PointRecord& record, std::size_t i) const {
    Observation one;
    one.row = i;
    one.t = number(i, "time_s");
    refuse_if(one.t < 0, fmt::format("time_s = {} is before the start", one.t),
              place(i, "time_s"), "give times since the start of the run");
    if (!cell(i, "strand").empty()) one.strand = index(i, "strand");
    const std::string_view point = cell(i, "point");
    if (!point.empty() && point != "tip") one.point = index(i, "point");
    double sigma = 0;
    if (has("sigma_m")) {
      sigma = number(i, "sigma_m");
      refuse_if(!(sigma > 0), fmt::format("sigma_m = {} is not positive", sigma),
                place(i, "sigma_m"), "give a standard error above 0, or leave it out");
    }
    const int time = cell_place(i, "time_s").column;
    const auto column = [&](std::string_view name) {
      return has(name) ? cell_place(i, name).column : time;
    };
    record.places.push_back(
        {cell_place(i, "time_s").line, time, column("strand"), column("point")});
    for (std::size_t k = 0; k < coordinates.size(); ++k) {
      if (cell(i, coordinates[k]).empty()) continue;
      one.component = k;
      one.value = number(i, coordinates[k],
                         "give a number, or leave the cell empty if it was not measured");
      record.observations.push_back(one);
      if (sigma > 0) record.sigma.push_back(sigma);
    }
  }

  CsvTable table_;
  const std::string& file_;
};

}  // namespace

std::string PointRecord::place(const Observation& one, int RowPlace::*cell) const {
  const RowPlace& row = places[one.row];
  return text_of(file, {row.line, row.*cell});
}

bool has_points(const std::vector<std::string>& header) {
  return std::ranges::any_of(
      coordinates, [&](auto name) { return std::ranges::count(header, name) > 0; });
}

PointRecord parse_point_record(std::string_view text, const std::string& file) {
  Row content;
  content.set("text", text);
  PointRecord record{.file = file, .hash = run_id("points", content)};
  Reader(text, file).read(record);
  return record;
}

PointRecord read_point_record(const std::string& file) {
  return parse_point_record(read_file(file, most_table_bytes), file);
}

}  // namespace tress::simulation
