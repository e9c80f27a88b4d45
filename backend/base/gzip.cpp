#include "backend/base/gzip.h"

#define ZLIB_CONST  // inputs are pointers to const
#include <zlib.h>

#include <algorithm>
#include <climits>
#include <cstddef>
#include <new>

namespace loopgrid {

std::string Gzip(std::string_view bytes) {
  constexpr int kGzipWindow = 15 + 16;  // the largest window; + 16: a gzip header
  constexpr int kMemoryLevel = 8;
  z_stream stream{};
  if (deflateInit2(&stream, Z_DEFAULT_COMPRESSION, Z_DEFLATED, kGzipWindow, kMemoryLevel,
                   Z_DEFAULT_STRATEGY) != Z_OK) {
    throw std::bad_alloc();
  }
  std::string packed(deflateBound(&stream, bytes.size()), '\0');
  stream.next_in = reinterpret_cast<const Bytef*>(bytes.data());
  stream.next_out = reinterpret_cast<Bytef*>(packed.data());
  std::size_t unread = bytes.size();
  std::size_t free = packed.size();
  int status = Z_OK;
  while (status == Z_OK) {  // zlib counts what it is given in 32 bits
    stream.avail_in = static_cast<uInt>(std::min<std::size_t>(unread, UINT_MAX));
    stream.avail_out = static_cast<uInt>(std::min<std::size_t>(free, UINT_MAX));
    unread -= stream.avail_in;
    free -= stream.avail_out;
    status = deflate(&stream, unread == 0 ? Z_FINISH : Z_NO_FLUSH);
    unread += stream.avail_in;
    free += stream.avail_out;
  }
  deflateEnd(&stream);
  packed.resize(packed.size() - free);
  return packed;
}

}  // namespace loopgrid
