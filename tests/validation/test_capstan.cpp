#include <gtest/gtest.h>

#include "experiments/validation/test.h"

namespace tress::test_capstan {

using namespace experiments;
using namespace experiments::validation;

// The table holds one friction coefficient. Newton's method finds no first solution for
// several of these with the penalty of contact that serves the others.
TEST(Capstan, IsThatOfThePolygonForAFamilyOfRopes) {
  const ValidationTest& test = find_validation_test("capstan_polygon");
  const ModelVariant der{&find_model("der"), {}, ""};
  const Deadline deadline(60);
  for (const int elements : {24, 36}) {
    for (const double friction : {0.2, 0.4, 0.5}) {
      EXPECT_NEAR(test.measure({der, elements, friction, deadline}), 1, test.tolerance)
          << elements << " elements, friction " << friction;
    }
  }
}

}  // namespace tress::test_capstan
