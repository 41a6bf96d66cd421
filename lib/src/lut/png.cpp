#include "lut/png.hpp"

#include <png.h>

#include <algorithm>
#include <csetjmp>
#include <cstring>
#include <stdexcept>

namespace lobe {
namespace {

constexpr std::size_t kMostSide = 1U << 16;

/// The message of libpng, which ends its calls by longjmp(): the functions that it may leave have only trivial objects.
struct Failure {
  char text[200] = "";
};

void fail(png_structp png, png_const_charp message) {
  auto* failure = static_cast<Failure*>(png_get_error_ptr(png));
  std::strncpy(failure->text, message, sizeof failure->text - 1);
  std::longjmp(*png_set_longjmp_fn(png, std::longjmp, sizeof(std::jmp_buf)), 1);
}

void ignore(png_structp /*png*/, png_const_charp /*message*/) {}

void append(png_structp png, png_bytep data, std::size_t size) {
  auto* content = static_cast<std::string*>(png_get_io_ptr(png));
  content->append(reinterpret_cast<const char*>(data), size);
}

struct Source {
  const char* data;
  std::size_t size;
  std::size_t at;
};

void take(png_structp png, png_bytep data, std::size_t size) {
  auto* source = static_cast<Source*>(png_get_io_ptr(png));
  if (size > source->size - source->at) png_error(png, "the file ends within the image");
  std::memcpy(data, source->data + source->at, size);
  source->at += size;
}

int color_type(std::size_t channels) {
  constexpr int kTypes[] = {PNG_COLOR_TYPE_GRAY, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_COLOR_TYPE_RGB,
                            PNG_COLOR_TYPE_RGB_ALPHA};
  return kTypes[channels - 1];
}

/// \return whether it was written
bool write(png_structp png, png_infop info, const LinearImage& image, const unsigned char* const* rows,
           const png_text* texts, int text_count, std::string* content) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_write_fn(png, content, append, nullptr);
  png_set_IHDR(png, info, static_cast<png_uint_32>(image.width), static_cast<png_uint_32>(image.height), image.bits,
               color_type(image.channels), PNG_INTERLACE_NONE, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
  png_set_gAMA(png, info, 1.0);
  if (text_count > 0) png_set_text(png, info, texts, text_count);
  png_write_info(png, info);
  for (std::size_t y = 0; y < image.height; ++y) png_write_row(png, rows[y]);
  png_write_end(png, info);
  return true;
}

/// Refuses chunks that are longer than the file: libpng allocates what they state.
void require_chunks(const FileBytes& file) {
  const std::string_view content = file.content();
  constexpr std::size_t kSignature = 8;
  constexpr std::size_t kFrame = 12;  // length, name and checksum of a chunk
  for (std::size_t at = kSignature; at < content.size();) {
    if (content.size() - at < kFrame) file.refuse("ends within a chunk");
    std::size_t length = 0;
    for (std::size_t i = 0; i < 4; ++i) length = length << 8U | static_cast<unsigned char>(content[at + i]);
    if (length > content.size() - at - kFrame) file.refuse("ends within a chunk");
    if (content.substr(at + 4, 4) == "IEND") return;
    at += kFrame + length;
  }
}

/// \return whether the head was read
bool read_head(png_structp png, png_infop info, Source* source) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_set_read_fn(png, source, take);
  png_set_user_limits(png, kMostSide, kMostSide);
  // Chunks are allocated by the length that they state; texts may be compressed.
  png_set_chunk_malloc_max(png, 8 * (source->size + 8192));
  png_read_info(png, info);
  return true;
}

/// \return whether the rows were read
bool read_rows(png_structp png, png_infop info, unsigned char* const* rows) {
  if (setjmp(png_jmpbuf(png)) != 0) return false;
  png_read_update_info(png, info);
  png_read_image(png, const_cast<png_bytepp>(rows));
  png_read_end(png, nullptr);
  return true;
}

/// The structures of libpng for writing or reading.
class Png {
 public:
  enum class Use { write, read };

  explicit Png(Use use) : use_(use) {
    png_ = use == Use::write ? png_create_write_struct(PNG_LIBPNG_VER_STRING, &failure_, fail, ignore)
                             : png_create_read_struct(PNG_LIBPNG_VER_STRING, &failure_, fail, ignore);
    if (png_ != nullptr) info_ = png_create_info_struct(png_);
    if (info_ == nullptr) throw std::bad_alloc();
  }
  ~Png() {
    if (use_ == Use::write) {
      png_destroy_write_struct(&png_, &info_);
    } else {
      png_destroy_read_struct(&png_, &info_, nullptr);
    }
  }
  Png(const Png&) = delete;
  Png& operator=(const Png&) = delete;

  [[nodiscard]] png_structp png() const { return png_; }
  [[nodiscard]] png_infop info() const { return info_; }
  [[nodiscard]] const char* failure() const { return failure_.text; }

 private:
  Use use_;
  Failure failure_;
  png_structp png_ = nullptr;
  png_infop info_ = nullptr;
};

}  // namespace

std::string png_content(const LinearImage& image, const std::vector<std::pair<std::string, std::string>>& texts) {
  const std::size_t row = image.width * image.channels;
  const std::size_t bytes = image.bits == 16 ? 2 : 1;
  std::vector<unsigned char> data;
  data.reserve(image.values.size() * bytes);
  for (const std::uint16_t value : image.values) {
    if (bytes == 2) data.push_back(static_cast<unsigned char>(value >> 8U));
    data.push_back(static_cast<unsigned char>(value & 0xFFU));
  }
  std::vector<const unsigned char*> rows(image.height);
  for (std::size_t y = 0; y < image.height; ++y) rows[y] = data.data() + y * row * bytes;
  auto copies = texts;
  std::vector<png_text> chunks;
  for (auto& [keyword, text] : copies) {
    png_text chunk{};
    chunk.compression = PNG_TEXT_COMPRESSION_NONE;
    chunk.key = keyword.data();
    chunk.text = text.data();
    chunk.text_length = text.size();
    chunks.push_back(chunk);
  }
  Png png(Png::Use::write);
  std::string content;
  if (!write(png.png(), png.info(), image, rows.data(), chunks.data(), static_cast<int>(chunks.size()), &content)) {
    throw std::runtime_error(std::string("libpng: ") + png.failure());
  }
  return content;
}

LinearImage read_png(const FileBytes& file) {
  require_chunks(file);
  Png png(Png::Use::read);
  Source source{file.content().data(), file.content().size(), 0};
  if (!read_head(png.png(), png.info(), &source)) file.refuse(png.failure());
  LinearImage image;
  image.width = png_get_image_width(png.png(), png.info());
  image.height = png_get_image_height(png.png(), png.info());
  image.channels = png_get_channels(png.png(), png.info());
  image.bits = png_get_bit_depth(png.png(), png.info());
  const bool has_palette = png_get_color_type(png.png(), png.info()) == PNG_COLOR_TYPE_PALETTE;
  if (has_palette || image.bits < 8 || png_get_interlace_type(png.png(), png.info()) != PNG_INTERLACE_NONE) {
    file.refuse("is an image with a palette, fewer than 8 bits or interlaced rows; expected 8 or 16 bits, row by row");
  }
  const std::size_t bytes = image.bits == 16 ? 2 : 1;
  const std::size_t row = image.width * image.channels * bytes;
  // The rows are compressed; no file holds less than a thousandth of them.
  if (row * image.height > 2000 * (file.content().size() + 1000)) file.refuse("is too small for its image");
  std::vector<unsigned char> data(row * image.height);
  std::vector<unsigned char*> rows(image.height);
  for (std::size_t y = 0; y < image.height; ++y) rows[y] = data.data() + y * row;
  if (!read_rows(png.png(), png.info(), rows.data())) file.refuse(png.failure());
  for (std::size_t i = 0; i < data.size(); i += bytes) {
    const unsigned value = bytes == 2 ? static_cast<unsigned>(data[i]) << 8U | data[i + 1] : data[i];
    image.values.push_back(static_cast<std::uint16_t>(value));
  }
  return image;
}

}  // namespace lobe
