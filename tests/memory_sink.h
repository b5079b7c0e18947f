// A recording's bytes kept in memory, until there is no more room for them.
#pragma once

#include <gyre/replay.h>

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace gyre {

struct MemorySink final : ByteSink {
  bool write(std::span<const std::byte> more) override {
    if (bytes.size() + more.size() > room) return false;
    bytes.insert(bytes.end(), more.begin(), more.end());
    return true;
  }
  std::vector<std::byte> bytes;
  std::size_t room = SIZE_MAX;
};

}  // namespace gyre
