// A small experiment whose rows misbehave on request; the harness tests run it as a
// process. TOY_LOG names a file that gets one line per execution of a row.
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cstdlib>
#include <fstream>
#include <stdexcept>
#include <thread>

#include "experiments/run/experiment.h"
#include "experiments/run/message.h"
#include "experiments/run/settings.h"

namespace tress {

using namespace experiments;
namespace {

constexpr Column columns[] = {{"index", "which row"},
                              {"dt_s", "time step (s)"},
                              {"square", "index squared"},
                              {"wall_s", "time it took", true}};

constexpr Parameter settings[] = {
    {.name = "particles",
     .help = "rows of the table",
     .number = 4,
     .min = 1,
     .max = 1000,
     .whole = true},
    {.name = "dt", .help = "time step (s)", .number = 0.1, .min = 1e-12, .max = 1},
    {.name = "nap", .help = "time per row (s)", .number = 0, .min = 0, .max = 100},
    {.name = "odd_row",
     .help = "what row 2 does",
     .choices = "ok|crash|throw|busy|deaf|polite|quit|undeclared"},
    {.name = "promise",
     .help = "what the check says",
     .choices = "held|broken|known|changed|not_judged|figure"},
    {.name = "further",
     .help = "rows of a case beyond its own",
     .number = 0,
     .min = 0,
     .max = 100,
     .whole = true},
};

constexpr OwnOption options[] = {{"pause", "nap", "time per row (s)"},
                                 {"only", "odd_row", "what row 2 does", true}};

void log_execution(int index) {
  if (const char* file = std::getenv("TOY_LOG")) {
    std::ofstream(file, std::ios::app) << index << '\n';
  }
}

void misbehave(std::string_view how, Row& row, const Deadline& deadline) {
  if (how == "crash") raise(SIGSEGV);
  if (how == "throw") throw std::runtime_error("row 2, \"as asked\",\nthrew");
  if (how == "quit") _exit(7);
  if (how == "undeclared") row.set("sqare", 4);
  if (how == "deaf") {
    sigset_t all;
    sigfillset(&all);
    sigprocmask(SIG_BLOCK, &all, nullptr);
  }
  while (how == "busy" || how == "deaf") getpid();
  if (how == "polite") {
    while (!deadline.passed()) {
    }
    row.set("square", 1).failed("timeout", "stopped at t = 1 s");
  }
}

std::vector<Case> cases(const CommandLine& line) {
  const Settings chosen(line, settings);
  const Parameters& own = chosen.experiment();
  const double dt = own.number("dt");
  const std::chrono::duration<double> nap(own.number("nap"));
  const std::string odd_row(own.word("odd_row"));
  std::vector<Case> list;
  for (int i = 0; i < own.whole("particles"); ++i) {
    Case work;
    work.identity.set("index", i).set("dt_s", dt);
    work.run = [=](Row& row, const Deadline& deadline) {
      log_execution(i);
      std::this_thread::sleep_for(nap);
      if (i == 2) misbehave(odd_row, row, deadline);
      if (row.ok()) row.set("square", i * i).set("wall_s", deadline.remaining_s());
    };
    if (const int further = own.whole("further"); further > 0) {
      work.run_rows = [further, run = work.run](const Row& identity,
                                                const Deadline& deadline) {
        Row first = identity;
        run(first, deadline);
        std::vector<Row> rows{first};
        for (int k = 1; k <= further; ++k) {
          rows.push_back(identity);
          rows.back().set("square", -k);
        }
        return rows;
      };
    }
    list.push_back(std::move(work));
  }
  return list;
}

constexpr Unused unused[] = {{"repeat", "it times nothing"}};

/// `rows`: the number of rows, four unless told otherwise.
void judge(std::string_view promise, double rows, Verdicts& verdicts) {
  const Claim claim{"the promise", "key_of_the_promise"};
  if (promise == "not_judged") {
    verdicts.not_judged(claim);
  } else if (promise == "figure") {
    verdicts.figure(claim, rows);
  } else if (promise == "known" || promise == "changed") {
    const double expected = promise == "known" ? 4 : 5;
    verdicts.check_known(claim, false, rows, {"", expected, expected, "as the toy is"});
  } else {
    verdicts.check(claim, promise == "held", rows);
  }
}

}  // namespace
}  // namespace tress

int main(int argc, char** argv) {
  // The check cannot see the settings, so the promise is read from the arguments.
  std::string_view promise = "held";
  for (int i = 1; i < argc; ++i) {
    const std::string_view word(argv[i]);
    if (word.starts_with("promise=")) promise = word.substr(word.find('=') + 1);
  }
  const tress::Experiment toy{.name = "toy",
                              .question = "Does the harness keep its promises?",
                              .example = "--set particles=10 --out toy.csv",
                              .columns = tress::columns,
                              .settings = tress::settings,
                              .options = tress::options,
                              .unused = tress::unused,
                              .cases = tress::cases,
                              .checks = [promise](const std::vector<tress::Row>& rows,
                                                  tress::Verdicts& verdicts) {
                                tress::judge(promise, static_cast<double>(rows.size()),
                                             verdicts);
                              }};
  return tress::run_experiment(toy, argc, argv);
}
