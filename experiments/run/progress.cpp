#include "experiments/run/progress.h"

#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <utility>

#include "experiments/run/message.h"

namespace tress::experiments {
namespace {

constexpr std::chrono::milliseconds between_bars{100};
constexpr std::chrono::seconds between_running_bars{1};
constexpr int bar_width = 30;

}  // namespace

std::string readable_duration(double seconds) {
  const long whole = std::lround(seconds);
  if (whole < 60) return fmt::format("{} s", whole);
  if (whole < 3600) return fmt::format("{} min {:02} s", whole / 60, whole % 60);
  return fmt::format("{} h {:02} min", whole / 3600, whole % 3600 / 60);
}

Progress::Progress(ProgressMode mode, std::string_view name, std::size_t rows)
    : style_(mode == ProgressMode::none     ? Style::none
             : mode == ProgressMode::json   ? Style::json
             : ::isatty(STDERR_FILENO) != 0 ? Style::bar
                                            : Style::lines),
      colour_(std::getenv("NO_COLOR") == nullptr),
      name_(name),
      rows_(rows),
      start_(Clock::now()),
      last_(start_) {
  if (style_ == Style::bar) print_bar(NAN);
}

Progress::~Progress() {
  if (style_ == Style::bar) std::fputs("\r\033[K", stderr);
}

void Progress::finished(const Row& row, double seconds) {
  ++done_;
  failed_ += row.ok() ? 0 : 1;
  const auto now = Clock::now();
  const double elapsed_s = std::chrono::duration<double>(now - start_).count();
  const double left_s =
      elapsed_s * static_cast<double>(rows_ - done_) / static_cast<double>(done_);
  if (style_ == Style::json) {
    const nlohmann::json event{{"event", "row"},         {"experiment", name_},
                               {"done", done_},          {"total", rows_},
                               {"failed", failed_},      {"elapsed_s", elapsed_s},
                               {"eta_s", left_s},        {"seconds", seconds},
                               {"status", row.status()}, {"run_id", row.text("run_id")}};
    tell("{}\n", event.dump());
    last_ = now;
    return;
  }
  const bool due =
      style_ == Style::bar ? now - last_ >= between_bars : now - last_ >= between_lines;
  if (!due || style_ == Style::none) return;
  last_ = now;
  if (style_ == Style::bar) {
    print_bar(left_s);
  } else {
    tell("{}: {}/{} rows, {} failed, about {} left\n", name_, done_, rows_, failed_,
         readable_duration(left_s));
  }
}

void Progress::running(const Row& identity, double seconds) {
  const auto now = Clock::now();
  if (style_ == Style::none) return;
  if (now - last_ < (style_ == Style::bar ? between_running_bars : between_lines)) return;
  last_ = now;
  if (style_ == Style::bar) {
    print_bar(NAN);
  } else if (style_ == Style::json) {
    const nlohmann::json event{
        {"event", "running"}, {"experiment", name_},       {"done", done_},
        {"total", rows_},     {"row", describe(identity)}, {"seconds", seconds}};
    tell("{}\n", event.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace));
  } else {
    tell("{}: {}/{} rows, {} failed; for {} at {}\n", name_, done_, rows_, failed_,
         readable_duration(seconds), describe(identity));
  }
}

void Progress::print_bar(double left_s) const {
  const int full = rows_ == 0 ? bar_width : static_cast<int>(bar_width * done_ / rows_);
  const std::string bar = std::string(static_cast<std::size_t>(full), '#') +
                          std::string(static_cast<std::size_t>(bar_width - full), '.');
  const std::string left =
      std::isfinite(left_s) ? ", about " + readable_duration(left_s) + " left" : "";
  const bool red = colour_ && failed_ > 0;
  tell("\r{} [{}] {}/{}{}{}{}{}\033[K", name_, bar, done_, rows_, red ? "\033[31m" : "",
       failed_ > 0 ? fmt::format(", {} failed", failed_) : "", red ? "\033[0m" : "",
       left);
  std::fflush(stderr);
}

Heartbeat::Heartbeat(ProgressMode mode, std::string_view program)
    : mode_(mode),
      terminal_(mode == ProgressMode::automatic && ::isatty(STDERR_FILENO) != 0),
      program_(program) {
  if (mode_ != ProgressMode::none) thread_ = std::thread([this] { run(); });
}

Heartbeat::~Heartbeat() {
  if (!thread_.joinable()) return;
  {
    const std::lock_guard lock(mutex_);
    over_ = true;
  }
  changed_.notify_all();
  thread_.join();
  if (terminal_) tell_text("\r\033[K");
}

void Heartbeat::doing(std::string what) {
  const std::lock_guard lock(mutex_);
  doing_ = std::move(what);
  begun_ = Clock::now();
}

void Heartbeat::told() {
  const std::lock_guard lock(mutex_);
  told_ = Clock::now();
}

void Heartbeat::run() {
  std::unique_lock lock(mutex_);
  while (!over_) {
    changed_.wait_until(lock, told_ + between_lines);
    const auto now = Clock::now();
    if (over_ || now < told_ + between_lines) continue;
    told_ = now;
    if (!doing_.empty()) tell_text(line(now));
  }
}

std::string Heartbeat::line(Clock::time_point now) const {
  const double seconds = std::chrono::duration<double>(now - begun_).count();
  if (mode_ == ProgressMode::json) {
    const nlohmann::json event{{"event", "working"},
                               {"program", program_},
                               {"on", doing_},
                               {"seconds", seconds}};
    return event.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace) + '\n';
  }
  const std::string lasting =
      seconds < 1 ? "" : fmt::format(", for {}", readable_duration(seconds));
  return fmt::format("{}{}: {}{}{}", terminal_ ? "\r" : "", program_, doing_, lasting,
                     terminal_ ? "\033[K" : "\n");
}

}  // namespace tress::experiments
