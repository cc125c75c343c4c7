#include "experiments/run/merge.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>

#include "contract/input_error.h"
#include "contract/renamed.h"
#include "experiments/run/manifest.h"
#include "simulation/files/build_facts.h"
#include "simulation/files/files.h"
#include "simulation/files/parse.h"

namespace tress::experiments {
namespace {

/// What the manifest of a part's table says.
struct Part {
  std::string file;  // the table
  int index, count;
  std::string commit, build, settings;
};

/// Nothing for a whole table, or one without a manifest.
std::optional<Part> part_of(const std::string& file) {
  const auto manifest = manifest_of(file);
  if (!manifest) return {};
  const std::string meta = beside(file, ".meta.json");
  try {
    const auto [index, count] =
        parse_shard(manifest->at("shard").get<std::string>(), meta);
    if (count == 1) return {};
    const auto& git = manifest->at("git");
    const auto& build = manifest->at("build");
    const auto text = [](const nlohmann::json& of, const char* key) {
      return of.at(key).get<std::string>();
    };
    std::string commit = text(git, "commit");
    if (git.value("dirty", false)) commit += " with changes " + git.value("changes", "");
    return Part{file,
                index,
                count,
                commit,
                text(build, "type") + ", " + text(build, "compiler") + ", " +
                    text(build, "flags"),
                text(*manifest, "settings")};
  } catch (const nlohmann::json::exception&) {
    throw InputError("not a manifest of tress", meta,
                     "write the part again, or move the file away");
  }
}

void refuse_if(bool bad, const std::string& problem, const Part& part,
               const std::string& remedy) {
  if (bad) throw InputError(problem, beside(part.file, ".meta.json"), remedy);
}

/// All parts of one sweep in their order; empty if the tables are no parts.
std::vector<Part> parts_of(std::span<const std::string> files,
                           std::string_view settings) {
  std::vector<Part> parts;
  for (const std::string& file : files) {
    if (auto part = part_of(file)) parts.push_back(std::move(*part));
  }
  if (parts.empty()) return parts;
  std::ranges::sort(parts, {}, &Part::index);
  const Part& first = parts.front();
  refuse_if(parts.size() < files.size(),
            "some tables are parts of a sweep and others are not", first,
            "merge its parts first");
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Part& part = parts[i];
    refuse_if(part.count != first.count,
              fmt::format("part {}/{} cannot be merged with part {}/{}", part.index,
                          part.count, first.index, first.count),
              part, "give all parts of one sweep");
    refuse_if(part.commit != first.commit,
              fmt::format("made by commit {}, part {} by {}", part.commit, first.index,
                          first.commit),
              part, "run one of them again");
    refuse_if(part.commit != build_facts().code(),
              fmt::format("made by commit {}, and this program is of {}", part.commit,
                          build_facts().code()),
              part, "merge by the program that made the parts");
    refuse_if(part.build != first.build,
              fmt::format("made by a build with {}, part {} by one with {}", part.build,
                          first.index, first.build),
              part, "run one of them again");
    refuse_if(
        part.settings != settings,
        fmt::format("made with the options '{}', not '{}'", part.settings, settings),
        part, "give --merge the options of its parts");
    refuse_if(i > 0 && part.index == parts[i - 1].index,
              fmt::format("part {} is given twice", part.index), part, "give it once");
    refuse_if(part.index != static_cast<int>(i) + 1,
              fmt::format("part {}/{} is missing", i + 1, part.count), part,
              "run it with --resume, then merge again");
  }
  const Part& last = parts.back();
  refuse_if(last.index != last.count,
            fmt::format("part {}/{} is missing", last.index + 1, last.count), last,
            "run it with --resume, then merge again");
  return parts;
}

/// Rows of the same case follow each other: run_id, run_id.001, ...
std::string_view case_of(const Row& row) {
  const std::string_view id = row.text("run_id");
  return id.substr(0, id.find('.'));
}

/// Case k of all is in part k modulo the number of parts.
std::vector<Row> dealt(std::vector<std::vector<Row>> of_parts) {
  std::vector<Row> all;
  std::vector<std::size_t> next(of_parts.size());
  for (bool any = true; any;) {
    any = false;
    for (std::size_t p = 0; p < of_parts.size(); ++p) {
      std::vector<Row>& rows = of_parts[p];
      std::size_t& k = next[p];
      if (k == rows.size()) continue;
      any = true;
      const std::string id(case_of(rows[k]));
      for (; k < rows.size() && case_of(rows[k]) == id; ++k) {
        all.push_back(std::move(rows[k]));
      }
    }
  }
  return all;
}

/// Name of the first column, except timings, in which the rows differ; empty if none.
std::string_view difference(const Row& a, const Row& b, std::span<const Column> columns) {
  for (const Column& column : columns) {
    if (!column.timing && a.text(column.name) != b.text(column.name)) return column.name;
  }
  return a.status() == b.status() ? std::string_view{} : "status";
}

}  // namespace

void check_header(const CsvTable& table, std::span<const Column> columns,
                  const std::string& file) {
  const std::vector<std::string> expected = header(columns);
  if (table.header == expected) return;
  std::string first = "fewer columns";
  std::string remedy = "give a table of this experiment and version";
  for (std::size_t i = 0; i < table.header.size(); ++i) {
    if (i >= expected.size() || table.header[i] != expected[i]) {
      first = fmt::format("column {} is '{}'", i + 1, table.header[i]);
      if (i < expected.size() && renamed(table.header[i], expected[i])) {
        remedy =
            fmt::format("it is called '{}' now: ./tress rename {} converts the table",
                        expected[i], file);
      }
      break;
    }
  }
  throw InputError("the table has other columns than this experiment writes: " + first,
                   file + ":1", remedy);
}

Merged merge(std::span<const std::string> files, std::span<const Column> columns,
             std::string_view settings) {
  const auto read = [&](const std::string& file) {
    CsvTable table = read_csv(file);
    check_header(table, columns, file);
    return std::move(table.rows);
  };
  Merged merged;
  const std::vector<Part> parts = parts_of(files, settings);
  if (!parts.empty()) {
    std::vector<std::vector<Row>> rows;
    rows.reserve(parts.size());
    for (const Part& part : parts) rows.push_back(read(part.file));
    merged.rows = dealt(std::move(rows));
    return merged;
  }
  std::map<std::string, std::size_t, std::less<>> place;
  for (const std::string& file : files) {
    for (const Row& row : read(file)) {
      const std::string id(row.text("run_id"));
      const auto [found, fresh] = place.emplace(id, merged.rows.size());
      if (fresh) {
        merged.rows.push_back(row);
        continue;
      }
      Row& kept = merged.rows[found->second];
      if (!kept.ok() && row.ok()) {
        kept = row;
      } else if (kept.ok() && row.ok()) {
        const std::string_view column = difference(kept, row, columns);
        if (column.empty()) continue;
        merged.conflicts.push_back(
            fmt::format("run_id {}: {} is '{}' and in {} '{}'; the first is kept", id,
                        column, kept.text(column), file, row.text(column)));
      }
    }
  }
  return merged;
}

}  // namespace tress::experiments
