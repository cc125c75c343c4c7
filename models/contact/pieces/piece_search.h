#pragma once

#include <array>
#include <cstddef>
#include <functional>
#include <span>
#include <vector>

#include "contract/basics.h"
#include "models/contact/box_pairs.h"
#include "models/contact/pieces/piece_approach.h"
#include "models/contact/pieces/piece_touch.h"

namespace tress::models {

/// Search for straight pieces of many polylines ("strands") that touch or would pass
/// through each other while their points move uniformly during a step. Pairs that may
/// touch are gathered once per step, with a margin for the motion due to contact forces.
/// Pairs are examined again where these forces may bring them into contact.
///
/// Use: begin(), then find(), and place() and find() again while forces are computed.
class PieceSearch {
 public:
  /// Data of a strand that searches need.
  struct Strand {
    int points;      // >= 2
    double radius;   // m
    double longest;  // of its pieces at rest, m
  };
  /// Two pieces, the first before the second, and where they touch.
  struct Found {
    int first, second;  // numbers of the pieces
    PieceTouch at;      // places on both pieces
  };
  /// thickness: distance of axes that touch, m; 0: the sum of radii. own: parts of one
  /// strand touch each other too.
  PieceSearch(std::span<const Strand> strands, double thickness, bool own);

  /// A step from points `from` to `to`, 3 numbers each, strand after strand.
  void begin(In from, In to);
  /// Sets the positions of a strand's points at the end of the step, changed by forces.
  void place(std::size_t strand, In x);
  /// Pairs that touch, in order. wider(first, second): whether a pair counts when it is
  /// up to half its thickness apart (called at once from several threads).
  const std::vector<Found>& find(const Loop& loop,
                                 const std::function<bool(int, int)>& wider);

  /// Returns the number of pieces of all strands.
  std::size_t pieces() const { return strand_.size(); }
  /// Returns the strand of a piece.
  std::size_t strand_of(int piece) const {
    return strand_[static_cast<std::size_t>(piece)];
  }
  /// Returns the number of a strand's first point.
  std::size_t first_point(std::size_t strand) const { return first_[strand]; }
  /// Number of points of a strand.
  std::size_t points(std::size_t strand) const {
    return first_[strand + 1] - first_[strand];
  }
  /// Returns the number of a strand's piece.
  int piece_of(std::size_t strand, std::size_t segment) const {
    return static_cast<int>(first_[strand] - strand + segment);
  }
  /// Points at the start of the step, at its end without forces, and with them.
  In from() const { return from_; }
  /// Returns the points at the end of the step without forces.
  In to() const { return to_; }
  /// Returns the points at the end of the step with the forces.
  In now() const { return now_; }
  /// Returns whether forces have moved a strand since the last find().
  bool moved(std::size_t strand) const { return moved_[strand] != 0; }
  /// The first of the two points of a piece, among all points.
  std::size_t point_of(int piece) const {
    return static_cast<std::size_t>(piece) + strand_of(piece);
  }
  /// The two points of either piece, among all points.
  std::array<std::size_t, 4> ends(int first, int second) const;
  /// Distance of the axes of two pieces that touch, m.
  double thickness(int first, int second) const;
  /// Returns the distance of two pieces along the normal, less their thickness, m.
  double gap(const Found& pair, In x) const;
  /// Returns the gap at the start of the step, m.
  double gap_before(const Found& pair) const { return gap(pair, from_); }
  /// Returns the gap at the end of the step, with the forces, m.
  double gap_now(const Found& pair) const { return gap(pair, now_); }
  /// Returns the overlap of two touching pieces at the end of the step, with the forces,
  /// m. It exceeds their thickness if they have passed through each other.
  double depth(const Found& pair) const;
  /// Returns the arc length of a point on a piece along its strand at the start of the
  /// step, m.
  double arc(int piece, double part) const;

 private:
  MovingPieces moving(int first, int second) const;
  void gather_piece(std::size_t piece);
  void gather(const Loop& loop);
  void gather_moved(const Loop& loop);
  void sift(std::vector<BoxPairs::Pair>& pairs) const;
  bool look(const BoxPairs::Pair& pair, const std::function<bool(int, int)>& wider,
            Found& found) const;

  bool own_;
  double thickness_;
  double widest_ = 0;                // of thicknesses, m
  std::vector<double> radius_;       // of strands, m
  std::vector<std::size_t> first_;   // points of strands, and the number of all
  std::vector<std::size_t> strand_;  // of pieces
  std::vector<double> from_, to_, now_;
  std::vector<double> arc_;  // of points, m
  // Of pieces when their pairs were gathered: ends after the step, motion during it, and
  // what it sweeps, with room.
  struct Gathered {
    std::array<Vec, 2> ends;
    double moved = 0;  // how far an end has been moved since, m
  };
  std::vector<Gathered> gathered_;  // empty: not gathered in this step
  std::vector<PieceMotion> motion_;
  std::vector<Box> roomy_;
  BoxPairs broad_;
  std::vector<BoxPairs::Pair> near_;  // may touch while ends are moved up to room_
  double room_;                       // m
  std::vector<double> looked_;        // points when pairs were looked at last, m
  std::vector<char> moved_;           // strands since then
  std::vector<std::vector<Found>> found_of_;  // groups of pairs
  std::vector<Found> found_;
};

}  // namespace tress::models
