#pragma once

namespace tress::models {

/// Model whose strands a Block steps (models/head/lane_block.h). A Model has
///
///     Real                                  // PackOf
///     Strand, Element                       // Real only: what is known of them
///     Clamp, Scratch(Model)
///     elements(), unknowns()                // of a strand
///     describe(strand, centre, units, lane, Strand&, Element*, q, v)
///     clamp(Strand, RootPose)
///     renew(Element*, Clamp, q, v)          // reference frames, before a step; > 0 in
///                                           // lanes with new ones, whose accelerations
///                                           // before mean nothing then
///     predict(Strand, RootPose, RootPose, h, q, v, q_bar)   // q + h v
///     newton(Strand, Element*, Clamp, Weights, q, v, a, correction, Scratch&)
///     resolved(Strand, Weights, lane)       // size of corrections that are rounding
///     positions(Strand, Frame, q, use(i, Vec3<Real>))
///     velocities(Strand, RootPose, q, v, use(i, Vec3<Real>))
///     energies(Strand, Element*, RootPose, q, v)   // LaneEnergies
///     mass(Strand, lane)
///     newton_part                           // Block::newton_part()
///     coordinate_size(Strand, dq)           // over those of System::scale
///     use_others                            // remedy for effects that it has not
///     iterates                              // whether its Jacobian is exact, and it has
///     again(as newton)                      // with the matrix of the last newton()
///     takes_stresses                        // whether it has
///     take_stresses(Strand, Element*, q, which, Scratch&)
///                                           // from where the next newton() has the
///                                           // stresses of its terms of second order, in
///                                           // lanes where which > 0; later ones have
///                                           // those that corrections find (StressForm)
///     straight                              // whether elements are
///     element_length(Strand)
///     takes_bodies                          // whether it has these, too:
///     root_at(Strand, Frame), length(Strand)   // from the head's position; of strands
///     most_stretched                        // their length over that
///     find_loads(Strand, bodies, RootPose, HeadUnits, h, q, v, Scratch&)
///                                           // for newton() and again() at these states;
///                                           // bodies outlive them
///
/// and an Element has keep(lane, double*), recall(lane, const double*): `kept` numbers.
///
///     unit(HeadUnits, k)                    // of unknown k
///
/// All numbers are without units; poses are multiples of HeadUnits.
template <class Model>
concept LaneModel = requires {
  typename Model::Real;
  typename Model::Strand;
  typename Model::Element;
  typename Model::Clamp;
  typename Model::Scratch;
  Model::iterates || Model::takes_bodies || Model::straight;
};

}  // namespace tress::models
