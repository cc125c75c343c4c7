// What readers of grooms promise of any input, each case after a public report or an
// attack: work and memory in proportion to the file, numbers of any length, and nothing
// left unread.
#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <cmath>
#include <ctime>
#include <filesystem>

#include "contract/input_error.h"
#include "simulation/files/files.h"
#include "simulation/groom/place_groom.h"
#include "tests/support/refusal.h"

namespace tress::test_groom_readers {

using namespace simulation;
using testing::AllOf;
using testing::HasSubstr;
using testing_support::refusal;

class GroomReaders : public testing::Test {
 protected:
  GroomReaders() : stem_(testing::TempDir() + "readers_" + std::to_string(getpid())) {}
  ~GroomReaders() override {
    for (const std::string& name : names_) std::filesystem::remove(name);
  }
  const std::string& written(const std::string& ending, const std::string& bytes) {
    names_.push_back(stem_ + "." + ending);
    replace_file(names_.back(), bytes);
    return names_.back();
  }
  GroomFile read(const std::string& ending, const std::string& bytes,
                 const GroomReading& reading = {}) {
    return read_groom(written(ending, bytes), reading);
  }
  /// Processor time of a refusal, s, and what it says.
  std::pair<double, std::string> refused(const std::string& ending,
                                         const std::string& bytes) {
    const std::string& name = written(ending, bytes);
    const std::clock_t start = std::clock();
    std::string said = refusal([&] { read_groom(name); });
    return {static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC, std::move(said)};
  }

 private:
  std::string stem_;
  std::vector<std::string> names_;
};

std::string repeated(std::string_view text, int times) {
  std::string all;
  for (int i = 0; i < times; ++i) all += text;
  return all;
}

template <class T>
std::string bytes_of(std::initializer_list<T> numbers) {
  std::string bytes;
  for (const T x : numbers) bytes.append(reinterpret_cast<const char*>(&x), sizeof x);
  return bytes;
}

// --- work and memory in proportion to the file

/// 2 million paths after one another, once one level of the stack each.
TEST_F(GroomReaders, OfUsdDoNotRecurseOnPaths) {
  const auto [time, said] = refused("usda", "#usda 1.0\ndef Xform \"a\"\n{\nasset x = " +
                                                repeated("<>", 2'000'000) + "\n}\n");
  EXPECT_THAT(said, HasSubstr("'<' where '}' belongs"));
  EXPECT_LT(time, 2);
}

/// Every piece has the same 60 000 points: once, 2 s and 200 MB for a file of 0.8 MB.
TEST_F(GroomReaders, OfVtpDoNotReadABlockTwice) {
  std::string pieces;
  const std::string array =
      "<DataArray type=\"Float32\" Name=\"{}\" format=\"appended\" offset=\"0\"/>";
  for (int i = 0; i < 300; ++i) {
    pieces +=
        "<Piece NumberOfPoints=\"60000\" NumberOfLines=\"180000\"><Points>"
        "<DataArray type=\"Float32\" format=\"appended\" offset=\"0\"/></Points><Lines>"
        "<DataArray type=\"Int32\" Name=\"connectivity\" format=\"appended\" "
        "offset=\"0\"/><DataArray type=\"Int32\" Name=\"offsets\" format=\"appended\" "
        "offset=\"0\"/></Lines></Piece>";
  }
  const std::uint32_t size = 720'000;
  const std::string file =
      "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\"><PolyData>" + pieces +
      "</PolyData><AppendedData encoding=\"raw\">_" + bytes_of({size}) +
      std::string(size, '\0') + "</AppendedData></VTKFile>";
  const auto [time, said] = refused("vtp", file);
  EXPECT_THAT(said, HasSubstr("two share an offset"));
  EXPECT_LT(time, 1);
}

/// Items of elements without properties have no bytes: once, 1e12 of them were counted.
TEST_F(GroomReaders, OfPlySkipElementsWithoutProperties) {
  std::string head = "ply\nformat ascii 1.0\n";
  for (int i = 0; i < 1000; ++i) head += "element nothing 1000000000\n";
  head +=
      "element vertex 2\nproperty float x\nproperty float y\nproperty float z\n"
      "element strand 1\nproperty uchar nsegs\nend_header\n0 0 1\n0 0 0\n1\n";
  EXPECT_EQ(read("ply", head).lines.size(), 1u);
}

/// A file of 1 TB without contents (it occupies no disk), whose size bounds nothing.
TEST_F(GroomReaders, TakeMemoryForWhatAFileHasNotForItsSize) {
  for (const char* ending : {"data", "bin", "hair"}) {
    const std::string& name =
        written(ending, ending == std::string("hair")
                            ? "HAIR" + bytes_of<std::uint32_t>({1, 2, 3})
                            : bytes_of<std::int32_t>({1, 0}));
    std::error_code error;
    std::filesystem::resize_file(name, std::uint64_t{1} << 40, error);
    if (error) GTEST_SKIP() << "no sparse files here: " << error.message();
    EXPECT_THAT(refusal([&] { read_groom(name); }),
                testing::AnyOf(HasSubstr("are left after the last strand"),
                               HasSubstr("bytes where 1 strand ")));
  }
}

// --- numbers

/// Their middle is longer than any buffer of a number, once: what was beyond 60
/// characters became the next number.
TEST_F(GroomReaders, ReadNumbersOfAnyLength) {
  for (const int zeros : {10, 58, 59, 60, 72, 500, 300'000}) {
    const std::string long_tenth =
        "0.1" + std::string(static_cast<std::size_t>(zeros), '0');
    const GroomFile read_file =
        read("ply",
             "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
             "property float y\nproperty float z\nend_header\n" +
                 long_tenth + " 0 0\n0.1 0 -.1\n0.1 0 -.2\n",
             {.strand_points = 3});
    EXPECT_EQ(read_file.lines.points[0].x, 0.1);
    EXPECT_EQ(read_file.lines.points[0].z, 0);
    EXPECT_EQ(read_file.lines.points[2].z, -0.2);
  }
}

std::string linear(const std::string& points, int count, const std::string& top = "") {
  return fmt::format(
      "#usda 1.0\n(\nmetersPerUnit = 1\nupAxis = \"Z\"\n)\n{}def BasisCurves \"h\"\n{{\n"
      "uniform token type = \"linear\"\nint[] curveVertexCounts = [{}]\n"
      "point3f[] points = [{}]\n}}\n",
      top, count, points);
}

/// Below the least double there is 0, beyond the largest no place.
TEST_F(GroomReaders, ReadTinyNumbersAsZeroAndRefuseHugeOnes) {
  const GroomFile tiny = read("usda", linear("(0, 0, 1.7), (1e-320, -1e-400, 1.68)", 2));
  EXPECT_EQ(tiny.lines.points[1].x, 1e-320);
  EXPECT_EQ(tiny.lines.points[1].y, 0);
  EXPECT_EQ(place_groom(tiny, "f", {}).lines.size(), 1u);
  for (const char* huge : {"1e400", "-1e400", "inf", "nan", "-nan(ind)"}) {
    const std::string points = fmt::format("(0, 0, 1.7), ({}, 0, 1.68)", huge);
    EXPECT_THAT(
        refusal([&] { place_groom(read("usda", linear(points, 2)), "f.usda", {}); }),
        testing::AnyOf(AllOf(HasSubstr("strand 0 has point 1 that is not finite"),
                             HasSubstr("f.usda: line ")),
                       AllOf(HasSubstr("'('"), HasSubstr(".usda:10"))));
  }
}

// --- nothing is left unread

TEST_F(GroomReaders, RefuseWhatFollowsTheLastStrand) {
  const std::string head =
      "format ascii 1.0\nelement vertex 2\nproperty float x\nproperty float y\n"
      "property float z\nelement strand 1\nproperty uchar nsegs\nend_header\n";
  const std::string text = "ply\n" + head + "0 0 1\n0 0 0\n1\n \n";
  EXPECT_EQ(read("ply", text).lines.size(), 1u);
  EXPECT_THAT(refusal([&] { read("ply", text + "0 0 2\n"); }),
              AllOf(HasSubstr("left after the last element"), HasSubstr(".ply:14")));
  std::string binary = "ply\n" + head;
  binary.replace(binary.find("ascii"), 5, "binary_little_endian");
  binary += bytes_of<float>({0, 0, 1, 0, 0, 0}) + '\1';
  EXPECT_EQ(read("ply", binary).lines.size(), 1u);
  EXPECT_THAT(refusal([&] { read("ply", binary + '\2'); }),
              HasSubstr("1 bytes are left"));
  const std::string hair = "HAIR" + bytes_of<std::uint32_t>({1, 2, 2, 1}) +
                           std::string(108, '\0') + bytes_of<float>({0, 0, 1, 0, 0, 0});
  EXPECT_EQ(read("hair", hair).lines.size(), 1u);
  EXPECT_THAT(
      refusal([&] { read("hair", hair + '\0'); }),
      HasSubstr("153 bytes where 1 strand of 2 points with array bits 2 have 152"));
  std::string thick = hair;
  thick[12] = 6;  // thickness of every point, too
  EXPECT_THAT(refusal([&] { read("hair", thick); }), HasSubstr("have 160"));
  EXPECT_EQ(read("hair", thick + bytes_of<float>({1, 1})).lines.size(), 1u);
}

// --- formats

/// Counts, then all points, after a public report: no format says so, but the size does.
TEST_F(GroomReaders, ReadHairWithoutAHeader) {
  const std::string points =
      bytes_of<float>({0, 0, 3, 0, 0, 2, 0, 0, 1, 1, 0, 3, 1, 0, 2});
  const std::string of_points =
      bytes_of<std::uint32_t>({2, 5}) + bytes_of<std::uint16_t>({3, 2}) + points;
  const std::string of_segments =
      bytes_of<std::uint32_t>({2, 5}) + bytes_of<std::uint16_t>({2, 1}) + points;
  for (const std::string& bytes : {of_points, of_segments}) {
    const GroomFile two = read("hair", bytes);
    EXPECT_EQ(two.lines.ends, (std::vector<std::size_t>{3, 5}));
    EXPECT_EQ(two.lines.points[3].x, 1);
    EXPECT_THAT(two.notes.at(0), HasSubstr("no header"));
    EXPECT_THAT(refusal([&] { read("hair", bytes + '\0'); }), HasSubstr(".data"));
  }
  const std::string neither =
      bytes_of<std::uint32_t>({2, 5}) + bytes_of<std::uint16_t>({3, 3}) + points;
  EXPECT_THAT(refusal([&] { read("hair", neither); }), HasSubstr("its size confirms"));
}

// --- units, axes, lengths

GroomFile radial(double bend) {
  GroomFile fur;
  for (int i = 0; i < 24; ++i) {
    const double a = 0.26 * i, up = 0.4 + 0.02 * i, out = std::sqrt(1 - up * up);
    const Vec n{out * std::cos(a), up, out * std::sin(a)};  // of the upper half of a head
    for (int k = 0; k < 5; ++k) {
      const double s = 0.75 * k;
      fur.lines.points.push_back((9 + s) * n - Vec{0, bend * s * s, 0});
    }
    fur.lines.end_strand(static_cast<std::size_t>(i), 0);
  }
  return fur;
}

/// Straight hair that stands looks like hair that hangs from below: the axis is asked
/// for. Hair that bends towards the ground as it hangs shows its axis; hair that stands
/// and droops does not. 3 units of length are 3 cm, not 3 inches.
TEST_F(GroomReaders, AskWhichWayIsUpWhereHairStands) {
  GroomPlacing up;
  up.up = FileAxis{1, false};
  EXPECT_THAT(place_groom(radial(0), "f", up).notes.at(0), HasSubstr("guessed: cm"));
  for (const double droop : {0.0, 0.02}) {
    EXPECT_THAT(refusal([&] { place_groom(radial(droop), "f.hair", {}); }),
                AllOf(HasSubstr("f.hair"), HasSubstr("up = \"-y\" if they hang"),
                      HasSubstr("up = \"y\" if they stand")));
  }
  EXPECT_THAT(place_groom(radial(0.6), "f", {}).notes,
              testing::Contains(HasSubstr("guessed: y")));
}

/// A vertex that an exporter leaves at the origin makes every strand twenty times as
/// long.
TEST_F(GroomReaders, PointAtLengthsThatStandOut) {
  GroomFile read;
  read.metres = 1;
  read.up = FileAxis{2, false};
  for (int k = 0; k < 20; ++k) {
    for (int i = 0; i < 5; ++i) {
      read.lines.points.push_back({0.01 * k, 0, 1.7 - (0.02 + 0.001 * k) * i});
    }
    if (k == 7) read.lines.points.push_back({0, 0, 0});
    read.lines.end_strand(static_cast<std::size_t>(k), 0);
  }
  const std::vector<std::string> notes = place_groom(read, "f", {}).notes;
  ASSERT_EQ(notes.size(), 3u);
  // The lengths are 0.08 to 0.156 m but for one.
  EXPECT_EQ(
      notes[0],
      "lengths: median 0.12 m, half of the strands 0.096 m to 0.14 m, all 0.08 m to "
      "1.7 m");
  EXPECT_THAT(notes[1], HasSubstr("1 of 20 strands are longer than 4 times the median"));
  EXPECT_THAT(notes[1], HasSubstr("strand 7: 1.7 m"));
  EXPECT_THAT(notes[2], AllOf(HasSubstr("in 1 of 20 strands one piece"),
                              HasSubstr("strand 7 from point 4 to 5: 1.59 m of 1.7 m")));
}

TEST_F(GroomReaders, LengthsThatAreEqualAreToldOnce) {
  GroomFile read;
  read.metres = 1;
  read.up = FileAxis{2, false};
  for (int k = 0; k < 3; ++k) {
    for (int i = 0; i < 3; ++i) read.lines.points.push_back({0.01 * k, 0, -0.05 * i});
    read.lines.end_strand(static_cast<std::size_t>(k), 0);
  }
  EXPECT_EQ(place_groom(read, "f", {}).notes.front(), "lengths: 0.1 m each");
}

}  // namespace tress::test_groom_readers
