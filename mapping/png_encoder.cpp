#include "mapping/png_encoder.h"

#include <fmt/format.h>
#include <png.h>

#include <csetjmp>
#include <cstddef>
#include <new>
#include <utility>

#include "backend/base/error.h"

namespace loopgrid {
namespace {

constexpr int kMaxSide = 1000000;  // libpng's own limit
constexpr int kCompressionLevel = 6;
// Z_DEFAULT_STRATEGY of zlib. libpng's own choice would give other bytes for the same pixels.
constexpr int kCompressionStrategy = 0;

// The input and the output of libpng's functions.
struct Encoding {
  int width = 0;
  int height = 0;
  PixelFormat format = PixelFormat::kGrey;
  const std::uint8_t* pixels = nullptr;
  std::string bytes = {};
  std::string problem = {};
};

// libpng calls this instead of returning; it must not return either.
[[noreturn]] void Fail(png_structp png, png_const_charp message) {
  auto* encoding = static_cast<Encoding*>(png_get_error_ptr(png));
  try {
    encoding->problem = message;
  } catch (const std::bad_alloc&) {  // the problem stays empty; Write() returns false all the same
  }
  png_longjmp(png, 1);
}

void Ignore(png_structp, png_const_charp) {}

void Append(png_structp png, png_bytep bytes, std::size_t count) {
  auto* encoding = static_cast<Encoding*>(png_get_io_ptr(png));
  bool appended = true;
  try {
    encoding->bytes.append(reinterpret_cast<const char*>(bytes), count);
  } catch (const std::bad_alloc&) {  // exceptions must not pass through C code
    appended = false;
  }
  if (!appended) png_error(png, "out of memory");
}

void Flush(png_structp) {}

// Returns whether it has succeeded. When something fails, libpng leaves this function by longjmp(),
// so no object in it may have a destructor.
bool Write(png_structp png, png_infop info, Encoding* encoding) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, encoding, Append, Flush);
  png_set_compression_level(png, kCompressionLevel);
  png_set_compression_strategy(png, kCompressionStrategy);
  const bool grey = encoding->format == PixelFormat::kGrey;
  png_set_IHDR(png, info, static_cast<png_uint_32>(encoding->width),
               static_cast<png_uint_32>(encoding->height), 8,
               grey ? PNG_COLOR_TYPE_GRAY : PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE,
               PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_write_info(png, info);
  const std::size_t row_bytes =
      static_cast<std::size_t>(encoding->width) * static_cast<std::size_t>(encoding->format);
  const std::uint8_t* row = encoding->pixels;
  for (int y = 0; y < encoding->height; ++y, row += row_bytes) png_write_row(png, row);
  png_write_end(png, info);
  return true;
}

}  // namespace

std::string EncodePng(int width, int height, PixelFormat format,
                      std::span<const std::uint8_t> pixels) {
  if (width < 1 || height < 1 || width > kMaxSide || height > kMaxSide) {
    throw Error(ErrorCode::kOutput,
                fmt::format("a PNG image of {} x {} pixels is not possible", width, height));
  }
  const std::size_t expected = static_cast<std::size_t>(width) * static_cast<std::size_t>(height) *
                               static_cast<std::size_t>(format);
  if (pixels.size() != expected) {
    throw Error(ErrorCode::kOutput,
                fmt::format("a PNG image of {} x {} pixels takes {} bytes, not {}", width, height,
                            expected, pixels.size()));
  }
  Encoding encoding{.width = width, .height = height, .format = format, .pixels = pixels.data()};
  png_structp png = png_create_write_struct(PNG_LIBPNG_VER_STRING, &encoding, Fail, Ignore);
  if (png == nullptr) throw std::bad_alloc();
  png_infop info = png_create_info_struct(png);
  const bool written = info != nullptr && Write(png, info, &encoding);
  png_destroy_write_struct(&png, &info);
  if (!written) {
    throw Error(ErrorCode::kOutput, "cannot encode a PNG image: " + encoding.problem);
  }
  return std::move(encoding.bytes);
}

}  // namespace loopgrid
