// The set of contacts from step to step: pairs that come, pairs that go.
//
// In: sorted keys from the broad phase, or contacts marked as gone by collide(). Out: the contact store with contacts added
// in key order, or removed in slot order; both orders are functions of the state alone.
#pragma once

#include "base/container/array.h"
#include "base/container/bitset.h"
#include "base/container/flat_map.h"
#include "base/function_ref.h"
#include "collision/contact/contact_store.h"

#include <cstdint>
#include <span>

namespace gyre {

// Pairs of bodies that must not touch, with the number of reasons (joints) for each: keyed by pair_key of the bodies.
using BlockedBodies = FlatMap<std::uint32_t>;

// Takes the keys from place `from` on out that have a contact: most that a broad phase finds have.
void drop_known_pairs(const ContactStore& store, Array<std::uint64_t>& keys, std::size_t from);

// Adds a contact for each key that has none yet, unless its two bodies are blocked. `keys` ascending, without repeats;
// describe(key) tells what there is to know about the pair. Appends the slots of the new contacts, in key order, to `added`
// if that is given.
void add_pairs(ContactStore& store, std::span<const std::uint64_t> keys, const BlockedBodies& blocked,
               FunctionRef<PairShapes(std::uint64_t key)> describe, Array<std::uint32_t>* added = nullptr);

// Called before a contact is removed, with all that it still holds.
using BeforeRemoval = FunctionRef<void(std::uint32_t slot, const Contact& contact)>;

// Removes the contacts whose bit is set, in slot order.
void remove_gone(ContactStore& store, const Bitset& gone, BeforeRemoval before_removal);

// The contacts of a shape in slot order, for what is told about them: the order of the shape's own list depends on a
// history that a snapshot does not keep. The span lies in `scratch`, which is emptied and used.
std::span<const std::uint32_t> list_contacts_of_shape(const ContactStore& store, std::uint32_t shape,
                                                      Array<std::uint32_t>& scratch);

// Removes all contacts of a shape, in slot order. `scratch` is emptied and used.
void remove_contacts_of_shape(ContactStore& store, std::uint32_t shape, BeforeRemoval before_removal,
                              Array<std::uint32_t>& scratch);

}  // namespace gyre
