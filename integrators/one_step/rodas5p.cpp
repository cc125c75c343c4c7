#include "integrators/one_step/rodas5p.h"

#include "integrators/entry.h"

namespace tress::integrators {
namespace {

constexpr Parameter own_rodas5p[] = {
    {.name = "velocity_difference",
     .help = "length of the differences for products with the Jacobian over the typical "
             "velocity; any is exact where forces are at most quadratic in velocity",
     .number = 1e-3,
     .min = 1e-8,
     .max = 1e8}};

constexpr double g = 0.21193756319429014;
constexpr std::array a6{-7.502846399306121, 2.561846144803919, -11.627539656261098,
                        -0.18268767659942256, 0.030198172008377946};

constexpr RosenbrockTable table{
    .stages = 8,
    .order = 5,
    .embedded_order = 4,
    .gamma = g,
    .a = {{{},
           {3},
           {2.849394379747939, 0.45842242204463923},
           {-6.954028509809101, 2.489845061869568, -10.358996098473584},
           {2.8029986275628964, 0.5072464736228206, -0.3988312541770524,
            -0.04721187230404641},
           {a6[0], a6[1], a6[2], a6[3], a6[4]},
           {a6[0], a6[1], a6[2], a6[3], a6[4], 1},
           {a6[0], a6[1], a6[2], a6[3], a6[4], 1, 1}}},
    .c = {{{},
           {-14.155112264123755},
           {-17.97296035885952, -2.859693295451294},
           {147.12150275711716, -1.41221402718213, 71.68940251302358},
           {165.43517024871676, -0.4592823456491126, 42.90938336958603,
            -5.961986721573306},
           {24.854864614690072, -3.0009227002832186, 47.4931110020768, 5.5814197821558125,
            -0.6610691825249471},
           {30.91273214028599, -3.1208243349937974, 77.79954646070892, 34.28646028294783,
            -19.097331116725623, -28.087943162872662},
           {37.80277123390563, -3.2571969029072276, 112.26918849496327, 66.9347231244047,
            -40.06618937091002, -54.66780262877968, -9.48861652309627}}},
    .time = {0, 3 * g, 0.4095798393397535, 0.9769306725060716, 0.4288403609558664, 1, 1,
             1},
    .rate = {g, -2 * g, -0.3384627126235924, 1.8046452872882734, 2.325825639765069},
    .share = 0.3};

constexpr std::string_view no_constraints =
    "its Jacobian must be exact, and that of the constraints lacks third derivatives";

}  // namespace

const RosenbrockTable& rodas5p_table() { return table; }

IntegratorEntry rodas5p_entry() {
  return {.id = "rodas5p",
          .summary = "Rosenbrock, L-stable, one exact Jacobian and no iteration",
          .source = "Steinebach 2023",
          .error_controlled = true,
          .tangent = true,
          .exact_jacobian = true,
          .formulations = {{Formulation::parametric, table.order}},
          .gaps = {{Formulation::acceleration, no_constraints},
                   {Formulation::baumgarte, no_constraints},
                   {Formulation::projection, no_constraints},
                   {Formulation::index3,
                    "Rosenbrock methods of this form are for equations of index 1"}},
          .parameters = own_rodas5p,
          .make = [](System& system, const Options& options) {
            return make_rosenbrock(
                table, system, options,
                own_options(options, own_rodas5p).number("velocity_difference"));
          }};
}

}  // namespace tress::integrators
