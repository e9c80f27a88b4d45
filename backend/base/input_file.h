#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <string_view>

struct gzFile_s;  // zlib's

namespace loopgrid {

/// Reads the bytes of a file in order. A file whose content is gzip is unpacked, whatever its name.
/// Every failure is an Error (kInput) that begins `file: `.
class InputFile {
 public:
  /// Throws for a missing or unreadable file and for a directory.
  explicit InputFile(const std::string& path);

  /// Reads up to `size` bytes; 0 at the end. Throws if the disk or the gzip stream fails.
  std::size_t Read(char* bytes, std::size_t size);

  /// Up to `size` bytes ahead of the reading position, without consuming them.
  std::string_view Peek(std::size_t size);

  /// Share of the file on disk consumed, 0..1; 0 where the size is unknown (a pipe).
  double progress() const;

  const std::string& path() const { return path_; }

 private:
  struct Closer {
    void operator()(gzFile_s* file) const;
  };

  std::size_t ReadFromFile(char* bytes, std::size_t size);

  std::string path_;
  std::unique_ptr<gzFile_s, Closer> file_;  // zlib passes files that are not gzip through
  std::int64_t size_ = 0;                   // on disk, 0 where unknown
  std::string peeked_;                      // read from the file, not yet by the caller
};

}  // namespace loopgrid
