// Movies as GIF, by giflib. See gif_file.h.
#include "render/gif_file.h"

#include "render/palette.h"

#include <gif_lib.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>

namespace gyre {
namespace {

constexpr std::size_t kMaxColors = 255;  // and one number for "as before"
constexpr int kSameEnough = 3;  // of 255: a change too small to be seen is none, which keeps files small

int append_to_string(GifFileType* file, const GifByteType* bytes, int count) {
  static_cast<std::string*>(file->UserData)->append(reinterpret_cast<const char*>(bytes), std::size_t(count));
  return count;
}

struct Rectangle {
  int left, top, right, bottom;  // right and bottom are beyond it
};

// What a viewer of the movie sees so far.
struct Shown {
  std::vector<std::uint8_t> numbers, bytes;
};

class GifWriter {
 public:
  GifWriter(const std::vector<Picture>& frames, double seconds, PaletteMap map)
      : frames_(frames), seconds_(seconds), map_(std::move(map)) {}

  bool write(GifFileType* file) {
    return write_start(file) && std::all_of(frames_.begin(), frames_.end(),
                                            [&](const Picture& frame) { return write_frame(file, frame); });
  }

 private:
  bool write_start(GifFileType* file);
  bool write_frame(GifFileType* file, const Picture& frame);
  bool write_control(GifFileType* file);
  Rectangle find_changes(const Picture& frame, std::vector<std::uint8_t>& numbers);

  int as_before() const { return int(map_.palette().size()); }

  const std::vector<Picture>& frames_;
  double seconds_;
  PaletteMap map_;
  Shown shown_;
  std::size_t written_ = 0;
};

bool GifWriter::write_start(GifFileType* file) {
  const std::vector<Rgb>& palette = map_.palette();
  int colors = 2;  // the format wants a power of two
  while (colors < int(palette.size()) + 1) colors *= 2;
  std::vector<GifColorType> table(std::size_t(colors), GifColorType{0, 0, 0});
  for (std::size_t i = 0; i < palette.size(); ++i) table[i] = {palette[i][0], palette[i][1], palette[i][2]};
  const std::unique_ptr<ColorMapObject, decltype(&GifFreeMapObject)> map(
      GifMakeMapObject(colors, table.data()), &GifFreeMapObject);
  EGifSetGifVersion(file, true);
  if (!map || EGifPutScreenDesc(file, frames_[0].width, frames_[0].height, 8, 0, map.get()) == GIF_ERROR)
    return false;
  if (frames_.size() < 2) return true;
  constexpr GifByteType kForEver[] = {1, 0, 0};
  return EGifPutExtensionLeader(file, APPLICATION_EXT_FUNC_CODE) != GIF_ERROR &&
         EGifPutExtensionBlock(file, 11, "NETSCAPE2.0") != GIF_ERROR &&
         EGifPutExtensionBlock(file, sizeof kForEver, kForEver) != GIF_ERROR &&
         EGifPutExtensionTrailer(file) != GIF_ERROR;
}

bool GifWriter::write_control(GifFileType* file) {
  const auto hundredths = [&](std::size_t frame) { return std::llround(100.0 * seconds_ * double(frame)); };
  GraphicsControlBlock control{};
  control.DisposalMode = DISPOSE_DO_NOT;
  control.DelayTime = int(std::clamp(hundredths(written_ + 1) - hundredths(written_), 2LL, 65535LL));
  control.TransparentColor = written_ == 0 ? NO_TRANSPARENT_COLOR : as_before();
  GifByteType bytes[4];
  const auto size = int(EGifGCBToExtension(&control, bytes));
  return EGifPutExtension(file, GRAPHICS_EXT_FUNC_CODE, size, bytes) != GIF_ERROR;
}

// Numbers for the pixels that changed, "as before" for the others, and the rectangle around the changes.
Rectangle GifWriter::find_changes(const Picture& frame, std::vector<std::uint8_t>& numbers) {
  const bool first = written_ == 0;
  if (first) shown_ = {std::vector<std::uint8_t>(frame.pixels()), frame.bytes};
  numbers.assign(frame.pixels(), std::uint8_t(as_before()));
  Rectangle changed{frame.width, frame.height, 0, 0};
  for (int y = 0; y < frame.height; ++y) {
    for (int x = 0; x < frame.width; ++x) {
      const std::size_t i = std::size_t(y) * std::size_t(frame.width) + std::size_t(x);
      int change = 0;
      for (std::size_t k = 0; k < 3; ++k) {
        change = std::max(change, std::abs(int(frame.bytes[3 * i + k]) - int(shown_.bytes[3 * i + k])));
      }
      if (!first && change <= kSameEnough) continue;
      const std::uint8_t number = map_.at(frame, x, y);
      std::copy_n(&frame.bytes[3 * i], 3, &shown_.bytes[3 * i]);
      if (!first && number == shown_.numbers[i]) continue;
      numbers[i] = shown_.numbers[i] = number;
      changed = {std::min(changed.left, x), std::min(changed.top, y), std::max(changed.right, x + 1),
                 std::max(changed.bottom, y + 1)};
    }
  }
  // A frame has at least one pixel, also where nothing changed.
  if (changed.right == 0) changed = {0, 0, 1, 1};
  return changed;
}

bool GifWriter::write_frame(GifFileType* file, const Picture& frame) {
  std::vector<std::uint8_t> numbers;
  const Rectangle changed = find_changes(frame, numbers);
  const int width = changed.right - changed.left, height = changed.bottom - changed.top;
  if (!write_control(file)) return false;
  if (EGifPutImageDesc(file, changed.left, changed.top, width, height, false, nullptr) == GIF_ERROR)
    return false;
  for (int y = changed.top; y < changed.bottom; ++y) {
    std::uint8_t* line = &numbers[std::size_t(y) * std::size_t(frame.width) + std::size_t(changed.left)];
    if (EGifPutLine(file, line, width) == GIF_ERROR) return false;
  }
  ++written_;
  return true;
}

}  // namespace

std::string gif_bytes(const std::vector<Picture>& frames, double seconds, std::string& error) {
  ColorCount colors;
  for (const Picture& frame : frames) colors.add(frame);
  GifWriter writer(frames, seconds, PaletteMap(make_palette(colors, kMaxColors)));
  std::string bytes;
  int code = 0;
  GifFileType* file = EGifOpen(&bytes, append_to_string, &code);
  if (file) {
    const bool good = writer.write(file);
    if (!good) code = file->Error;
    int close_code = 0;
    if (EGifCloseFile(file, &close_code) == GIF_OK && good) return bytes;
    if (good) code = close_code;
  }
  const char* words = GifErrorString(code);
  error = std::string("the movie cannot be made: ") + (words ? words : "giflib does not say why");
  return {};
}

}  // namespace gyre
