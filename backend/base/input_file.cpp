#include "backend/base/input_file.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <cerrno>
#include <climits>
#include <system_error>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

constexpr unsigned kReadSize = 1U << 16;

[[noreturn]] void Fail(const std::string& path, const std::string& reason) {
  throw Error(ErrorCode::kInput, path + ": " + reason);
}

std::string SystemReason() { return std::generic_category().message(errno); }

}  // namespace

void InputFile::Closer::operator()(gzFile_s* file) const { gzclose_r(file); }

InputFile::InputFile(const std::string& path) : path_(path) {
  const int descriptor = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) Fail(path, "cannot open: " + SystemReason());
  struct stat status = {};
  const bool known = fstat(descriptor, &status) == 0;
  if (known && S_ISDIR(status.st_mode)) {
    close(descriptor);
    Fail(path, "is a directory");
  }
  if (known && S_ISREG(status.st_mode)) size_ = status.st_size;
  file_.reset(gzdopen(descriptor, "rb"));
  if (file_ == nullptr) {
    close(descriptor);
    Fail(path, "cannot open: out of memory");
  }
  gzbuffer(file_.get(), kReadSize);
}

std::size_t InputFile::ReadFromFile(char* bytes, std::size_t size) {
  const int count =
      gzread(file_.get(), bytes, static_cast<unsigned>(std::min<std::size_t>(size, INT_MAX)));
  if (count > 0) return static_cast<std::size_t>(count);
  int status = Z_OK;
  gzerror(file_.get(), &status);
  if (status == Z_ERRNO) Fail(path_, "cannot read: " + SystemReason());
  if (status == Z_BUF_ERROR) Fail(path_, "the gzip data are cut short");
  if (count < 0) Fail(path_, "the gzip data are corrupt");
  return 0;
}

std::size_t InputFile::Read(char* bytes, std::size_t size) {
  if (peeked_.empty()) return size == 0 ? 0 : ReadFromFile(bytes, size);
  const std::size_t count = peeked_.copy(bytes, size);
  peeked_.erase(0, count);
  return count;
}

std::string_view InputFile::Peek(std::size_t size) {
  while (peeked_.size() < size) {
    const std::size_t had = peeked_.size();
    peeked_.resize(size);
    std::size_t count = 0;
    try {
      count = ReadFromFile(peeked_.data() + had, size - had);
    } catch (...) {
      peeked_.resize(had);
      throw;
    }
    peeked_.resize(had + count);
    if (count == 0) break;
  }
  return std::string_view(peeked_).substr(0, size);
}

double InputFile::progress() const {
  if (size_ <= 0) return 0.0;
  const auto offset = static_cast<double>(gzoffset(file_.get()));
  return std::clamp(offset / static_cast<double>(size_), 0.0, 1.0);
}

}  // namespace loopgrid
