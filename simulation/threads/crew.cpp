#include "simulation/threads/crew.h"

#include <exception>

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

void in_parts(Crew& crew, std::size_t begin, std::size_t end, std::size_t parts,
              const std::function<void(std::size_t, std::size_t)>& use) {
  std::vector<std::exception_ptr> errors(parts);
  const std::size_t count = end - begin;
  crew.run(parts, [&](std::size_t part) {
    try {
      for (std::size_t i = count * part / parts; i < count * (part + 1) / parts; ++i) {
        use(begin + i, part);
      }
    } catch (...) {
      errors[part] = std::current_exception();
    }
  });
  for (const std::exception_ptr& error : errors) {
    if (error) std::rethrow_exception(error);
  }
}

}  // namespace tress::simulation
