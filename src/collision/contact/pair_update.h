// Updates the set of contacts: pairs that begin and pairs that end.
//
// In: sorted keys from the broad phase, or contacts that collide() marked as gone. Out: the contact store with contacts
// added in key order, or removed in slot order. Both orders depend on the state alone.
#pragma once

#include "base/container/array.h"
#include "base/container/bitset.h"
#include "base/container/flat_map.h"
#include "base/function_ref.h"
#include "collision/contact/contact_store.h"

#include <cstdint>
#include <span>

namespace gyre {

// Pairs of bodies that must not touch, keyed by pair_key of the bodies, with the number of joints that demand it.
using BlockedBodies = FlatMap<std::uint32_t>;

// Removes the keys from index `from` on whose pairs have a contact already, which is most of them.
void drop_known_pairs(const ContactStore& store, Array<std::uint64_t>& keys, std::size_t from);

// Adds a contact for each key without one, unless its two bodies are blocked. `keys` ascend without repeats;
// describe(key) gives the facts about the pair. Appends the slots of the new contacts, in key order, to `added` if that
// is given.
void add_pairs(ContactStore& store, std::span<const std::uint64_t> keys, const BlockedBodies& blocked,
               FunctionRef<PairShapes(std::uint64_t key)> describe, Array<std::uint32_t>* added = nullptr);

// Called before a contact is removed, with its last content.
using BeforeRemoval = FunctionRef<void(std::uint32_t slot, const Contact& contact)>;

// Removes the contacts whose bit is set, in slot order.
void remove_gone(ContactStore& store, const Bitset& gone, BeforeRemoval before_removal);

// The contacts of a shape in slot order, for events: the order of the shape's own list depends on history that a
// snapshot does not store. The span lies in `scratch`, whose content is replaced.
std::span<const std::uint32_t> list_contacts_of_shape(const ContactStore& store, std::uint32_t shape,
                                                      Array<std::uint32_t>& scratch);

// Removes all contacts of a shape, in slot order. The content of `scratch` is replaced.
void remove_contacts_of_shape(ContactStore& store, std::uint32_t shape, BeforeRemoval before_removal,
                              Array<std::uint32_t>& scratch);

}  // namespace gyre
