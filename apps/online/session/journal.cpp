#include "apps/online/session/journal.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <system_error>
#include <utility>

#include "backend/base/error.h"
#include "backend/base/line_reader.h"
#include "frontend/log/carmen/carmen_interpreter.h"
#include "frontend/log/rawlog/rawlog_format.h"

namespace loopgrid {
namespace {

constexpr std::chrono::seconds kBetweenSyncs(1);
constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
constexpr std::string_view kGzip = "\x1F\x8B";

[[noreturn]] void FailAtJournal(const std::string& path, const char* doing) {
  const int reason = errno;
  throw Error(ErrorCode::kOutput,
              path + ": " + doing + ": " + std::generic_category().message(reason));
}

/// An unfinished line without its last field, because that field may be cut short.
std::string_view ClosedText(std::string_view bytes) {
  const bool too_long = bytes.size() - (bytes.ends_with('\r') ? 1 : 0) > LineReader::kMaxLineLength;
  return too_long ? bytes : WithoutCutField(bytes);
}

}  // namespace

std::string JournalText(const ReceivedLine& line) {
  if (line.too_long) return std::string(LineReader::kMaxLineLength + 1, '#');
  // A reader takes one CR as a part of the line end, so a second one is added.
  return line.text.ends_with('\r') ? line.text + '\r' : line.text;
}

void KeepReadable(ReceivedLine* first) {
  const std::string_view text = first->text;
  if (text.starts_with(kGzip) || text.starts_with(kByteOrderMark) || LooksLikeRawlog(text)) {
    first->text.insert(0, "# ");
  }
}

Journal::Journal(const std::string& path) : path_(path) {
  descriptor_ = open(path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0666);
  if (descriptor_ < 0) FailAtJournal(path_, "cannot open");
  try {
    size_ = lseek(descriptor_, 0, SEEK_END);
    if (size_ < 0) FailAtJournal(path_, "cannot read");
    FindOpenEnd();
  } catch (...) {
    close(descriptor_);
    throw;
  }
  syncing_ = std::thread([this] { KeepSynced(); });
}

Journal::~Journal() {
  {
    const std::lock_guard lock(mutex_);
    closing_ = true;
  }
  wake_.notify_all();
  syncing_.join();
  close(descriptor_);
}

void Journal::FindOpenEnd() {
  std::array<char, 1 << 16> chunk;
  for (std::int64_t end = size_; end > 0;) {
    const auto count = static_cast<std::size_t>(std::min<std::int64_t>(end, chunk.size()));
    end -= static_cast<std::int64_t>(count);
    if (pread(descriptor_, chunk.data(), count, end) != static_cast<ssize_t>(count)) {
      FailAtJournal(path_, "cannot read");
    }
    const std::string_view bytes(chunk.data(), count);
    const std::size_t newline = bytes.rfind('\n');
    if (newline != bytes.npos) {
      open_end_.insert(0, bytes.substr(newline + 1));
      return;
    }
    open_end_.insert(0, bytes);
  }
}

void Journal::Read(const std::function<void(ReceivedLine)>& visit) const {
  if (empty()) return;
  LineReader lines(path_);
  std::string_view text;
  while (lines.Next(&text)) {
    visit({.text = std::string(text),
           .terminated = lines.terminated(),
           .too_long = lines.too_long(),
           .arrival = std::chrono::steady_clock::now()});
  }
}

void Journal::Append(const ReceivedLine& line) {
  if (has_open_end()) CloseOpenEnd();
  std::string bytes = JournalText(line);
  if (!line.terminated) open_end_ = bytes;
  if (line.terminated) bytes += '\n';
  Write(bytes);
}

bool Journal::IsContinuedBy(const ReceivedLine& line) const {
  return JournalText(line).starts_with(open_end_);
}

void Journal::Complete(const ReceivedLine& line) {
  std::string bytes = JournalText(line);
  const std::size_t written = std::exchange(open_end_, line.terminated ? "" : bytes).size();
  if (line.terminated) bytes += '\n';
  Write(std::string_view(bytes).substr(written));
}

void Journal::CloseOpenEnd() {
  const auto cut = static_cast<std::int64_t>(open_end_.size() - ClosedText(open_end_).size());
  if (ftruncate(descriptor_, size_ - cut) != 0) FailAtJournal(path_, "cannot write");
  size_ -= cut;
  open_end_.clear();
  Write("\n");
}

void Journal::Write(std::string_view bytes) {
  {
    const std::lock_guard lock(mutex_);
    if (!problem_.empty()) throw Error(ErrorCode::kOutput, problem_);
    unsynced_ = true;
  }
  const std::int64_t start = size_;
  while (!bytes.empty()) {
    const ssize_t count = pwrite(descriptor_, bytes.data(), bytes.size(), size_);
    if (count < 0 && errno == EINTR) continue;
    if (count < 0) {
      const int reason = errno;
      // If this fails, a line without end stays in the file. A resumed session repairs it.
      if (ftruncate(descriptor_, start) == 0) size_ = start;
      errno = reason;
      FailAtJournal(path_, "cannot write");
    }
    bytes.remove_prefix(static_cast<std::size_t>(count));
    size_ += count;
  }
}

void Journal::Sync() {
  const std::string problem = SyncProblem();
  if (!problem.empty()) throw Error(ErrorCode::kOutput, problem);
}

std::string Journal::SyncProblem() const {
  struct stat status = {};
  if (fstat(descriptor_, &status) == 0 && status.st_nlink == 0) return path_ + ": was removed";
  if (fdatasync(descriptor_) == 0) return "";
  return path_ + ": cannot write: " + std::generic_category().message(errno);
}

void Journal::KeepSynced() {
  std::unique_lock lock(mutex_);
  while (!closing_) {
    wake_.wait_for(lock, kBetweenSyncs, [this] { return closing_; });
    if (!std::exchange(unsynced_, false)) continue;
    lock.unlock();
    std::string problem = SyncProblem();
    lock.lock();
    if (!problem.empty()) problem_ = std::move(problem);
  }
}

}  // namespace loopgrid
