#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

#include "contract/layers.h"

namespace tress::experiments::calibrate {

/// What the amplitudes of a record are.
///
///     displacement  of the tip from the root along one axis, up to a constant that is
///                   the same all through the record
///     envelope      half the difference of two successive turning points of it, at the
///                   time midway between them
enum class Observed { displacement, envelope };

/// One measured oscillation, from t = 0 when the strand is let go or its root sets off.
struct Record {
  struct Setting {
    std::string key, value;
    std::string where;  // file:line:column
  };
  std::vector<double> t;           // s, >= 0, ascending
  std::vector<double> value;       // m; of an envelope > 0
  std::vector<double> sigma;       // m, > 0, standard errors; or empty: all the same
  std::vector<Setting> of_strand;  // parameters of the strand that was measured
};

/// The records that one file holds.
struct Records {
  std::vector<Record> all;
  std::string hash;  // of the file's text, 16 hexadecimal digits

  std::size_t points() const;
};

/// CSV with the columns t_s, amplitude_m and, where they are known, sigma_m. Every other
/// column is named as a parameter of strand models (length_m, say); a change of any of
/// these, or of the column `record` (a free label), begins another record. Throws
/// InputError with file:line:column on another header, what is not a finite number, times
/// that do not ascend or are negative, sigma_m or an envelope that are not positive, and
/// records of fewer than 5 points.
Records read_records(const std::string& file, Observed observed);
/// The same of a text; `file` is its name in messages.
Records parse_records(std::string_view text, const std::string& file, Observed observed);

}  // namespace tress::experiments::calibrate
