#pragma once

#include <memory>
#include <string>
#include <vector>

#include "contract/forms/energetics.h"
#include "contract/forms/material_points.h"
#include "contract/forms/teleports.h"
#include "contract/system.h"

namespace tress::models {

/// Strands as one system: coordinates and material points are those of the strands, one
/// after the other; energy and power are their sums. Derived classes provide the
/// equations of motion.
class StrandBlock : public System,
                    public Teleports,
                    protected Energetics,
                    protected MaterialPoints {
 public:
  /// Strands without constraints, at least one. The last `bodies` of them are bodies,
  /// whose points are not those of the block.
  explicit StrandBlock(std::vector<std::unique_ptr<System>> strands,
                       std::size_t bodies = 0);

  Layout layout() const override { return {first_.back(), 0}; }
  Traits traits() const override;
  void initial_state(Out q, Out v) const override;
  void scale(Out q_typ, Out v_typ) const override;
  double next_breakpoint(double t) const override;
  /// Returns the first teleport of any strand.
  double next_teleport(double t) const override;
  void teleport(double t, InOut q, InOut v) override;
  void follow(double t) override;
  std::string not_finite(double t, In q, In v) override;
  /// Null unless all strands have Energetics.
  Energetics* energetics() override;
  MaterialPoints* material_points() override { return this; }

  /// Returns the number of strands and bodies.
  std::size_t strands() const { return strands_.size(); }
  /// Returns the system of strand k.
  System& strand(std::size_t k) const { return *strands_[k]; }

 protected:
  /// Number of coordinates before strand k.
  int first(std::size_t k) const { return first_[k]; }
  /// The entries of strand k.
  template <class Span>
  Span part(Span all, std::size_t k) const {
    const auto from = static_cast<std::size_t>(first_[k]);
    return all.subspan(from, static_cast<std::size_t>(first_[k + 1]) - from);
  }

  // Of histories, strand after strand. memory_of_strands() has the size and the numbers
  // of each; recall_strands() takes them.
  bool accept_strands(double t, InOut q, InOut v);
  bool carry_strands(double t, InOut q, InOut v, InOut a) const;
  std::string strands_not_smooth() const;
  std::vector<double> memory_of_strands() const;
  void recall_strands(In memory);

  Energy energy(double t, In q, In v) override;
  std::optional<Momentum> momentum(double t, In q, In v) override;
  double power(double t, In q, In v) override;
  /// Returns the number of strands without bodies.
  std::size_t shown() const { return first_point_.size() - 1; }
  int count() const override { return first_point_.back(); }
  int before(int i) const override;
  void positions(double t, In q, Out x) override;
  void velocities(double t, In q, In v, Out u) override;
  std::optional<double> stretch(double t, In q) override;

 private:
  Out points_of(std::size_t k, Out x) const {
    const auto from = 3 * static_cast<std::size_t>(first_point_[k]);
    return x.subspan(from, 3 * static_cast<std::size_t>(first_point_[k + 1]) - from);
  }

  std::vector<std::unique_ptr<System>> strands_;
  std::vector<int> first_{0};        // coordinates before each strand; all
  std::vector<int> first_point_{0};  // material points before each strand; all
};

}  // namespace tress::models
