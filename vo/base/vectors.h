// Vectors of numbers by the compiler's extension: one operator acts on all lanes. Functions that take or return them
// are always inlined, so that no ABI is involved.
#pragma once

#include <cstring>

#pragma GCC diagnostic ignored "-Wpsabi"

namespace vo {

template <class T, int Lanes>
struct VectorOf {
  typedef T type __attribute__((vector_size(sizeof(T) * Lanes)));
};
template <class T, int Lanes>
using Vector = typename VectorOf<T, Lanes>::type;

template <class V>
[[gnu::always_inline]] inline V Load(const void* from) {  // of any alignment
  V v;
  std::memcpy(&v, from, sizeof v);
  return v;
}

template <class V>
[[gnu::always_inline]] inline void Store(const V& v, void* to) {
  std::memcpy(to, &v, sizeof v);
}

}  // namespace vo
