// Blocks of an arena. Each new block is as large as all earlier ones together; reset() resizes the oldest block to the
// need of the step and a little more, and frees the others.
#include "base/arena/arena.h"

#include <cstring>
#include <new>

namespace gyre {

namespace {

constexpr std::size_t kHeader = kMemoryAlign;
constexpr std::size_t kFirstBlock = 16 * 1024;
// Spare room of a block as a share of the need. If the last block was too small as well, more will be needed soon, and
// each larger block has to be touched for the first time.
constexpr std::size_t kShare = 16, kShareOfGrowing = 2;

constexpr std::size_t round_up(std::size_t bytes) { return (bytes + kMemoryAlign - 1) & ~(kMemoryAlign - 1); }

}  // namespace

Arena::Arena(Arena&& other) noexcept { *this = std::move(other); }

Arena& Arena::operator=(Arena&& other) noexcept {
  if (this == &other) return *this;
  free_blocks();
  current_ = std::exchange(other.current_, nullptr);
  used_ = std::exchange(other.used_, 0);
  used_before_ = std::exchange(other.used_before_, 0);
  capacity_ = std::exchange(other.capacity_, 0);
  peak_ = std::exchange(other.peak_, 0);
  high_water_ = std::exchange(other.high_water_, 0);
  clock_ = other.clock_;
  grew_ = std::exchange(other.grew_, false);
  return *this;
}

Arena::~Arena() { free_blocks(); }

void* Arena::take(std::size_t bytes) {
  const std::size_t rounded = round_up(bytes);
  if (current_ == nullptr || rounded > current_->capacity - used_) {
    const std::size_t min_capacity = capacity_ < kFirstBlock ? kFirstBlock : capacity_;
    add_block(rounded < min_capacity ? min_capacity : rounded);
  }
  std::byte* const memory = reinterpret_cast<std::byte*>(current_) + kHeader + used_;
  used_ += rounded;
  if constexpr (kAssertsActive) std::memset(memory, 0xff, rounded);
  return memory;
}

void Arena::add_block(std::size_t capacity) {
  if (capacity > SIZE_MAX - kHeader) out_of_memory(capacity);
  used_before_ += used_;
  current_ = new (allocate(capacity + kHeader)) Block{current_, used_, capacity};
  used_ = 0;
  capacity_ += capacity;
}

void Arena::release(Mark mark) {
  peak_ = peak();
  while (current_ != mark.block) free_newest();
  GYRE_ASSERT(mark.used <= used_, "marks are released in the order of a stack");
  used_ = mark.used;
}

void Arena::reset() {
  const std::size_t needed = peak();
  high_water_ = high_water();
  peak_ = 0;
  const bool too_small = needed > capacity_ || (current_ != nullptr && current_->previous != nullptr);
  const bool too_large = clock_.should_shrink(needed, capacity_);
  used_ = 0;
  if (!too_small && !too_large) return;
  const std::size_t need = too_small ? needed : clock_.max_needed();
  const std::size_t spare = need / (too_small && grew_ ? kShareOfGrowing : kShare);
  grew_ = too_small;
  const std::size_t room = round_up(need + spare);
  resize_to(room < kFirstBlock ? kFirstBlock : room);
}

// The oldest block stays, since most of it has been touched.
void Arena::resize_to(std::size_t capacity) {
  while (current_ != nullptr && current_->previous != nullptr) free_newest();
  const std::size_t old_bytes = current_ == nullptr ? 0 : current_->capacity + kHeader;
  current_ = new (reallocate(current_, old_bytes, capacity + kHeader, 0)) Block{nullptr, 0, capacity};
  used_ = 0;
  used_before_ = 0;
  capacity_ = capacity;
}

void Arena::free_newest() {
  Block* const block = current_;
  current_ = block->previous;
  used_ = block->used_in_previous;
  used_before_ -= used_;
  capacity_ -= block->capacity;
  deallocate(block, block->capacity + kHeader);
}

void Arena::free_blocks() {
  while (current_ != nullptr) free_newest();
  used_ = 0;
  used_before_ = 0;
}

}  // namespace gyre
