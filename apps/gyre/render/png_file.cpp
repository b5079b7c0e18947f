// Pictures as PNG, by libpng. See png_file.h.
#include "render/png_file.h"

#include <png.h>

namespace gyre {

std::string png_bytes(const Picture& picture, std::string& error) {
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = png_uint_32(picture.width);
  image.height = png_uint_32(picture.height);
  image.format = PNG_FORMAT_RGB;
  png_alloc_size_t size = 0;
  std::string bytes;
  if (png_image_write_get_memory_size(image, size, 0, picture.bytes.data(), 0, nullptr)) {
    bytes.resize(size);
    if (png_image_write_to_memory(&image, bytes.data(), &size, 0, picture.bytes.data(), 0, nullptr)) {
      bytes.resize(size);
      return bytes;
    }
  }
  error = std::string("the picture cannot be made: ") + image.message;
  png_image_free(&image);
  return {};
}

}  // namespace gyre
