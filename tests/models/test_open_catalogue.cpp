#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "contract/open_catalogue.h"
#include "integrators/catalogue.h"
#include "models/catalogue.h"
#include "models/effects/catalogue.h"

// What catalogues take from plug-ins, and what they refuse.
namespace tress::test_open_catalogue {

using testing::HasSubstr;
using testing::ThrowsMessage;

struct Entry {
  std::string_view id;
};
using Words = OpenCatalogue<Entry>;

TEST(OpenCatalogue, HoldsWhatIsAddedBehindWhatIsBuiltIn) {
  Words words("word", {{"one"}, {"two"}});
  words.add({"thr_ee3"}, "lib.so");
  ASSERT_EQ(words.entries().size(), 3u);
  ASSERT_EQ(words.added().size(), 1u);
  EXPECT_EQ(words.added().front().id, "thr_ee3");
  EXPECT_EQ(words.entries().back().id, "thr_ee3");
}

TEST(OpenCatalogue, TakesNothingOnceItIsClosed) {
  Words words("word", {{"one"}});
  EXPECT_EQ(words.close().size(), 1u);
  EXPECT_THAT([&] { words.add({"two"}, "lib.so"); },
              ThrowsMessage<InputError>(HasSubstr("too late")));
  EXPECT_EQ(words.entries().size(), 1u);
}

TEST(OpenCatalogue, RefusesIdsThatAreThereOrNoWords) {
  Words words("word", {{"one"}});
  words.add({"two"}, "lib.so");
  for (const std::string_view id : {"one", "two"}) {
    EXPECT_THAT([&] { words.add({id}, "lib.so"); },
                ThrowsMessage<InputError>(HasSubstr("already (lib.so)")));
  }
  for (const std::string_view id :
       {"", "2d", "_x", "A", "a-b", "a,b", "a b", "\xc3\xa4"}) {
    EXPECT_THAT([&] { words.add({id}, "lib.so"); },
                ThrowsMessage<InputError>(HasSubstr("no name for tables")));
  }
  EXPECT_EQ(words.entries().size(), 2u);
}

std::unique_ptr<System> make_none(const Parameters&) { return nullptr; }
std::unique_ptr<System> make_none_on_strand(const models::Strand&, const Parameters&,
                                            models::Effects) {
  return nullptr;
}
std::unique_ptr<Integrator> make_no_method(System&, const Options&) { return nullptr; }

auto message(std::string_view text) {
  return ThrowsMessage<InputError>(HasSubstr(std::string(text)));
}

TEST(AddedModels, AreRefusedWhereTheyCannotBeUsed) {
  models::ModelEntry mine{};
  mine.id = "mine";
  const auto add = [&mine] { models::add_model(mine, "lib.so"); };
  EXPECT_THAT(add, message("model 'mine' cannot be made (lib.so)"));
  static constexpr Parameter length{.name = "length_m", .help = "length (m)"};
  mine.make = make_none;
  mine.on_strand = make_none_on_strand;
  mine.parameters = {&length, 1};
  EXPECT_THAT(add, message("declares 'length_m', which all strands have"));
}

TEST(AddedEffects, AreRefusedWhereTheyCannotBeUsed) {
  models::EffectEntry mine{};
  mine.id = "mine";
  EXPECT_THAT([&mine] { models::add_effect(mine, "lib.so"); },
              message("effect 'mine' cannot be made (lib.so)"));
}

TEST(AddedIntegrators, AreRefusedWhereTheyCannotBeUsed) {
  integrators::IntegratorEntry mine{};
  mine.id = "mine";
  const auto add = [&mine] { integrators::add_integrator(mine, "lib.so"); };
  EXPECT_THAT(add, message("integrator 'mine' cannot be made"));
  mine.make = make_no_method;
  EXPECT_THAT(add, message("has no formulation"));
  mine.formulations = {{Formulation::parametric, 1}};
  static constexpr Parameter options[] = {
      {.name = "correction_tolerance", .help = "of another method"},
      {.name = "step", .help = "of all methods"}};
  for (const Parameter& option : options) {
    mine.parameters = {&option, 1};
    EXPECT_THAT(add, message("an option of others"));
  }
}

TEST(BuiltInEntries, LeaveNothingOfASkeletonToFillIn) {
  const auto check = [](const auto& entries) {
    for (const auto& entry : entries) {
      for (const std::string_view text : {entry.summary, entry.source}) {
        EXPECT_EQ(text.find("FILL IN"), text.npos)
            << "write summary and source of '" << entry.id << "' in its entry";
      }
    }
  };
  check(models::model_catalogue());
  check(models::effects());
  check(integrators::integrator_catalogue());
}

}  // namespace tress::test_open_catalogue
