// Blocks of an arena: each new one is as large as all before it together, and reset() melts them into one.
#include "base/arena.h"

#include <cstring>
#include <new>

namespace gyre {

namespace {

constexpr std::size_t kHeader = kMemoryAlign;
constexpr std::size_t kFirstBlock = 16 * 1024;

constexpr std::size_t round_up(std::size_t bytes) { return (bytes + kMemoryAlign - 1) & ~(kMemoryAlign - 1); }

}  // namespace

Arena::Arena(Arena&& other) noexcept
    : current_(std::exchange(other.current_, nullptr)),
      used_(std::exchange(other.used_, 0)),
      used_before_(std::exchange(other.used_before_, 0)),
      held_(std::exchange(other.held_, 0)),
      high_water_(std::exchange(other.high_water_, 0)) {}

Arena& Arena::operator=(Arena&& other) noexcept {
  if (this == &other) return *this;
  free_blocks();
  current_ = std::exchange(other.current_, nullptr);
  used_ = std::exchange(other.used_, 0);
  used_before_ = std::exchange(other.used_before_, 0);
  held_ = std::exchange(other.held_, 0);
  high_water_ = std::exchange(other.high_water_, 0);
  return *this;
}

Arena::~Arena() { free_blocks(); }

void* Arena::take(std::size_t bytes) {
  const std::size_t rounded = round_up(bytes);
  if (current_ == nullptr || rounded > current_->capacity - used_) add_block(rounded);
  std::byte* const memory = reinterpret_cast<std::byte*>(current_) + kHeader + used_;
  used_ += rounded;
  if constexpr (kAssertsActive) std::memset(memory, 0xff, rounded);
  return memory;
}

void Arena::add_block(std::size_t capacity) {
  const std::size_t least = held_ < kFirstBlock ? kFirstBlock : held_;
  const std::size_t room = capacity < least ? least : capacity;
  if (room > SIZE_MAX - kHeader) out_of_memory(room);
  used_before_ += used_;
  current_ = new (allocate(room + kHeader)) Block{current_, room};
  used_ = 0;
  held_ += room;
}

void Arena::reset() {
  high_water_ = high_water();
  const bool in_pieces = current_ != nullptr && current_->previous != nullptr;
  const std::size_t room = held_;
  if (in_pieces) free_blocks();
  used_ = 0;
  used_before_ = 0;
  if (in_pieces) add_block(room);
}

void Arena::free_blocks() {
  while (current_ != nullptr) {
    Block* const block = current_;
    current_ = block->previous;
    deallocate(block, block->capacity + kHeader);
  }
  held_ = 0;
}

}  // namespace gyre
