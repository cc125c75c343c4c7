#include "simulation/threads/crew.h"

#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <exception>

namespace tress::simulation {

struct Crew::Arena : tbb::task_arena {
  using tbb::task_arena::task_arena;
};

Crew::Crew(int threads)
    : workers_(
          static_cast<std::size_t>(std::min(threads, tbb::info::default_concurrency()))),
      arena_(workers_ > 1 ? std::make_unique<Arena>(static_cast<int>(workers_))
                          : nullptr) {}

Crew::~Crew() = default;

void Crew::run(std::size_t count, const std::function<void(std::size_t)>& work) {
  if (arena_ == nullptr) {
    for (std::size_t i = 0; i < count; ++i) work(i);
    return;
  }
  arena_->execute([&] { tbb::parallel_for(std::size_t{0}, count, work); });
}

void Crew::run(std::size_t count,
               const std::function<void(std::size_t, std::size_t)>& work) {
  run(count, [&](std::size_t i) {
    const int worker =
        arena_ == nullptr ? 0 : tbb::this_task_arena::current_thread_index();
    work(i, static_cast<std::size_t>(worker));
  });
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
