#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include "backend/base/input_file.h"

namespace loopgrid {

/// The stream from which MRPT reads objects, with checks. MRPT does not check a file: where bytes
/// are missing it uses what was in memory, and it crashes on null pointers and failed allocations.
/// So Read() gives all the bytes asked for or throws. It also checks the names of classes, and two
/// numbers in the objects of planar laser rawlogs that could crash MRPT.
class RawlogStream {
 public:
  /// `is_known` tells whether MRPT can make an object of a class.
  RawlogStream(InputFile file, bool (*is_known)(const std::string& class_name));

  /// Throws Error (kInput) if the file has fewer bytes, or if they would crash MRPT.
  void Read(void* bytes, std::size_t count);

  InputFile& file() { return file_; }
  const InputFile& file() const { return file_; }

  /// What the last Read() threw, without the text that MRPT adds to it; empty if nothing.
  const std::string& failure() const { return failure_; }

 private:
  void ReadAll(char* bytes, std::size_t count);
  void Watch(std::string_view bytes);
  void EnterObject(std::string_view class_name, bool old_format);
  void CheckWord(std::uint32_t word);
  [[noreturn]] void Fail(const std::string& problem);

  InputFile file_;
  bool (*is_known_)(const std::string&);
  std::string failure_;

  std::size_t name_length_ = 0;   // if the next bytes are the name of a class
  bool old_header_ = false;       // with a length of 32 bits
  bool version_follows_ = false;  // as a word, in old files
  bool method_follows_ = false;   // how a movement was estimated, as a word
  bool needs_pose_pdf_ = false;   // the next object has to be one
  bool in_scan_ = false;          // before the count of a scan's readings
  bool after_object_ = false;     // the last byte ended an object
};

}  // namespace loopgrid
