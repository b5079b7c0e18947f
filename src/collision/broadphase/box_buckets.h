// Lists of boxes, eight side by side, for the cells of grids and the nodes of trees. All lists of one index share a
// pool of chunks. A list is the index of its first chunk, the only chunk that may have free lanes.
#pragma once

#include "base/arena/shrink_policy.h"
#include "base/container/array.h"
#include "collision/broadphase/box_lanes.h"
#include "collision/broadphase/cast_box.h"

#include <bit>
#include <cstdint>

namespace gyre {

class BoxBuckets {
 public:
  static constexpr std::uint32_t kNone = 0xffffffffu;
  static constexpr std::uint32_t kWidth = BoxLanes::kWidth;

  void clear() {
    chunks_.clear();
    free_.clear();
  }
  std::size_t bytes() const { return chunks_.bytes() + free_.bytes(); }

  // Adds to the list that starts with chunk `head`; returns the item's slot.
  std::uint32_t add(std::uint32_t& head, std::uint32_t item, const Aabb& box) {
    if (head == kNone || chunks_[head].count == kWidth) {
      const std::uint32_t made = make_chunk();
      chunks_[made].next = head;
      head = made;
    }
    Chunk& chunk = chunks_[head];
    const std::uint32_t lane = chunk.count++;
    set_lane_box(chunk, int(lane), box);
    chunk.item[lane] = item;
    return head * kWidth + lane;
  }

  // Removes the item in `slot` from the list. Returns the item that moved into this slot, or kNone.
  std::uint32_t remove(std::uint32_t& head, std::uint32_t slot) {
    Chunk& first = chunks_[head];
    const std::uint32_t last = head * kWidth + first.count - 1;
    std::uint32_t moved = kNone;
    if (slot != last) {
      moved = item_at(last);
      set_box(slot, box_at(last));
      chunks_[slot / kWidth].item[slot % kWidth] = moved;
    }
    clear_lane_box(first, int(--first.count));
    if (first.count == 0) {
      const std::uint32_t gone = head;
      head = first.next;
      free_.push_back(gone);
    }
    return moved;
  }

  // The slot of an item that is in the list.
  std::uint32_t find(std::uint32_t head, std::uint32_t item) const {
    for (std::uint32_t i = head;; i = chunks_[i].next) {
      for (std::uint32_t lane = 0; lane < chunks_[i].count; ++lane) {
        if (chunks_[i].item[lane] == item) return i * kWidth + lane;
      }
    }
  }

  std::uint32_t item_at(std::uint32_t slot) const { return chunks_[slot / kWidth].item[slot % kWidth]; }
  Aabb box_at(std::uint32_t slot) const { return lane_box(chunks_[slot / kWidth], int(slot % kWidth)); }
  void set_box(std::uint32_t slot, const Aabb& box) {
    set_lane_box(chunks_[slot / kWidth], int(slot % kWidth), box);
  }

  // Calls visit(item, box, slot) for each item.
  template <class Visit>
  void for_each(std::uint32_t head, Visit&& visit) const {
    for (std::uint32_t i = head; i != kNone; i = chunks_[i].next) {
      for (std::uint32_t lane = 0; lane < chunks_[i].count; ++lane) {
        visit(chunks_[i].item[lane], lane_box(chunks_[i], int(lane)), i * kWidth + lane);
      }
    }
  }
  // Calls visit(item, slot) for each item whose box overlaps `box`.
  template <class Visit>
  void for_each_overlap(std::uint32_t head, const Aabb& box, Visit&& visit) const {
    const OverlapTest test(box);
    for (std::uint32_t i = head; i != kNone; i = chunks_[i].next) {
      const Chunk& chunk = chunks_[i];
      for (unsigned left = test.mask(chunk); left != 0; left &= left - 1) {
        const auto lane = std::uint32_t(std::countr_zero(left));
        visit(chunk.item[lane], i * kWidth + lane);
      }
    }
  }
  // Calls visit(item, max_fraction, slot), which returns the new max_fraction, for each item that the cast may touch. A
  // result below 0 ends it.
  template <class Visit>
  float for_each_along(std::uint32_t head, const CastTest& cast_test, float max_fraction,
                       Visit&& visit) const {
    for (std::uint32_t i = head; i != kNone; i = chunks_[i].next) {
      const Chunk& chunk = chunks_[i];
      float enter[kWidth];
      for (unsigned left = cast_test.mask(chunk, max_fraction, enter); left != 0; left &= left - 1) {
        const auto lane = std::uint32_t(std::countr_zero(left));
        max_fraction = visit(chunk.item[lane], max_fraction, i * kWidth + lane);
        if (max_fraction < 0.0f) return max_fraction;
      }
    }
    return max_fraction;
  }

  // Frees a whole list.
  void free_list(std::uint32_t& head) {
    while (head != kNone) {
      free_.push_back(head);
      head = chunks_[head].next;
    }
  }

 private:
  // Lanes from `count` on have a box that nothing overlaps.
  struct alignas(64) Chunk : BoxLanes {
    std::uint32_t item[kWidth];
    std::uint32_t next;
    std::uint32_t count;
  };

  std::uint32_t make_chunk() {
    const std::uint32_t index = take_slot(chunks_, free_);
    for (std::uint32_t lane = 0; lane < kWidth; ++lane) clear_lane_box(chunks_[index], int(lane));
    chunks_[index].next = kNone;
    chunks_[index].count = 0;
    return index;
  }

  Array<Chunk> chunks_;
  Array<std::uint32_t> free_;
};

// An item with its box, to be added to an index.
struct BoxEntry {
  Aabb box;
  std::uint32_t item;
};

// Base of the indices in which each item is in one list: stores the item's list and slot.
class BucketIndex {
 public:
  std::size_t size() const { return size_; }
  bool contains(std::uint32_t item) const { return item < slots_.size() && slots_[item] != kNone; }
  Aabb box_of(std::uint32_t item) const { return buckets_.box_at(slots_[item]); }

  void begin_build() { entries_.clear(); }
  void add_to_build(std::uint32_t item, const Aabb& box) { entries_.push_back({box, item}); }
  void trim() {
    clock_.trim(entries_, entries_.size());
    entries_.clear();
  }

 protected:
  static constexpr std::uint32_t kNone = BoxBuckets::kNone;

  void grow_to(std::uint32_t item) {
    if (slots_.size() <= item) {
      slots_.resize(std::size_t(item) + 1, kNone);
      nodes_of_.resize(std::size_t(item) + 1, kNone);
    }
  }
  void clear_items() {
    buckets_.clear();
    for (std::uint32_t& slot : slots_) slot = kNone;
    size_ = 0;
  }
  // Adds an item to the list of a node that begins at `head`; take() removes it.
  void put(std::uint32_t& head, std::uint32_t node, std::uint32_t item, const Aabb& box) {
    slots_[item] = buckets_.add(head, item, box);
    nodes_of_[item] = node;
  }
  void take(std::uint32_t& head, std::uint32_t item) {
    const std::uint32_t slot = slots_[item];
    const std::uint32_t moved = buckets_.remove(head, slot);
    if (moved != kNone) slots_[moved] = slot;
    slots_[item] = kNone;
  }
  std::size_t item_bytes() const {
    return buckets_.bytes() + slots_.bytes() + nodes_of_.bytes() + entries_.bytes();
  }

  BoxBuckets buckets_;
  Array<std::uint32_t> slots_;     // by item, or kNone
  Array<std::uint32_t> nodes_of_;  // by item
  Array<BoxEntry> entries_;        // of the present build
  ShrinkPolicy clock_;
  std::size_t size_ = 0;
};

}  // namespace gyre
