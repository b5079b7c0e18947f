// Arrays of state records as bytes: their number, then record by record the fields of state_fields.h.
#pragma once

#include "io/codec/bytes.h"
#include "io/codec/record_codec.h"

namespace gyre {

template <class T>
void write_array(ByteWriter& out, const Array<T>& array) {
  out.put(std::uint64_t(array.size()));
  std::byte* to = out.grow(layout_of<T>().bytes * array.size());
  for (const T& record : array) to = write_record(to, record);
}

template <class T>
bool read_array(ByteReader& in, Array<T>& array) {
  const std::size_t bytes = layout_of<T>().bytes;
  array.resize(in.get_count(bytes));
  const std::span<const std::byte> data = in.get_bytes(bytes * array.size());
  if (in.failed()) return false;
  bool good = true;
  for (std::size_t i = 0; i < array.size(); ++i)
    good = read_record(data.data() + i * bytes, array[i]) && good;
  return good;
}

}  // namespace gyre
