#pragma once

#include <memory>
#include <vector>

#include "contract/system.h"

namespace tress::models {

/// Strands with equal numbers of unknowns as one system: coordinates and material points
/// are those of the strands, one after the other; energy and power are their sums.
/// Derived classes provide the equations of motion.
class StrandBlock : public System,
                    protected ExplicitForm,
                    protected Energetics,
                    protected MaterialPoints {
 public:
  /// Strands without constraints or memory, at least one.
  explicit StrandBlock(std::vector<std::unique_ptr<System>> strands);

  Layout layout() const override;
  Traits traits() const override { return strands_.front()->traits(); }
  void initial_state(Out q, Out v) const override;
  void scale(Out q_typ, Out v_typ) const override;
  double next_breakpoint(double t) const override;
  std::string not_finite(double t, In q, In v) override;
  ExplicitForm* explicit_form() override;
  Energetics* energetics() override { return this; }
  MaterialPoints* material_points() override { return this; }

 protected:
  std::size_t strands() const { return strands_.size(); }
  std::size_t unknowns() const { return unknowns_; }  // per strand

 private:
  In of(std::size_t strand, In x) const {
    return x.subspan(strand * unknowns_, unknowns_);
  }
  Out of(std::size_t strand, Out x) const {
    return x.subspan(strand * unknowns_, unknowns_);
  }
  Out points_of(std::size_t strand, Out x) const {
    const std::size_t size = 3 * static_cast<std::size_t>(points_);
    return x.subspan(strand * size, size);
  }

  Status acceleration(double t, In q, In v, Out a) noexcept override;
  Energy energy(double t, In q, In v) override;
  std::optional<Momentum> momentum(double t, In q, In v) override;
  double power(double t, In q, In v) override;
  int count() const override { return static_cast<int>(strands_.size()) * points_; }
  int before(int i) const override;
  void positions(double t, In q, Out x) override;
  void velocities(double t, In q, In v, Out u) override;
  std::optional<double> stretch(double t, In q) override;

  std::vector<std::unique_ptr<System>> strands_;
  std::size_t unknowns_;
  int points_;  // per strand
};

}  // namespace tress::models
