#include "simulation/scene/root_table.h"

#include <vector>

#include "contract/input_error.h"
#include "models/mesh/read_mesh.h"
#include "models/motion/signals.h"
#include "simulation/table/directions.h"

namespace tress::simulation {
namespace {

constexpr double largest_number = 1e6;

constexpr Parameter parameters[] = {
    {.name = "motion",
     .help = "motion of all roots",
     .choices = "fixed|shake|rotate|shake_rotate|swing|stop|drop_pull|translate|"
                "keyframes|poses|head|free|skin"},
    {.name = "direction",
     .help = "direction of shake, swing, stop, drop_pull and translate; any length",
     .min = -largest_number,
     .max = largest_number,
     .components = 3,
     .fallback = "0,1,0"},
    {.name = "axis",
     .help =
         "direction of the axis of rotate, shake_rotate, keyframes and head; any length",
     .min = -largest_number,
     .max = largest_number,
     .components = 3,
     .fallback = "0,0,1"},
    {.name = "centre_m",
     .help = "a point on this axis x, y, z (m)",
     .min = -largest_number,
     .max = largest_number,
     .components = 3,
     .fallback = "0,0,0"},
    {.name = "amplitude_m",
     .help = "amplitude a (m). `shake` moves by a sin(2 pi f t), `swing` by a "
             "(1 - cos(2 pi f t)). `drop_pull` moves by a in half a period and "
             "back in the next",
     .number = 0.05,
     .min = -largest_number,
     .max = largest_number},
    {.name = "angle_rad",
     .help = "rotate: amplitude of the angle sin(2 pi f t) (rad)",
     .number = 0.5,
     .min = -1e3,
     .max = 1e3},
    {.name = "frequency_hz",
     .help = "frequency f; head: frequency of the torque (Hz)",
     .number = 1,
     .min = 1e-6,
     .max = largest_number},
    {.name = "speed_m_s",
     .help = "stop: speed until t = 0 (m/s)",
     .number = 2,
     .min = -largest_number,
     .max = largest_number},
    {.name = "distance_m",
     .help = "translate: distance, from rest to rest (m)",
     .number = 0.1,
     .min = -largest_number,
     .max = largest_number},
    {.name = "time_s",
     .help = "stop, translate: duration from t = 0 on (s)",
     .number = 0.5,
     .min = 1e-9,
     .max = largest_number},
    {.name = "keyframes",
     .help =
         "rows of t, x, y, z, angle (s, m, rad) relative to the place at rest, t "
         "ascending. Each column follows a cubic spline through its rows, with "
         "continuous acceleration. The root is at rest before the first row and after "
         "the last. It does not stop at the rows in between. Two rows with the same time "
         "are a teleport: the root jumps and carries the strand with it",
     .min = -largest_number,
     .max = largest_number,
     .components = 5,
     .rows = true,
     .fallback = "0,0,0,0,0;1,0,0,0.1,0"},
    {.name = "poses",
     .help =
         "rows of t, x, y, z and three angles (s, m, rad), as keyframes. The head "
         "turns about x, then y, then z, which are axes of the world through centre_m",
     .min = -largest_number,
     .max = largest_number,
     .components = 7,
     .rows = true,
     .fallback = "0,0,0,0,0,0,0;1,0,0,0.1,0,0,0"},
    {.name = "skin_files",
     .help = "skin: OBJ, PLY or STL files of one deforming surface, with the same faces. "
             "Each root keeps its place and direction relative to the triangle of the "
             "first file that is nearest to it",
     .rows = true,
     .text = true},
    {.name = "skin_times_s",
     .help = "skin: time of each file, ascending (s). Places and angles follow cubic "
             "splines through them, at rest before the first and after the last. Two "
             "files with the same time are a teleport, as with keyframes",
     .min = -largest_number,
     .max = largest_number,
     .rows = true},
    {.name = "skin_scale",
     .help = "skin: metres per unit of the files",
     .number = 1,
     .min = 1e-9,
     .max = 1e9},
    {.name = "torque_n_m",
     .help = "head: amplitude of the torque about the axis (N m)",
     .number = 0.5,
     .min = -largest_number,
     .max = largest_number},
    {.name = "periods",
     .help = "head: number of periods of the torque, 0: unlimited",
     .number = 0,
     .min = 0,
     .max = largest_number,
     .whole = true},
    {.name = "inertia_kg_m2",
     .help = "head: moment of inertia about the axis (kg m^2)",
     .number = 0.02,
     .min = 1e-12,
     .max = 1e12},
    {.name = "damping_n_m_s",
     .help = "head: torque against the angular velocity (N m s)",
     .number = 0.1,
     .min = 0,
     .max = 1e12},
    {.name = "stiffness_n_m",
     .help = "head: torque of the neck against the angle (N m)",
     .number = 2,
     .min = 0,
     .max = 1e12},
    {.name = "velocity_m_s",
     .help = "free: initial velocity x, y, z (m/s)",
     .min = -largest_number,
     .max = largest_number,
     .components = 3,
     .fallback = "0,0,0"},
    {.name = "spin_rad_s",
     .help = "free: initial angular velocity x, y, z (rad/s)",
     .min = -largest_number,
     .max = largest_number,
     .components = 3,
     .fallback = "0,0,0"},
};

constexpr Use uses[] = {
    {"shake", "direction|amplitude_m|frequency_hz"},
    {"rotate", "axis|centre_m|angle_rad|frequency_hz"},
    {"shake_rotate", "direction|amplitude_m|axis|centre_m|angle_rad|frequency_hz"},
    {"swing", "direction|amplitude_m|frequency_hz"},
    {"stop", "direction|speed_m_s|time_s"},
    {"drop_pull", "direction|amplitude_m|frequency_hz"},
    {"translate", "direction|distance_m|time_s"},
    {"keyframes", "axis|centre_m|keyframes"},
    {"poses", "centre_m|poses"},
    {"head",
     "axis|centre_m|torque_n_m|frequency_hz|periods|inertia_kg_m2|"
     "damping_n_m_s|stiffness_n_m"},
    {"free", "velocity_m_s|spin_rad_s"},
    {"skin", "skin_files|skin_times_s|skin_scale"},
};

Oscillator oscillator(const Parameters& p) {
  return {.inertia = p.number("inertia_kg_m2"),
          .damping = p.number("damping_n_m_s"),
          .stiffness = p.number("stiffness_n_m"),
          .force = p.number("torque_n_m"),
          .frequency = p.number("frequency_hz")};
}

/// The angle due to the torque, with the opposite torque added after its last period.
Signal head_angle(const Parameters& p) {
  Oscillator body = oscillator(p);
  Signal angle = driven_oscillator(body, 0);
  const double periods = p.number("periods");
  if (periods == 0) return angle;
  body.force = -body.force;
  return sum(std::move(angle), driven_oscillator(body, periods / body.frequency));
}

void add_parts(RootMotion& motion, const Parameters& p, Vec along, Vec axis) {
  const std::string_view word = p.word("motion");
  const double amplitude = p.number("amplitude_m"), frequency = p.number("frequency_hz");
  const auto translate = [&](Signal s) {
    motion.translations.push_back({along, std::move(s)});
  };
  const auto rotate = [&](Signal s) { motion.rotations.push_back({axis, std::move(s)}); };
  if (word == "shake" || word == "shake_rotate") translate(sine(amplitude, frequency));
  if (word == "rotate" || word == "shake_rotate") {
    rotate(sine(p.number("angle_rad"), frequency));
  }
  if (word == "swing") translate(one_minus_cosine(amplitude, frequency));
  if (word == "stop") translate(stop(p.number("speed_m_s"), 0, p.number("time_s")));
  if (word == "drop_pull") translate(there_and_back(amplitude, 1 / (2 * frequency)));
  if (word == "translate") {
    translate(smooth_step(p.number("distance_m"), 0, p.number("time_s")));
  }
  if (word == "keyframes") {
    motion = keyframe_motion(p.numbers("keyframes"), {&axis, 1}, motion.centre.value());
  }
  if (word == "poses") {
    motion = keyframe_motion(p.numbers("poses"), world_axes, motion.centre.value());
  }
  if (word == "head") rotate(head_angle(p));
}

}  // namespace

std::span<const Parameter> root_table_parameters() { return parameters; }
std::span<const Use> root_uses() { return uses; }

RootMotion head_motion(const Table& root) {
  root.refuse_unused("motion", uses);
  RootMotion motion;
  motion.centre = root.values().vec("centre_m");
  const std::string_view word = root.values().word("motion");
  const Vec along = direction(root, "direction"), axis = direction(root, "axis");
  try {
    add_parts(motion, root.values(), along, axis);
  } catch (const InputError& error) {
    // A signal knows its numbers but not their location in the file.
    if (word != "keyframes" && word != "poses" && word != "head") throw;
    throw InputError(error.what(), root.place(word == "head" ? "frequency_hz" : word),
                     "change the keys of [root]");
  }
  return motion;
}

std::shared_ptr<const Skin> skin_of(const Table& root) {
  const Parameters& p = root.values();
  if (p.word("motion") != "skin") return {};
  const std::string place = root.place("skin_files");
  refuse_if(p.text("skin_files").empty(), "no skin_files", place,
            "name one mesh file for each time of skin_times_s");
  std::vector<models::TriangleMesh> frames;
  for (const std::string& file : names_of(p.text("skin_files"))) {
    frames.push_back(models::read_mesh(file, p.number("skin_scale")));
  }
  const std::span<const double> times = p.numbers("skin_times_s");
  return std::make_shared<const Skin>(
      std::move(frames), std::vector<double>(times.begin(), times.end()), place);
}

std::optional<FreeRoot> free_motion(const Table& root) {
  if (root.values().word("motion") != "free") return std::nullopt;
  FreeRoot free_root;
  free_root.velocity = root.values().vec("velocity_m_s");
  free_root.spin = root.values().vec("spin_rad_s");
  return free_root;
}

void set_root(Strand& strand, const RootMotions& motions, Vec position,
              const Frame& frame) {
  const Frame placed = frame;  // which may be that of the strand, replaced below
  strand.root =
      motions.skin != nullptr ? motions.skin->motion(position, placed) : motions.head;
  strand.root.position = position;
  strand.root.frame = placed;
  strand.free_root = motions.free_root;
  if (strand.free_root) {
    strand.free_root->position = position;
    strand.free_root->frame = placed;
    if (!motions.begins_with_head) return;
    const models::RootPose pose = strand.root.at(0);
    strand.free_root->velocity = pose.v;
    strand.free_root->spin = pose.omega;
  }
}

}  // namespace tress::simulation
