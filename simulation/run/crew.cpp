#include "simulation/run/crew.h"

namespace tress::simulation {

Crew::Crew(int workers) : workers_(static_cast<std::size_t>(workers)), gate_(workers) {
  for (std::size_t w = 1; w < workers_; ++w) {
    threads_.emplace_back([this, w] {
      while (true) {
        gate_.arrive_and_wait();  // for work
        if (work_ == nullptr) return;
        share(w);
        gate_.arrive_and_wait();  // for the others
      }
    });
  }
}

Crew::~Crew() {
  work_ = nullptr;
  gate_.arrive_and_wait();
}

void Crew::run(std::size_t count, const std::function<void(std::size_t)>& work) {
  count_ = count;
  work_ = &work;
  gate_.arrive_and_wait();
  share(0);
  gate_.arrive_and_wait();
}

void Crew::share(std::size_t worker) {
  for (std::size_t i = worker; i < count_; i += workers_) (*work_)(i);
}

}  // namespace tress::simulation
