// The records of state_fields.h as bytes: field after field, without padding. The layout hash of a record tells a
// reader whether its fields are the same.
#pragma once

#include "base/hash.h"
#include "io/codec/enum_counts.h"
#include "world/state_fields.h"

namespace gyre {

// One letter for the type of a field.
template <class T>
constexpr char type_letter() {
  if constexpr (std::is_same_v<T, bool>) return '?';
  if constexpr (std::is_enum_v<T>) return 'e';
  if constexpr (std::is_same_v<T, float>) return 'f';
  if constexpr (std::is_same_v<T, double>) return 'd';
  constexpr bool is_signed = std::is_signed_v<T>;
  switch (sizeof(T)) {
    case 1:
      return is_signed ? 'b' : 'B';
    case 2:
      return is_signed ? 'h' : 'H';
    case 4:
      return is_signed ? 'i' : 'I';
    default:
      return is_signed ? 'q' : 'Q';
  }
}

struct RecordLayout {
  std::size_t bytes = 0;   // of one record
  std::uint64_t hash = 0;  // of the letters of its fields
};

template <class Record>
RecordLayout layout_of() {
  RecordLayout layout;
  const Record record{};
  for_each_field(record, [&]<class T>(const T&) {
    layout.bytes += sizeof(BitsOf<T>);
    layout.hash = mix_bits(layout.hash + std::uint64_t(type_letter<T>()));
  });
  return layout;
}

// Writes one record to `to`, which has room for it. Returns the address behind it.
template <class Record>
std::byte* write_record(std::byte* to, const Record& record) {
  for_each_field(record, [&]<class T>(const T& value) {
    store_little(to, to_bits(value));
    to += sizeof(BitsOf<T>);
  });
  return to;
}

// Reads one record. False if a bool or enum value in it does not exist; the other fields are read all the same.
template <class Record>
bool read_record(const std::byte* from, Record& record) {
  bool good = true;
  for_each_field(record, [&]<class T>(T& value) {
    good = from_bits(load_little<BitsOf<T>>(from), value) && good;
    from += sizeof(BitsOf<T>);
  });
  return good;
}

}  // namespace gyre
