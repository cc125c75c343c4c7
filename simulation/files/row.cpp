#include "simulation/files/row.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>

#include "contract/decimal.h"
#include "simulation/files/checksum.h"

namespace tress::simulation {

Row& Row::set(std::string_view column, std::string_view text) {
  for (Cell& cell : cells_) {
    if (cell.first == column) {
      cell.second = text;
      return *this;
    }
  }
  cells_.emplace_back(column, text);
  return *this;
}

Row& Row::set(std::string_view column, double x) {
  if (!std::isfinite(x)) return set(column, std::string_view{});
  char buffer[32];
  const auto end = std::to_chars(buffer, buffer + sizeof buffer, x);
  return set(column, std::string_view(buffer, end.ptr));
}

Row& Row::failed(std::string_view status, std::string_view reason) {
  return set("status", status).set("reason", reason);
}

bool Row::has(std::string_view column) const { return !text(column).empty(); }

std::string_view Row::text(std::string_view column) const {
  for (const Cell& cell : cells_) {
    if (cell.first == column) return cell.second;
  }
  return {};
}

double Row::number(std::string_view column) const {
  return decimal(text(column)).value_or(std::numeric_limits<double>::quiet_NaN());
}

std::string_view Row::status() const {
  const std::string_view status = text("status");
  return status.empty() ? "ok" : status;
}

std::string run_id(std::string_view experiment, const Row& identity) {
  std::vector<Row::Cell> cells(identity.cells().begin(), identity.cells().end());
  std::sort(cells.begin(), cells.end());
  Checksum hash;
  const auto add = [&hash](std::string_view text) {
    hash.add(text).add("\x1f");  // a separator no cell holds: ab|c is not a|bc
  };
  add(experiment);
  for (const auto& [column, text] : cells) {
    add(column);
    add(text);
  }
  add(std::to_string(schema_version));
  return hash.text();
}

std::string joined(const Row& row, std::initializer_list<std::string_view> columns) {
  std::string key;
  for (const std::string_view column : columns) key.append(row.text(column)).append("/");
  return key;
}

std::string describe(const Row& identity) {
  std::string text;
  for (const auto& [column, cell] : identity.cells()) {
    if (!text.empty()) text += ' ';
    text += fmt::format("{}={}", column, cell);
  }
  return text;
}

std::vector<std::string> header(std::span<const Column> columns) {
  std::vector<std::string> names;
  for (const Column& column : columns) names.emplace_back(column.name);
  for (const char* last : {"status", "reason", "run_id"}) names.emplace_back(last);
  return names;
}

std::vector<std::string> in_order(const Row& row, std::span<const std::string> header) {
  std::vector<std::string> line(header.size());
  for (const auto& [column, text] : row.cells()) {
    const auto place = std::find(header.begin(), header.end(), column);
    if (place == header.end()) {
      throw std::logic_error("the experiment set an undeclared column '" + column + "'");
    }
    line[static_cast<std::size_t>(place - header.begin())] = text;
  }
  return line;
}

}  // namespace tress::simulation
