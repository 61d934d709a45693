// SPDX-License-Identifier: MPL-2.0
#pragma once

#include <cmath>
#include <concepts>
#include <cstdint>
#include <cstring>
#include <type_traits>

#include <Eigen/Core>

#if defined(__SSE2__)
#include <immintrin.h>
#endif

namespace scifi {

/// Number of lanes of a pack that fills one vector register of the machine compiled for.
template <class T>
inline constexpr int native_lanes =
#if defined(__AVX512F__) && defined(__AVX512DQ__)
    64 / static_cast<int>(sizeof(T));
#elif defined(__AVX__)
    32 / static_cast<int>(sizeof(T));
#else
    16 / static_cast<int>(sizeof(T));
#endif

namespace detail {

template <class T, int Lanes>
struct lanes_of {
  typedef T type __attribute__((vector_size(sizeof(T) * Lanes)));
};
template <class T>
using lane_bits = std::conditional_t<sizeof(T) == 8, std::int64_t, std::int32_t>;

}  // namespace detail

/// A truth value for each lane of a pack.
template <class T, int Lanes>
struct pack_mask {
  using vector_type = typename detail::lanes_of<detail::lane_bits<T>, Lanes>::type;
  vector_type bits;  ///< all ones or all zeros

  pack_mask() = default;
  [[gnu::always_inline]] pack_mask(bool b) : bits(vector_type{} - static_cast<detail::lane_bits<T>>(b)) {}
  [[gnu::always_inline]] explicit pack_mask(const vector_type& b) : bits(b) {}
  [[nodiscard]] bool operator[](int lane) const { return bits[lane] != 0; }
  void set(int lane, bool value) { bits[lane] = value ? -1 : 0; }

  [[gnu::always_inline]] friend pack_mask operator!(const pack_mask& a) { return pack_mask(~a.bits); }
  [[gnu::always_inline]] friend pack_mask operator&&(const pack_mask& a, const pack_mask& b) { return pack_mask(a.bits & b.bits); }
  [[gnu::always_inline]] friend pack_mask operator||(const pack_mask& a, const pack_mask& b) { return pack_mask(a.bits | b.bits); }
  [[nodiscard, gnu::always_inline]] friend bool any_of(const pack_mask& a) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
    if constexpr (sizeof(a.bits) == 64) {
      __m512i b;
      std::memcpy(&b, &a.bits, sizeof b);
      return _mm512_movepi64_mask(b) != 0 || (sizeof(T) == 4 && _mm512_movepi32_mask(b) != 0);
    }
#endif
#if defined(__AVX__)
    if constexpr (sizeof(a.bits) == 32) {
      __m256i b;
      std::memcpy(&b, &a.bits, sizeof b);
      return _mm256_testz_si256(b, b) == 0;
    }
#endif
    detail::lane_bits<T> any = 0;
    for (int i = 0; i < Lanes; ++i) any |= a.bits[i];
    return any != 0;
  }
  [[nodiscard, gnu::always_inline]] friend bool all_of(const pack_mask& a) { return !any_of(!a); }
};

/// One number for each of several tracks, worked on together: a scalar of the numerical core, on the vector types of g++ and clang.
///
/// Arithmetic and comparisons act lane by lane; a plain number stands for the same number in each lane. `select`, `any_of` and `all_of` take the masks that
/// comparisons yield. As wide as the registers of the processor compiled for unless said otherwise; of wider ones clang makes no Eigen matrices. Square root here, logarithm, exponential, sine and cosine in <scifi/core/pack_math.hpp>.
template <class T, int Lanes = native_lanes<T>>
struct pack {
  static_assert(std::is_same_v<T, double> || std::is_same_v<T, float>, "scifi: a pack is of double or float");
  static_assert(Lanes > 1 && (Lanes & (Lanes - 1)) == 0, "scifi: the number of lanes of a pack must be a power of two");
  using value_type = T;
  using mask_type = pack_mask<T, Lanes>;
  using vector_type = typename detail::lanes_of<T, Lanes>::type;
  static constexpr int lanes = Lanes;
  vector_type v;

  pack() = default;
  template <class Number>
    requires std::is_arithmetic_v<Number>
  [[gnu::always_inline]] pack(Number x) : v(vector_type{} + static_cast<T>(x)) {}
  [[gnu::always_inline]] explicit pack(const vector_type& x) : v(x) {}
  [[nodiscard]] T operator[](int lane) const { return v[lane]; }
  void set(int lane, T value) { v[lane] = value; }

  [[gnu::always_inline]] friend pack operator+(const pack& a, const pack& b) { return pack(a.v + b.v); }
  [[gnu::always_inline]] friend pack operator-(const pack& a, const pack& b) { return pack(a.v - b.v); }
  [[gnu::always_inline]] friend pack operator*(const pack& a, const pack& b) { return pack(a.v * b.v); }
  [[gnu::always_inline]] friend pack operator/(const pack& a, const pack& b) { return pack(a.v / b.v); }
  [[gnu::always_inline]] friend pack operator-(const pack& a) { return pack(-a.v); }
  [[gnu::always_inline]] pack& operator+=(const pack& b) { return *this = pack(v + b.v); }
  [[gnu::always_inline]] pack& operator-=(const pack& b) { return *this = pack(v - b.v); }
  [[gnu::always_inline]] pack& operator*=(const pack& b) { return *this = pack(v * b.v); }
  [[gnu::always_inline]] pack& operator/=(const pack& b) { return *this = pack(v / b.v); }
  [[gnu::always_inline]] friend mask_type operator<(const pack& a, const pack& b) { return mask_type(a.v < b.v); }
  [[gnu::always_inline]] friend mask_type operator>(const pack& a, const pack& b) { return mask_type(a.v > b.v); }
  [[gnu::always_inline]] friend mask_type operator<=(const pack& a, const pack& b) { return mask_type(a.v <= b.v); }
  [[gnu::always_inline]] friend mask_type operator>=(const pack& a, const pack& b) { return mask_type(a.v >= b.v); }

  /// a where the mask is true, b elsewhere.
  [[nodiscard, gnu::always_inline]] friend pack select(const mask_type& m, const pack& a, const pack& b) {
#if defined(__x86_64__) && !defined(__SSE4_1__) && !defined(__clang__)
    // Without SSE 4.1 there is no comparison of 64-bit lanes, and GCC 12 stops with an internal error where it wants one for the operator below.
    using bits = typename mask_type::vector_type;
    return pack(reinterpret_cast<vector_type>((m.bits & reinterpret_cast<bits>(a.v)) | (~m.bits & reinterpret_cast<bits>(b.v))));
#else
    return pack(m.bits ? a.v : b.v);
#endif
  }

  [[nodiscard, gnu::always_inline]] friend pack sqrt(const pack& a) {
#if defined(__AVX512F__) && defined(__AVX512DQ__)
    if constexpr (sizeof(a.v) == 64) {
      if constexpr (std::is_same_v<T, double>) return pack(reinterpret_cast<vector_type>(_mm512_maskz_sqrt_pd(static_cast<__mmask8>(-1), reinterpret_cast<__m512d>(a.v))));
      else return pack(reinterpret_cast<vector_type>(_mm512_maskz_sqrt_ps(static_cast<__mmask16>(-1), reinterpret_cast<__m512>(a.v))));
    }
#endif
#if defined(__AVX__)
    if constexpr (sizeof(a.v) == 32) {
      if constexpr (std::is_same_v<T, double>) return pack(reinterpret_cast<vector_type>(_mm256_sqrt_pd(reinterpret_cast<__m256d>(a.v))));
      else return pack(reinterpret_cast<vector_type>(_mm256_sqrt_ps(reinterpret_cast<__m256>(a.v))));
    }
#endif
    pack out;
    for (int i = 0; i < Lanes; ++i) out.v[i] = std::sqrt(a.v[i]);
    return out;
  }
};

}  // namespace scifi

namespace Eigen {

/// What Eigen needs of a number to build matrices of it.
template <class T, int Lanes>
struct NumTraits<scifi::pack<T, Lanes>> : GenericNumTraits<T> {
  using Real = scifi::pack<T, Lanes>;
  using NonInteger = scifi::pack<T, Lanes>;
  using Literal = T;
  using Nested = scifi::pack<T, Lanes>;
};

}  // namespace Eigen
