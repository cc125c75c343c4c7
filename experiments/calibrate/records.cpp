#include "experiments/calibrate/records.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include "contract/decimal.h"
#include "contract/input_error.h"
#include "contract/read_file.h"
#include "simulation/files/csv.h"
#include "simulation/files/row.h"

namespace tress::experiments::calibrate {
namespace {

constexpr std::size_t fewest_points = 5;
constexpr const char* header_remedy =
    "give t_s,amplitude_m, sigma_m where it is known, and parameters of the strand; or, "
    "for points of the strands of --scene, time_s, x_m, y_m, z_m";

class Reader {
 public:
  Reader(std::string_view text, const std::string& file, Observed observed)
      : table_(parse_csv(text, file)), file_(file), observed_(observed) {
    if (table_.header.empty()) {
      throw InputError("the file is empty", file + ":1:1", header_remedy);
    }
    time_ = required("t_s");
    amplitude_ = required("amplitude_m");
    sigma_ = column("sigma_m");
    for (std::size_t c = 0; c < table_.header.size(); ++c) {
      if (c != time_ && c != amplitude_ && sigma_ != c) labels_.push_back(c);
    }
  }

  std::vector<Record> records() {
    std::vector<Record> all;
    for (std::size_t i = 0; i < table_.rows.size(); ++i) {
      if (i == 0 || labels_change(i)) {
        if (i > 0) check_complete(all.back(), i - 1);
        all.emplace_back().of_strand = settings(i);
      }
      add_point(all.back(), i);
    }
    if (all.empty()) {
      throw InputError("no points", place(0, 0), "give one line per point");
    }
    check_complete(all.back(), table_.rows.size() - 1);
    return all;
  }

 private:
  std::string place(std::size_t line, std::size_t c) const {
    const CellPlace& at = table_.places[line][c];
    return fmt::format("{}:{}:{}", file_, at.line, at.column);
  }
  std::string_view cell(std::size_t i, std::size_t c) const {
    return table_.rows[i].text(table_.header[c]);
  }

  std::optional<std::size_t> column(std::string_view name) const {
    const auto found = std::ranges::find(table_.header, name);
    if (found == table_.header.end()) return {};
    return static_cast<std::size_t>(found - table_.header.begin());
  }
  std::size_t required(std::string_view name) const {
    if (const auto c = column(name)) return *c;
    throw InputError(fmt::format("no column '{}'", name), place(0, 0), header_remedy);
  }

  double number(std::size_t i, std::size_t c) const {
    const std::string_view text = cell(i, c);
    const double x = decimal(text).value_or(std::nan(""));
    if (!std::isfinite(x)) {
      throw InputError(
          fmt::format("{} = '{}' is not a finite number", table_.header[c], text),
          place(i + 1, c), "give a number, or leave out the line");
    }
    return x;
  }
  double positive(std::size_t i, std::size_t c) const {
    const double x = number(i, c);
    if (x > 0) return x;
    throw InputError(fmt::format("{} = {} is not positive", table_.header[c], x),
                     place(i + 1, c), "give a number above 0, or leave out the line");
  }

  void add_point(Record& record, std::size_t i) const {
    const double t = number(i, time_);
    if (t < 0 || (!record.t.empty() && t <= record.t.back())) {
      throw InputError(
          record.t.empty()
              ? fmt::format("t_s = {} is before the start", t)
              : fmt::format("t_s = {} does not follow {}", t, record.t.back()),
          place(i + 1, time_),
          "give ascending times since the start; a column 'record' parts repetitions");
    }
    record.t.push_back(t);
    record.end = place(i + 1, time_);
    record.value.push_back(observed_ == Observed::envelope ? positive(i, amplitude_)
                                                           : number(i, amplitude_));
    if (sigma_) record.sigma.push_back(positive(i, *sigma_));
  }

  bool labels_change(std::size_t i) const {
    return std::ranges::any_of(
        labels_, [&](std::size_t c) { return cell(i, c) != cell(i - 1, c); });
  }
  std::vector<Record::Setting> settings(std::size_t i) const {
    std::vector<Record::Setting> all;
    for (const std::size_t c : labels_) {
      if (table_.header[c] == "record") continue;
      all.push_back({table_.header[c], std::string(cell(i, c)), place(i + 1, c)});
    }
    return all;
  }
  void check_complete(const Record& record, std::size_t last) const {
    if (record.t.size() >= fewest_points) return;
    throw InputError(fmt::format("a record of {} points ends here", record.t.size()),
                     place(last + 1, 0), fmt::format("give at least {}", fewest_points));
  }

  CsvTable table_;
  const std::string& file_;
  Observed observed_;
  std::size_t time_ = 0, amplitude_ = 0;
  std::optional<std::size_t> sigma_;
  std::vector<std::size_t> labels_;  // columns that distinguish records
};

}  // namespace

std::size_t Records::points() const {
  std::size_t sum = 0;
  for (const Record& record : all) sum += record.t.size();
  return sum;
}

Records parse_records(std::string_view text, const std::string& file, Observed observed) {
  Row content;
  content.set("text", text);
  return {Reader(text, file, observed).records(), run_id("records", content)};
}

Records read_records(const std::string& file, Observed observed) {
  return parse_records(read_file(file, most_table_bytes), file, observed);
}

}  // namespace tress::experiments::calibrate
