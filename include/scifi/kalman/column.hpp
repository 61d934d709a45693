// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cstring>
#include <type_traits>
#include <utility>

namespace scifi::kalman::detail {

/// True where columns of matrices are handled in vector registers: float and double, with compilers that know GNU vector types.
/// Every other scalar (dual numbers, packs, long double) takes the same formulae entry by entry.
template <class Scalar>
inline constexpr bool in_registers =
#if defined(__GNUC__)
    std::is_same_v<Scalar, double> || std::is_same_v<Scalar, float>;
#else
    false;
#endif

#if defined(__GNUC__)

#if defined(__AVX__)
inline constexpr int register_bytes = 32;
#else
inline constexpr int register_bytes = 16;
#endif

/// The largest power of two of Scalars that is at most n and fits a register.
template <class Scalar>
[[nodiscard]] consteval int register_width(int n) {
  int w = 1;
  while (2 * w <= n && 2 * w * static_cast<int>(sizeof(Scalar)) <= register_bytes) w *= 2;
  return w;
}

template <class Scalar, int Width>
struct register_type {
  typedef Scalar type __attribute__((vector_size(Width * sizeof(Scalar))));
};
template <class Scalar>
struct register_type<Scalar, 1> {
  using type = Scalar;
};

/// N numbers that lie side by side in memory, cut into registers of falling width with nothing left over: 5 doubles are 4 + 1.
template <class Scalar, int N>
struct column {
  static constexpr int width = register_width<Scalar>(N);
  typename register_type<Scalar, width>::type head;
  column<Scalar, N - width> tail;

  [[gnu::always_inline]] static column load(const Scalar* from) {
    column c;
    std::memcpy(&c.head, from, sizeof c.head);
    c.tail = column<Scalar, N - width>::load(from + width);
    return c;
  }
  [[gnu::always_inline]] void store(Scalar* to) const {
    std::memcpy(to, &head, sizeof head);
    tail.store(to + width);
  }
  /// this += weight other, where the other may go on below.
  template <class Longer>
  [[gnu::always_inline]] void add(const Longer& other, Scalar weight) {
    head += other.head * weight;
    tail.add(other.tail, weight);
  }
  template <class Longer>
  [[gnu::always_inline]] void subtract(const Longer& other, Scalar weight) {
    head -= other.head * weight;
    tail.subtract(other.tail, weight);
  }
  [[gnu::always_inline]] void add(const column& other) {
    head += other.head;
    tail.add(other.tail);
  }
  [[nodiscard, gnu::always_inline]] column times(Scalar weight) const {
    column c;
    c.head = head * weight;
    c.tail = tail.times(weight);
    return c;
  }
  /// The entries whose bit is set, zero in the others.
  template <unsigned Bits>
  [[nodiscard, gnu::always_inline]] column only() const {
    column c;
    c.tail = tail.template only<(Bits >> width)>();
    if constexpr (width == 1) {
      c.head = (Bits & 1u) != 0 ? head : Scalar(0);
    } else {
      c.head = [this]<int... I>(std::integer_sequence<int, I...>) {
        using bits = decltype(head < head);
        constexpr bits keep = {(((Bits >> I) & 1u) != 0 ? -1 : 0)...};
        return reinterpret_cast<decltype(head)>(reinterpret_cast<bits>(head) & keep);
      }(std::make_integer_sequence<int, width>{});
    }
    return c;
  }
  template <int I>
  [[gnu::always_inline]] void set(Scalar value) {
    if constexpr (I >= width) tail.template set<I - width>(value);
    else if constexpr (width == 1) head = value;
    else head[I] = value;
  }
};

template <class Scalar>
struct column<Scalar, 0> {
  [[gnu::always_inline]] static column load(const Scalar*) { return {}; }
  [[gnu::always_inline]] void store(Scalar*) const {}
  template <class Longer>
  [[gnu::always_inline]] void add(const Longer&, Scalar) {}
  template <class Longer>
  [[gnu::always_inline]] void subtract(const Longer&, Scalar) {}
  [[gnu::always_inline]] void add(const column&) {}
  template <unsigned>
  [[nodiscard, gnu::always_inline]] column only() const { return {}; }
  [[nodiscard, gnu::always_inline]] column times(Scalar) const { return {}; }
};

/// How many leading entries of a column of N to handle so that entry `index` is among them: whole registers.
template <class Scalar, int N>
[[nodiscard]] consteval int registers_through(int index) {
  int end = 0;
  while (end <= index) end += register_width<Scalar>(N - end);
  return end;
}

#endif

}  // namespace scifi::kalman::detail
