#include "frontend/log/rawlog/rawlog_stream.h"

#include <cstring>
#include <utility>

#include "backend/base/error.h"
#include "frontend/log/rawlog/rawlog_format.h"

namespace loopgrid {
namespace {

constexpr std::uint8_t kNewHeader = 0x80;  // flag beside the length of the class's name
constexpr std::uint8_t kEndFlag = 0x88;    // after the last field of an object
constexpr std::uint32_t kMostReadings = 1U << 20;

bool Contains(std::string_view text, std::string_view part) { return text.find(part) != text.npos; }

}  // namespace

RawlogStream::RawlogStream(InputFile file, bool (*is_known)(const std::string&))
    : file_(std::move(file)), is_known_(is_known) {}

void RawlogStream::Fail(const std::string& problem) {
  throw Error(ErrorCode::kInput, file_.path() + ": " + problem);
}

void RawlogStream::Read(void* bytes, std::size_t count) {
  try {
    ReadAll(static_cast<char*>(bytes), count);
    Watch({static_cast<const char*>(bytes), count});
  } catch (const Error& error) {
    failure_ = error.what();
    throw;
  }
}

void RawlogStream::ReadAll(char* bytes, std::size_t count) {
  for (std::size_t done = 0; done < count;) {
    const std::size_t more = file_.Read(bytes + done, count - done);
    if (more == 0) Fail("ends in the middle of an object");
    done += more;
  }
}

// An object begins with one byte, the length of its class name with the flag kNewHeader. In files
// older than 2009 the flag is missing and three bytes of zeros follow. Then come the name, the
// version (one byte, or a word in old files), the fields (some are objects themselves), and in new
// files kEndFlag.
void RawlogStream::Watch(std::string_view bytes) {
  if (bytes.size() == 1) {
    const auto byte = static_cast<std::uint8_t>(bytes[0]);
    name_length_ = byte & (kNewHeader - 1U);
    old_header_ = byte < kNewHeader;
    after_object_ = byte == kEndFlag;
    return;
  }
  if (old_header_ && bytes == std::string_view("\0\0\0", 3)) return;
  if (bytes.size() == name_length_ && IsMrptClassName(bytes)) {
    EnterObject(bytes, old_header_);
  } else if (bytes.size() == sizeof(std::uint32_t)) {
    std::uint32_t word = 0;
    std::memcpy(&word, bytes.data(), sizeof(word));
    CheckWord(word);
  }
  name_length_ = 0;
  after_object_ = false;
}

void RawlogStream::EnterObject(std::string_view class_name, bool old_format) {
  const std::string name(class_name);
  if (needs_pose_pdf_ && !Contains(name, "CPosePDF")) {
    Fail("a movement without its distribution (a " + name + " instead)");
  }
  needs_pose_pdf_ = false;
  if (name == "nullptr") return;
  if (!is_known_(name)) Fail("an object of the class " + name + ", which is not known");
  version_follows_ = old_format;
  method_follows_ = Contains(name, "CActionRobotMovement2D");
  if (Contains(name, "CObservation") || Contains(name, "CAction")) {
    in_scan_ = Contains(name, "CObservation2DRangeScan");
  }
}

void RawlogStream::CheckWord(std::uint32_t word) {
  if (std::exchange(version_follows_, false)) return;
  if (std::exchange(method_follows_, false)) {
    if (word > 1) Fail("a movement estimated in an unknown way");
    needs_pose_pdf_ = word == 1;  // 0: it was estimated from odometry, and no pose PDF follows
  } else if (in_scan_ && after_object_) {
    if (word > kMostReadings) Fail("a scan of " + std::to_string(word) + " readings");
    in_scan_ = false;
  }
}

}  // namespace loopgrid
