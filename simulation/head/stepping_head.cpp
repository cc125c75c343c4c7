#include "simulation/head/stepping_head.h"

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

#include "integrators/block/block_solver.h"
#include "integrators/block/controlled_blocks.h"
#include "models/head/head_losses.h"

namespace tress::simulation {
namespace {

template <class N>
class SteppingHead final : public models::Head {
 public:
  SteppingHead(std::unique_ptr<models::LaneKernel<N>> kernel, const HeadOptions& options)
      : options_(options),
        kernel_(std::move(kernel)),
        method_(block_method(options.method)),
        n_(kernel_->elements()),
        all_(kernel_->memory(), kernel_->lanes(), kernel_->unknowns(), method_,
             options.tolerance > 0) {}

  void reserve(std::size_t strands) override { all_.reserve(strands); }

  using Head::add;
  using Head::losses;
  void add(const models::Strand& strand, models::Effects own) override {
    kernel_->admit(strand, own);
    all_.add([&](LanePlace to, StrandMemory& memory, N* q, N* v) {
      kernel_->describe(strand, to, memory, q, v);
    });
  }

  std::size_t strands() const override { return all_.size(); }
  std::size_t blocks() const override { return all_.blocks(); }
  std::size_t bytes() const override { return all_.bytes(); }
  std::unique_ptr<Scratch> scratch() const override {
    return std::make_unique<Own>(*kernel_, method_, options_);
  }

  void step(std::size_t block, double t, double h, Scratch& given) override {
    step(block, block + 1, t, h, given);
  }
  void step(std::size_t first, std::size_t last, double t, double h,
            Scratch& given) override {
    Own& own = static_cast<Own&>(given);
    if (own.controlled) return control(first, last, t, h, own);
    const typename BlockSolver<N>::Step now{all_, {t, h}, own.Scratch::work};
    renew(first, last, now.span, own);
    for (std::size_t block = first; block < last; ++block) {
      now.done.steps += static_cast<long>(all_.of(block));
    }
    const auto& lost = method_.linear() ? own.solver.correct_blocks(first, last, now)
                                        : own.solver.step(strands_in(first, last), now);
    for (const auto& [strand, reason] : lost) losses_.add(strand, t, h, reason);
  }

  /// Returns the number of blocks per call. Strands that choose their steps share lanes
  /// only with those of the same step. With a hundred blocks of 8 lanes 8 % of the lanes
  /// are empty, with a dozen 40 %.
  std::size_t blocks_at_once() const override {
    return options_.tolerance > 0 ? 100 : Head::blocks_at_once();
  }
  bool lost(std::size_t strand) const override { return all_.lost(strand); }
  std::vector<models::HeadLoss> losses(std::size_t known) const override {
    return losses_.after(known);
  }
  void lose(std::size_t strand) override { all_.lose(strand); }

  std::size_t numbers() const override { return 3 * (n_ + 1); }
  std::size_t strands_of(std::size_t block) const override { return all_.of(block); }
  void positions(std::size_t block, double t, std::span<double> x) const override {
    kernel_->positions(all_.memory(), block, t, all_.q(block), all_.of(block), x);
  }
  void motion(std::size_t block, double t, std::span<double> x,
              std::span<double> v) const override {
    positions(block, t, x);
    kernel_->velocities(all_.memory(), block, t, all_.q(block), all_.v(block),
                        all_.of(block), v);
  }
  void ahead(std::size_t block, double t, double h, std::span<double> x,
             std::span<double> bulge) const override {
    kernel_->ahead(all_.memory(), block, t, h, all_.q(block), all_.v(block),
                   all_.of(block), x, bulge);
  }
  void state(std::size_t strand, std::span<double> q,
             std::span<double> v) const override {
    const LanePlace at = all_.place(strand);
    kernel_->state(at.lane, all_.q(at.block), all_.v(at.block), q, v);
  }
  void energies(std::size_t block, double t,
                std::span<models::HeadEnergy> each) const override {
    kernel_->energies(all_.memory(), block, t, all_.q(block), all_.v(block),
                      all_.of(block), each);
  }

  std::size_t kept() const override { return all_.kept(); }
  std::size_t kept_of_state() const override { return 2 * kernel_->unknowns(); }
  void keep(std::size_t block, std::span<double> x) const override {
    all_.keep(block, x.data());
  }
  void recall(std::size_t block, std::span<const double> x) override {
    all_.recall(block, x.data());
  }

 private:
  struct Own final : Scratch {
    Own(const models::LaneKernel<N>& kernel, const BlockMethod& method,
        const HeadOptions& options)
        : block(kernel.block()), solver(*block, method, limits(*block, options)) {
      if (options.tolerance > 0) {
        controlled.emplace(*block, method, options.tolerance, options.min_step, solver);
      }
    }
    static NewtonLimits limits(const Block<N>& block, const HeadOptions& options) {
      const bool controls = options.tolerance > 0;
      return {
          controls ? block.newton_part() * options.tolerance : options.newton_tolerance,
          controls ? 1 : NewtonRules::margin, options.newton_iterations};
    }

    std::unique_ptr<Block<N>> block;
    BlockSolver<N> solver;
    std::optional<ControlledBlocks<N>> controlled;  // with a tolerance
  };

  LaneQueue strands_in(std::size_t first, std::size_t last) const {
    const auto width = static_cast<std::size_t>(kernel_->lanes());
    return {width * first, std::min(width * last, all_.size())};
  }
  void renew(std::size_t first, std::size_t last, const TimeSpan& span, Own& own) {
    own.block->set_step(span.at(0), span.at(1));
    for (std::size_t block = first; block < last; ++block) all_.renew(*own.block, block);
  }

  /// Steps of each strand's own, which end where the motion of the head is not smooth.
  void control(std::size_t first, std::size_t last, double t, double h, Own& own) {
    const double end = t + h;
    const LaneQueue all = strands_in(first, last);
    for (double begin = t; begin < end;) {
      const double stop = std::min(options_.motion.next_breakpoint(begin), end),
                   length = stop - begin;
      const TimeSpan span{begin, length};
      renew(first, last, span, own);
      for (const auto& [strand, at, reason] :
           own.controlled->step(all.next, all.end, all_, span, own.Scratch::work)) {
        losses_.add(strand, t, h, reason, (begin - t + at * length) / h);
      }
      begin = stop;
    }
  }

  HeadOptions options_;
  std::unique_ptr<models::LaneKernel<N>> kernel_;
  BlockMethod method_;
  std::size_t n_;  // elements of a strand
  BlockStore<N> all_;
  models::HeadLosses losses_;
};

}  // namespace

std::unique_ptr<models::Head> stepping_head(
    std::unique_ptr<models::LaneKernel<double>> kernel, const HeadOptions& options) {
  return std::make_unique<SteppingHead<double>>(std::move(kernel), options);
}
std::unique_ptr<models::Head> stepping_head(
    std::unique_ptr<models::LaneKernel<float>> kernel, const HeadOptions& options) {
  return std::make_unique<SteppingHead<float>>(std::move(kernel), options);
}

}  // namespace tress::simulation
