// A fuzz input as a list of edits of good bytes: so every input is almost a snapshot or a recording, and none grows stale
// when their format changes. Input: bytes that are not understood are edits that do nothing.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gyre::fuzz {

// Reads numbers off a fuzz input; zeros after its end.
class Input {
 public:
  Input(const std::uint8_t* data, std::size_t size) : data_(data), left_(size) {}
  bool empty() const { return left_ == 0; }
  std::uint8_t byte() {
    if (left_ == 0) return 0;
    --left_;
    return *data_++;
  }
  std::uint32_t word() {
    std::uint32_t value = 0;
    for (int i = 0; i < 4; ++i) value = value << 8 | byte();
    return value;
  }
  std::size_t below(std::size_t limit) { return limit == 0 ? 0 : word() % limit; }

 private:
  const std::uint8_t* data_;
  std::size_t left_;
};

inline std::vector<std::byte> edited(std::span<const std::byte> good, Input& input) {
  std::vector<std::byte> bytes(good.begin(), good.end());
  while (!input.empty() && !bytes.empty()) {
    const std::uint8_t kind = input.byte();
    const std::size_t place = input.below(bytes.size());
    switch (kind % 8) {
      case 0:
      case 1:
        bytes[place] = std::byte(input.byte());
        break;
      case 2:
        bytes[place] ^= std::byte(1 << kind / 8 % 8);
        break;
      case 3: {  // a number of four bytes
        const std::uint32_t value = input.word();
        for (std::size_t i = 0; i < 4 && place + i < bytes.size(); ++i)
          bytes[place + i] = std::byte(value >> 8 * i & 0xff);
        break;
      }
      case 4: {  // all ones, as far as the kind says
        for (std::size_t i = 0; i < std::size_t(kind / 8 + 1) && place + i < bytes.size(); ++i)
          bytes[place + i] = std::byte(0xff);
        break;
      }
      case 5:
        bytes.resize(place);
        break;
      case 6:
        bytes.insert(bytes.begin() + std::ptrdiff_t(place), std::size_t(kind / 8 + 1),
                     std::byte(input.byte()));
        break;
      default: {
        const std::size_t count = input.below(64) < bytes.size() - place ? 1 : bytes.size() - place;
        bytes.erase(bytes.begin() + std::ptrdiff_t(place), bytes.begin() + std::ptrdiff_t(place + count));
        break;
      }
    }
  }
  return bytes;
}

}  // namespace gyre::fuzz
