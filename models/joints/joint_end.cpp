#include "models/joints/joint_end.h"

#include <algorithm>

#include "contract/input_error.h"
#include "models/supports/point_force.h"

namespace tress::models {
namespace {

template <class Form>
Form& known(Form* form, const char* what, const std::string& where) {
  refuse_if(form == nullptr, what, where, "use another model");
  return *form;
}

}  // namespace

JointEnd::JointEnd(System& strand, std::size_t first, int point, const std::string& where)
    : strand_(strand),
      points_(known(strand.material_points(), "the model has no material points", where)),
      accelerations_(known(point_accelerations(strand),
                           "the model does not compute the accelerations of its points",
                           where)),
      sections_(sections(strand)),
      first_(first),
      size_(static_cast<std::size_t>(strand.layout().coordinates)),
      point_(point) {
  refuse_if(point < 0 || point >= points_.count(), "no point " + std::to_string(point),
            where, "give a point of 0 to " + std::to_string(points_.count() - 1));
  x_.resize(3 * static_cast<std::size_t>(points_.count()));
  std::vector<double> q(size_), v(size_), column(size_);
  strand.initial_state(q, v);
  refuse_if(!add_point_force(points_, 0, q, point, {1, 1, 1}, column),
            "the model cannot hold a point of a strand with branches", where,
            "join strands without branches");
}

void JointEnd::hold_section(const std::string& where) {
  const Sections::Kind kind = section_to_hold(strand_, point_, where);
  refuse_if(kind.turning != Sections::Turning::frame,
            "a weld or hinge needs a frame of the section, which the model lacks", where,
            "use kind = \"ball\", or a model with twist, such as der or, with modes = "
            "\"bend_twist\", super_helix");
  section_.emplace(strand_, point_, RootMotion{}, true, Vec{}, strand_.sparse_form(),
                   where);
}

Vec JointEnd::place(double t, In q) {
  points_.positions(t, part(q), x_);
  return load3(&x_[3 * static_cast<std::size_t>(point_)]);
}

Vec JointEnd::velocity(double t, In q, In v) {
  points_.velocities(t, part(q), part(v), x_);
  return load3(&x_[3 * static_cast<std::size_t>(point_)]);
}

Vec JointEnd::acceleration(double t, In q, In v, In a) {
  accelerations_.accelerations(t, part(q), part(v), part(a), x_);
  return load3(&x_[3 * static_cast<std::size_t>(point_)]);
}

void JointEnd::add_force(double t, In q, const Vec& force, InOut b) {
  static_cast<void>(add_point_force(points_, t, part(q), point_, force, part(b)));
}

void JointEnd::add_curvature(double t, In q, const Vec& moment, double factor, InOut s) {
  if (!section_) return;
  section_->add_derivative(
      t, part(q), true, factor,
      [&](In x, InOut b) { sections_->add_moment(t, x, point_, moment, b); }, s);
}

}  // namespace tress::models
