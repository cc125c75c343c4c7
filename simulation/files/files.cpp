#include "simulation/files/files.h"

#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <cerrno>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <utility>

#include "contract/input_error.h"

namespace tress::simulation {
namespace {

namespace fs = std::filesystem;

constexpr std::string_view temporary_ending = ".tmp";  // the process's number follows

[[noreturn]] void cannot_write(const std::string& file, int error) {
  const bool full = error == ENOSPC || error == EDQUOT || error == EFBIG;
  throw InputError(std::string("cannot write: ") + std::strerror(error), "--out " + file,
                   full ? "free space or write elsewhere, then --resume"
                        : "choose a file in a writable directory");
}

/// A Replacement's neighbour whose process is gone.
bool is_leftover(const std::string& name) {
  const std::size_t at = name.rfind(temporary_ending);
  if (at == std::string::npos) return false;
  const std::string_view digits =
      std::string_view(name).substr(at + temporary_ending.size());
  pid_t process = 0;
  const auto [end, error] =
      std::from_chars(digits.data(), digits.data() + digits.size(), process);
  return error == std::errc() && end == digits.data() + digits.size() && process > 0 &&
         ::kill(process, 0) != 0 && errno == ESRCH;
}

}  // namespace

File::File(const std::string& file, int flags)
    : descriptor_(::open(file.c_str(), flags, 0644)) {
  if (descriptor_ < 0) cannot_write(file, errno);
}

File::~File() { ::close(descriptor_); }

void write_all(int descriptor, std::string_view text, const std::string& file) {
  while (!text.empty()) {
    const ssize_t written = ::write(descriptor, text.data(), text.size());
    if (written < 0 && errno == EINTR) continue;
    if (written <= 0) cannot_write(file, written < 0 ? errno : ENOSPC);
    text.remove_prefix(static_cast<std::size_t>(written));
  }
}

// A name unique to this process; a leftover of a killed process with the same id is
// removed. Never opens an existing file or a link placed there by others.
Replacement::Replacement(std::string file)
    : file_(std::move(file)),
      temporary_(file_ + std::string(temporary_ending) + std::to_string(::getpid())) {
  ::unlink(temporary_.c_str());
  output_.emplace(temporary_, O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC);
}

Replacement::~Replacement() {
  if (output_) ::unlink(temporary_.c_str());
}

void Replacement::write(std::string_view bytes) {
  write_all(output_->descriptor(), bytes, file_);
}

void Replacement::write_over(std::string_view bytes) {
  const ssize_t written = ::pwrite(output_->descriptor(), bytes.data(), bytes.size(), 0);
  if (written != static_cast<ssize_t>(bytes.size())) {
    cannot_write(file_, written < 0 ? errno : ENOSPC);
  }
}

void Replacement::keep() {
  if (::fsync(output_->descriptor()) != 0) cannot_write(file_, errno);
  if (std::rename(temporary_.c_str(), file_.c_str()) != 0) cannot_write(file_, errno);
  output_.reset();
}

void replace_file(const std::string& file, std::string_view text) {
  Replacement replacement(file);
  replacement.write(text);
  replacement.keep();
}

void refuse_link(const std::string& file) {
  std::error_code ignored;  // what cannot be seen cannot be followed
  refuse_if(fs::is_symlink(fs::symlink_status(file, ignored)), "the output is a link",
            "--out " + file, "remove the link, or name the file that it leads to");
}

void remove_leftovers(const std::string& stem) {
  const fs::path path = fs::absolute(stem);
  const std::string name = path.filename().string();
  std::error_code ignored;  // litter that stays is harmless
  const auto clear = [&](const fs::path& folder, const std::string& start) {
    std::vector<fs::path> found;
    for (const auto& entry : fs::directory_iterator(folder, ignored)) {
      const std::string file = entry.path().filename().string();
      if (file.starts_with(start) && is_leftover(file)) found.push_back(entry.path());
    }
    for (const fs::path& file : found) fs::remove(file, ignored);
  };
  clear(path.parent_path(), name + '.');
  for (const auto& entry : fs::directory_iterator(path.parent_path(), ignored)) {
    if (entry.path().filename().string().starts_with(name + '_') &&
        entry.is_directory(ignored)) {
      clear(entry.path(), name + '_');
    }
  }
}

void check_output(const std::string& file) {
  const std::string where = "--out " + file;
  std::error_code error;
  refuse_link(file);
  const fs::file_status status = fs::status(file, error);
  if (!fs::status_known(status)) cannot_write(file, error.value());
  if (fs::is_directory(status)) {
    throw InputError("the output is a directory", where, "give a file name in it");
  }
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw InputError("the output is not a regular file", where,
                     "give a .csv file, or - for standard output");
  }
  const fs::path parent = fs::absolute(file).parent_path();
  if (!fs::is_directory(parent, error)) {
    throw InputError("the output's directory does not exist", where,
                     "create it first: mkdir -p " + parent.string());
  }
  if (fs::exists(status) && ::access(file.c_str(), W_OK) != 0) cannot_write(file, errno);
  if (::access(parent.c_str(), W_OK) != 0) cannot_write(file, errno);
}

ReadyFolder::ReadyFolder(const std::string& folder, const std::string& place) {
  std::error_code error;
  for (fs::path path = fs::absolute(folder).lexically_normal();
       !path.empty() && !fs::exists(path, error) && path != path.parent_path();
       path = path.parent_path()) {
    made_.push_back(path.string());
  }
  fs::create_directories(folder, error);
  if (!fs::is_directory(folder, error)) {
    remove_empty();
    throw InputError("the output is not a folder", place,
                     "give a folder that exists or can be made");
  }
}

ReadyFolder::~ReadyFolder() { remove_empty(); }

void ReadyFolder::remove_empty() const {
  for (const std::string& folder : made_) ::rmdir(folder.c_str());  // fails on full ones
}

std::string beside(const std::string& file, std::string_view ending) {
  const std::string_view csv = ".csv";
  const bool has_ending = file.size() > csv.size() && file.ends_with(csv);
  return file.substr(0, file.size() - (has_ending ? csv.size() : 0)) +
         std::string(ending);
}

}  // namespace tress::simulation
