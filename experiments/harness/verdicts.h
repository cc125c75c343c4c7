#pragma once

#include <string>
#include <vector>

namespace tress {

/// What a finished table must show, claim by claim: printed as PASS or FAIL lines and
/// kept in the manifest, so that the report can show them.
class Verdicts {
 public:
  struct Verdict {
    std::string claim;
    bool held;
    double value;  // the number that decided
  };

  void check(std::string claim, bool held, double value) {
    all_.push_back({std::move(claim), held, value});
  }

  const std::vector<Verdict>& all() const { return all_; }

 private:
  std::vector<Verdict> all_;
};

}  // namespace tress
