#include "simulation/files/locked_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <utility>

#include "contract/input_error.h"

namespace tress::simulation {
namespace {

[[noreturn]] void cannot_write(const std::string& file, const std::string& problem) {
  throw InputError("cannot write: " + problem, file,
                   "choose an --out in a writable directory");
}

}  // namespace

LockedFile::LockedFile(std::string file, std::string_view what) : file_(std::move(file)) {
  try {
    do {
      open();
    } while (!lock(what));
  } catch (...) {
    ::close(descriptor_);
    throw;
  }
}

LockedFile::~LockedFile() { ::close(descriptor_); }

void LockedFile::open() {
  if (descriptor_ >= 0) ::close(descriptor_);
  descriptor_ = ::open(file_.c_str(), O_RDWR | O_CREAT | O_NOFOLLOW | O_CLOEXEC, 0644);
  if (descriptor_ < 0) cannot_write(file_, std::strerror(errno));
}

/// Record locks belong to the process: unlike flock's, they are not inherited by the
/// forked cases. False: the previous owner of the lock has removed the file meanwhile.
bool LockedFile::lock(std::string_view what) const {
  struct flock whole_file {};
  whole_file.l_type = F_WRLCK;
  whole_file.l_whence = SEEK_SET;
  if (::fcntl(descriptor_, F_SETLK, &whole_file) != 0) {
    throw InputError("another run is writing " + std::string(what), file_,
                     "wait for it, or choose another --out");
  }
  struct stat status {};
  if (::fstat(descriptor_, &status) != 0) cannot_write(file_, std::strerror(errno));
  if (!S_ISREG(status.st_mode)) cannot_write(file_, "is not a regular file");
  return status.st_nlink > 0;
}

std::string LockedFile::read() const {
  std::string text;
  char buffer[65536];
  ssize_t n = 0;
  while ((n = ::pread(descriptor_, buffer, sizeof buffer,
                      static_cast<off_t>(text.size()))) > 0) {
    text.append(buffer, static_cast<std::size_t>(n));
  }
  if (n < 0) {
    throw InputError(std::string("cannot read: ") + std::strerror(errno), file_,
                     "give an existing, readable file");
  }
  return text;
}

void LockedFile::truncate(std::size_t bytes) const {
  if (::ftruncate(descriptor_, static_cast<off_t>(bytes)) != 0 ||
      ::lseek(descriptor_, 0, SEEK_END) < 0) {
    cannot_write(file_, std::strerror(errno));
  }
}

void LockedFile::remove() const { ::unlink(file_.c_str()); }

}  // namespace tress::simulation
