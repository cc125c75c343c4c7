#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "contract/layers.h"

namespace tress::experiments::calibrate {

/// Quantity that a record contains.
///
///     displacement  of the tip from the root along one axis, up to a constant that is
///                   the same throughout the record
///     envelope      half the difference of two successive turning points of it, at the
///                   time midway between them
enum class Observed { displacement, envelope };

/// One measured oscillation, from t = 0 when the strand is released or its root starts to
/// move.
struct Record {
  struct Setting {
    std::string key, value;
    std::string where;  // file:line:column
  };
  std::vector<double> t;           // s, >= 0, ascending
  std::vector<double> value;       // m; of an envelope > 0
  std::vector<double> sigma;       // m, > 0, standard errors; empty: all equal
  std::vector<Setting> of_strand;  // parameters of the measured strand
  std::string end;                 // file:line:column of the last time
};

/// The records of one file.
struct Records {
  std::vector<Record> all;
  std::string hash;  // of the file's text, 16 hexadecimal digits

  std::size_t points() const;
};

/// Reads a CSV with the columns t_s, amplitude_m and, where known, sigma_m. Every other
/// column is a parameter of strand models (length_m, say). A change of any of these, or
/// of the column `record` (a free label), begins another record. Throws InputError with
/// file:line:column on another header, non-finite numbers, and times that do not ascend
/// or are negative. Also throws on sigma_m or an envelope that are not positive, and on
/// records of fewer than 5 points.
Records read_records(const std::string& file, Observed observed);
/// Reads records from a text; `file` is its name in messages.
Records parse_records(std::string_view text, const std::string& file, Observed observed);

}  // namespace tress::experiments::calibrate
