#pragma once

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace tress::testing_support {

/// Columns of numbers of a table by their names; empty cells are NaN.
using Columns = std::map<std::string, std::vector<double>>;
/// Reads a CSV file. A missing file has no columns.
Columns columns(const std::string& file);

/// Largest differences of two runs of a scene, each relative to a size of the motion.
struct Apart {
  double energy = 0;  // over the largest energy
  double place = 0;   // of further columns, such as the mean tip, over the largest one
  double points = 0;  // of all strands, over their extent; NaN: not compared
  /// First column or file that must be equal and is not; empty: none.
  std::string unequal;

  double most() const {
    const double seen = std::max(energy, place);
    return points > seen ? points : seen;
  }
};

/// Compares the columns that both tables have, in their first `rows` rows. Times and
/// numbers of failed strands must be equal. Energies of a batch under `gravity` include
/// all uniform loads.
Apart apart(const Columns& batch, const Columns& strands, std::size_t rows);

/// Largest difference of the points of two .usda files, over the extent of the strands.
/// Frames with the same number of points are compared; NaN where there is none. Infinite
/// where the files have different numbers of frames.
double points_apart(const std::string& batch, const std::string& strands);

/// A strand that failed, as a program prints it.
struct Failure {
  long strand = -1;
  double t = 0;      // s
  std::string kind;  // what was found, in the words of neither program

  bool some() const { return strand >= 0; }
};
/// The failure of a message that ends "... at t = 1 s, strand 2...".
Failure failure_in(const std::string& message);
/// All failures of a batch's .failed.csv.
std::vector<Failure> failures_of(const std::string& file);
/// What differs, in words: a strand of `strands` is not among those of the batch, or
/// fails for another reason or at another time. Empty: nothing. `late`: time by which a
/// batch may find it at another step (s); it may then find another bound that is broken.
std::string different_failures(const std::vector<Failure>& batch,
                               const std::vector<Failure>& strands, double late);

}  // namespace tress::testing_support
